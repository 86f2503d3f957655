"""Free energy of what was seen, and expected free energy of what was chosen."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np

from .axes import axes_or_new, legend_below
from .colours import BLUE, SKY
from .terms import STYLES, colour_of, signed_label
from .theme import theme_of
from .time_axis import Trace, bars_of, finish, mark_events, marker, steps_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

NOTHING = 1e-6  # nats


def plot_free_energy(trace: Trace, *, title: str | None = None, ax: Axes | None = None) -> Axes:
    """F of every step in nats (eq. 3), and on a second axis the belief in the most probable place.

    Steps at which the agent found itself moved, or took back what it had learned, are marked.

    Args:
        trace: the agent's records, one a step.
        title: above the plot.
        ax: axes to draw on; new ones unless given.

    Raises:
        CogmapError: the trace is empty.
    """
    steps = steps_of(trace)
    ax = axes_or_new(ax)
    theme = theme_of(ax)
    beside = ax.twinx()
    certainty = [record.certainty for record in trace]
    beside.stairs(certainty, bars_of(trace), fill=True, color=SKY, alpha=0.35)
    beside.stairs(certainty, bars_of(trace), color=theme.line(BLUE), baseline=None)
    beside.set_ylim(0.0, 1.05)
    beside.set_ylabel("certainty (shaded)")
    ax.plot(steps, [record.free_energy for record in trace], marker=marker(trace), markersize=3, color=theme.ink)
    ax.set_ylabel("free energy F (nats)")
    ax.set_zorder(beside.get_zorder() + 1)
    beside.set_facecolor(theme.paper)
    ax.patch.set_visible(False)
    beside.patch.set_visible(True)
    mark_events(ax, trace)
    legend_below(ax)
    finish(ax, trace, title)
    return ax


def plot_expected_free_energy(trace: Trace, *, title: str | None = None, ax: Axes | None = None) -> Axes:
    """G of the chosen policy at every step in nats (eqs. 5 and 8), and the terms it is the sum of.

    Terms that are zero at every step are left out.

    Args:
        trace: the agent's records, one a step.
        title: above the plot.
        ax: axes to draw on; new ones unless given.

    Raises:
        CogmapError: the trace is empty.
    """
    steps = steps_of(trace)
    ax = axes_or_new(ax)
    theme = theme_of(ax)
    ax.axhline(0.0, color=theme.shade(0.25), linewidth=0.8)
    dots: dict[str, Any] = {"marker": marker(trace), "markersize": 3}
    for term, style in zip(trace[-1].terms, cycle(STYLES)):
        values = np.array([term.sign * record.G[term.name] for record in trace])
        if np.abs(values).max() > NOTHING:
            ax.plot(steps, values, label=signed_label(term), color=theme.line(colour_of(term)), linestyle=style, **dots)
    G = np.array([record.G["G"] for record in trace])
    ax.plot(steps, G, label="G", color=theme.ink, **dots)
    if np.abs(G).max() <= NOTHING:
        ax.set_ylim(-1.0, 1.0)
    ax.set_ylabel("expected free energy (nats)")
    legend_below(ax)
    finish(ax, trace, title)
    return ax
