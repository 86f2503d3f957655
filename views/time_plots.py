"""What the trace of an agent tells over time: certainty, surprise, free energy, expected free energy."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..agent import StepRecord
from ..model import CogmapError
from .axes import axes_or_new, legend_below
from .colours import BLUE, ORANGE, SKY, VERMILION
from .terms import NOTHING, line_look, signed_label
from .theme import theme_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Trace = Sequence[StepRecord]

MOVED = 0.5  # P(moved_t) from which a step is marked
FEW = 60  # steps that have a dot each


def plot_certainty(
    trace: Trace, *, threshold: float | None = None, title: str | None = None, ax: Axes | None = None
) -> Axes:
    """Q of the most probable place at every step, and the doubt whether the belief went astray before.

    Steps at which the agent found itself moved, or took back what it had learned, are marked.

    Args:
        trace: the agent's records, one a step.
        threshold: certainty from which the agent learns (`settings.certainty`), drawn as a line.
        title: above the plot.
        ax: axes to draw on; new ones unless given.

    Raises:
        CogmapError: the trace is empty, or the threshold is no probability.
    """
    if threshold is not None and not 0.0 <= threshold <= 1.0:
        raise CogmapError(f"plot_certainty: threshold is {threshold}; give a probability from 0 to 1")
    ax = _over_steps(trace, ax, title, size=(6.0, 3.4))
    theme = theme_of(ax)
    _draw_certainty(ax, trace)
    doubt: dict[str, Any] = {"color": theme.line(VERMILION), "linestyle": "--", **_dots(trace)}
    ax.plot(_steps(trace), [record.doubt for record in trace], label="doubt", **doubt)
    if threshold is not None:
        line: dict[str, Any] = {"color": theme.shade(0.7), "linewidth": 0.9, "linestyle": (0, (4, 3))}
        ax.axhline(threshold, label=f"learns from {threshold:g}", **line)
    ax.set_ylim(-0.03, 1.05)
    ax.set_ylabel("probability")
    _mark_events(ax, trace)
    legend_below(ax, columns=5)
    return ax


def plot_surprise(trace: Trace, *, title: str | None = None, ax: Axes | None = None) -> Axes:
    """-log P(o_t, c_t | the past) of every step in nats, and the parts of F that it is the sum of (eq. 3).

    The bars are complexity and -accuracy, one on the other; at the exact posterior they are as high as the surprise.
    Steps at which the agent found itself moved, or took back what it had learned, are marked.

    Args:
        trace: the agent's records, one a step.
        title: above the plot.
        ax: axes to draw on; new ones unless given.

    Raises:
        CogmapError: the trace is empty.
    """
    ax = _over_steps(trace, ax, title, size=(6.0, 3.4))
    theme, steps = theme_of(ax), _steps(trace)
    complexity = np.array([record.complexity for record in trace])
    inaccuracy = -np.array([record.accuracy for record in trace])
    style: dict[str, Any] = {"width": 0.8, "edgecolor": theme.paper, "linewidth": 0.4 if len(trace) <= FEW else 0.0}
    ax.bar(steps, complexity, color=BLUE, label="complexity", **style)
    ax.bar(steps, inaccuracy, bottom=complexity, color=ORANGE, label="−accuracy", **style)
    look: dict[str, Any] = {"color": theme.ink, "linewidth": 1.0, **_dots(trace, size=4)}
    ax.plot(steps, [-record.evidence for record in trace], label="surprise", **look)
    ax.set_ylabel("nats")
    low, high = ax.get_ylim()
    ax.set_ylim(min(0.0, low), high + 0.08 * (high - low))
    _mark_events(ax, trace)
    legend_below(ax, columns=5)
    return ax


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
    ax = _over_steps(trace, ax, title)
    theme = theme_of(ax)
    beside = ax.twinx()
    _draw_certainty(beside, trace)
    beside.set_ylim(0.0, 1.05)
    beside.set_ylabel("certainty (shaded)")
    ax.plot(_steps(trace), [record.free_energy for record in trace], color=theme.ink, **_dots(trace))
    ax.set_ylabel("free energy F (nats)")
    ax.set_zorder(beside.get_zorder() + 1)
    beside.set_facecolor(theme.paper)
    ax.patch.set_visible(False)
    beside.patch.set_visible(True)
    _mark_events(ax, trace)
    legend_below(ax)
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
    ax = _over_steps(trace, ax, title)
    theme, steps, dots = theme_of(ax), _steps(trace), _dots(trace)
    ax.axhline(0.0, color=theme.shade(0.25), linewidth=0.8)
    terms = {term.name: term for record in trace for term in record.terms}
    for at, term in enumerate(terms.values()):
        values = np.array([term.sign * record.G.get(term.name, 0.0) for record in trace])
        if np.abs(values).max() > NOTHING:
            ax.plot(steps, values, label=signed_label(term), **line_look(term, at, theme), **dots)
    G = np.array([record.G["G"] for record in trace])
    ax.plot(steps, G, label="G", color=theme.ink, **dots)
    if np.abs(G).max() <= NOTHING:
        ax.set_ylim(-1.0, 1.0)
    ax.set_ylabel("expected free energy (nats)")
    legend_below(ax)
    return ax


def _over_steps(trace: Trace, ax: Axes | None, title: str | None, *, size: tuple[float, float] = (6.0, 5.0)) -> Axes:
    """The axes, with an axis of steps."""
    from matplotlib.ticker import MaxNLocator

    if not trace:
        raise CogmapError("plot: the trace is empty; let the agent take a step first")
    ax = axes_or_new(ax, title, size=size)
    ax.set_xlim(trace[0].step - 0.5, trace[-1].step + 0.5)
    ax.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    ax.set_xlabel("step")
    return ax


def _steps(trace: Trace) -> list[int]:
    return [record.step for record in trace]


def _dots(trace: Trace, *, size: int = 3) -> dict[str, Any]:
    """Dots on lines that are short enough for them."""
    return {"marker": "o" if len(trace) <= FEW else "", "markersize": size}


def _draw_certainty(ax: Axes, trace: Trace) -> None:
    """As a bar a step, and their outline."""
    certainty = [record.certainty for record in trace]
    edges = [trace[0].step - 0.5, *(record.step + 0.5 for record in trace)]
    ax.stairs(certainty, edges, fill=True, color=SKY, alpha=0.35)
    ax.stairs(certainty, edges, color=theme_of(ax).line(BLUE), baseline=None, linewidth=1.5, label="certainty")


def _mark_events(ax: Axes, trace: Trace) -> None:
    """Vertical lines where the agent noticed that it had been moved, and where it took back what it had learned."""
    theme = theme_of(ax)
    moved = [record.step for record in trace if record.moved >= MOVED]
    retracted = [record.step for record in trace if record.retracted is not None]
    for steps, name, sign, style in ((moved, "moved", "v", (0, (4, 2))), (retracted, "retracted", "X", (0, (1, 1)))):
        for step in steps:
            ax.axvline(step, color=theme.shade(0.6), linewidth=0.9, linestyle=style, zorder=0.6)
        if steps:
            at: dict[str, Any] = {"transform": ax.get_xaxis_transform(), "clip_on": False, "zorder": 6}
            look: dict[str, Any] = {"linestyle": "", "marker": sign, "markersize": 7, "markeredgecolor": theme.paper}
            ax.plot(steps, [1.0] * len(steps), color=theme.ink, label=name, **look, **at)
