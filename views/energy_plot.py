"""Free energy of what was seen, and expected free energy of what was chosen."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..agent import StepRecord
from ..model.errors import CogmapError
from .axes import axes_or_new

if TYPE_CHECKING:
    from matplotlib.axes import Axes

NOTHING = 1e-6  # nats

# each term of StepRecord.G: what its line is called, its sign in G, colour and line style
_TERMS = {
    "state_information": ("−state information", -1.0, "#0072b2", "--"),
    "sight_information": ("−sight information", -1.0, "#e69f00", "-."),
    "transition_information": ("−transition information", -1.0, "#009e73", (0, (5, 1))),
    "position_information": ("−position information", -1.0, "#cc79a7", ":"),
    "utility": ("−utility", -1.0, "#56b4e9", (0, (3, 1, 1, 1))),
    "collision": ("collision", 1.0, "#d55e00", (0, (1, 1))),
}


def plot_free_energy(trace: Sequence[StepRecord], *, title: str | None = None, ax: Axes | None = None) -> Axes:
    """F of every step in nats (eq. 3), and on a second axis the belief in the most probable place.

    Args:
        trace: the agent's records, one a step.
        title: above the plot.
        ax: axes to draw on; new ones unless given.

    Raises:
        CogmapError: the trace is empty.
    """
    steps = _steps(trace)
    ax = axes_or_new(ax)
    beside = ax.twinx()
    certainty = [record.certainty for record in trace]
    edges = [steps[0] - 0.5, *(step + 0.5 for step in steps)]
    beside.stairs(certainty, edges, fill=True, color="#56b4e9", alpha=0.35)
    beside.stairs(certainty, edges, color="#0072b2", baseline=None)
    beside.set_ylim(0.0, 1.05)
    beside.set_ylabel("certainty", color="#0072b2")
    beside.tick_params(axis="y", colors="#0072b2")
    ax.plot(steps, [record.free_energy for record in trace], marker=_marker(trace), markersize=3, color="black")
    ax.set_ylabel("free energy F (nats)")
    ax.set_zorder(beside.get_zorder() + 1)
    ax.patch.set_visible(False)
    _finish(ax, trace, title)
    return ax


def plot_expected_free_energy(trace: Sequence[StepRecord], *, title: str | None = None, ax: Axes | None = None) -> Axes:
    """G of the chosen policy at every step in nats (eqs. 5 and 8), and the terms it is the sum of.

    Terms that are zero at every step are left out.

    Args:
        trace: the agent's records, one a step.
        title: above the plot.
        ax: axes to draw on; new ones unless given.

    Raises:
        CogmapError: the trace is empty.
    """
    steps = _steps(trace)
    ax = axes_or_new(ax)
    ax.axhline(0.0, color="0.8", linewidth=0.8)
    marker = _marker(trace)
    for key, (name, sign, colour, style) in _TERMS.items():
        values = np.array([sign * record.G[key] for record in trace])
        if np.abs(values).max() > NOTHING:
            ax.plot(steps, values, label=name, color=colour, linestyle=style, marker=marker, markersize=3)
    G = np.array([record.G["G"] for record in trace])
    ax.plot(steps, G, label="G", color="black", marker=marker, markersize=3)
    if np.abs(G).max() <= NOTHING:
        ax.set_ylim(-1.0, 1.0)
    ax.set_ylabel("expected free energy (nats)")
    ax.legend(fontsize="small", frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=3)
    _finish(ax, trace, title)
    return ax


def _steps(trace: Sequence[StepRecord]) -> list[int]:
    if not trace:
        raise CogmapError("plot: the trace is empty; let the agent take a step first")
    return [record.step for record in trace]


def _marker(trace: Sequence[StepRecord]) -> str:
    return "o" if len(trace) <= 60 else ""


def _finish(ax: Axes, trace: Sequence[StepRecord], title: str | None) -> None:
    from matplotlib.ticker import MaxNLocator

    first, last = trace[0].step, trace[-1].step
    ax.set_xlim(first - 0.5, last + 0.5)
    ax.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    ax.set_xlabel("step")
    if title is not None:
        ax.set_title(title)
