"""What the trace of an agent tells over time: certainty, surprise, free energy, expected free energy."""

from collections.abc import Sequence
from typing import Any, Unpack

import numpy as np

from ..agent import StepRecord
from ..model import CogmapError
from .axes import Axes, Where, axes_or_new, legend_below
from .terms_plot import NOTHING, line_look, signed_label
from .theme import BLUE, ORANGE, SKY, VERMILION, theme_of

Trace = Sequence[StepRecord]  # the agent's records, one a step: `agent.trace`
MOVED = 0.5  # P(moved_t) from which a step is marked
FEW = 60  # steps that have a dot each


def plot_certainty(trace: Trace, *, threshold: float | None = None, **where: Unpack[Where]) -> Axes:
    """Q of the most probable place at each step, and the doubt that the earlier belief was wrong.

    Steps at which the agent found itself moved, or took back what it had learned, are marked. `threshold` is the
    certainty from which the agent learns (`settings.certainty`), drawn as a line.

    Raises:
        CogmapError: the trace is empty, or the threshold is no probability.
    """
    if threshold is not None and not 0.0 <= threshold <= 1.0:
        raise CogmapError(f"plot_certainty: threshold is {threshold}; give a probability from 0 to 1")
    ax = _over_steps(trace, (6.0, 3.4), where)
    theme = theme_of(ax)
    _draw_certainty(ax, trace)
    _draw_line(ax, trace, [record.doubt for record in trace], "doubt", color=theme.line(VERMILION), linestyle="--")
    if threshold is not None:
        line: dict[str, Any] = {"color": theme.shade(0.7), "linewidth": 0.9, "linestyle": (0, (4, 3))}
        ax.axhline(threshold, label=f"learns from {threshold:g}", **line)
    ax.set_ylim(-0.03, 1.05)
    ax.set_ylabel("probability")
    _mark_events(ax, trace, columns=5)
    return ax


def plot_surprise(trace: Trace, **where: Unpack[Where]) -> Axes:
    """-log P(o_t, c_t | the past) at each step in nats, and the parts of F that add up to it (eq. 3).

    The bars are complexity and -accuracy, one on the other; at the exact posterior they are as high as the surprise.
    Steps at which the agent found itself moved, or took back what it had learned, are marked.

    Raises:
        CogmapError: the trace is empty.
    """
    ax = _over_steps(trace, (6.0, 3.4), where)
    theme, steps = theme_of(ax), [record.step for record in trace]
    complexity = np.array([record.complexity for record in trace])
    inaccuracy = -np.array([record.accuracy for record in trace])
    style: dict[str, Any] = {"width": 0.8, "edgecolor": theme.paper, "linewidth": 0.4 if len(trace) <= FEW else 0.0}
    ax.bar(steps, complexity, color=BLUE, label="complexity", **style)
    ax.bar(steps, inaccuracy, bottom=complexity, color=ORANGE, label="−accuracy", **style)
    _draw_line(ax, trace, [-record.evidence for record in trace], "surprise", color=theme.ink, linewidth=1.0)
    ax.set_ylabel("nats")
    low, high = ax.get_ylim()
    ax.set_ylim(min(0.0, low), high + 0.08 * (high - low))
    _mark_events(ax, trace, columns=5)
    return ax


def plot_free_energy(trace: Trace, **where: Unpack[Where]) -> Axes:
    """F of every step in nats (eq. 3), and on a second axis the belief in the most probable place.

    Steps at which the agent found itself moved, or took back what it had learned, are marked.

    Raises:
        CogmapError: the trace is empty.
    """
    ax = _over_steps(trace, (6.0, 5.0), where)
    theme, beside = theme_of(ax), ax.twinx()
    _draw_certainty(beside, trace)
    beside.set_ylim(0.0, 1.05)
    beside.set_ylabel("certainty (shaded)")
    _draw_line(ax, trace, [record.free_energy for record in trace], None, color=theme.ink)
    ax.set_ylabel("free energy F (nats)")
    ax.set_zorder(beside.get_zorder() + 1)
    beside.set_facecolor(theme.paper)
    ax.patch.set_visible(False)
    beside.patch.set_visible(True)
    _mark_events(ax, trace)
    return ax


def plot_expected_free_energy(trace: Trace, **where: Unpack[Where]) -> Axes:
    """G of the chosen policy at each step in nats (eqs. 5 and 8), and its terms.

    Terms that are zero at every step are left out.

    Raises:
        CogmapError: the trace is empty.
    """
    ax = _over_steps(trace, (6.0, 5.0), where)
    theme = theme_of(ax)
    ax.axhline(0.0, color=theme.shade(0.25), linewidth=0.8)
    terms = {term.name: term for record in trace for term in record.terms}
    for number, term in enumerate(terms.values()):
        values = [term.sign * record.G.get(term.name, 0.0) for record in trace]
        if np.abs(values).max() > NOTHING:
            _draw_line(ax, trace, values, signed_label(term), **line_look(term, number, theme))
    G = [record.G["G"] for record in trace]
    _draw_line(ax, trace, G, "G", color=theme.ink)
    if np.abs(G).max() <= NOTHING:
        ax.set_ylim(-1.0, 1.0)
    ax.set_ylabel("expected free energy (nats)")
    legend_below(ax)
    return ax


def _over_steps(trace: Trace, size: tuple[float, float], where: Where) -> Axes:
    """The axes, with an axis of steps."""
    from matplotlib.ticker import MaxNLocator

    if not trace:
        raise CogmapError("plot: the trace is empty; let the agent take a step first")
    ax = axes_or_new(size=size, **where)
    ax.set_xlim(trace[0].step - 0.5, trace[-1].step + 0.5)
    ax.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    ax.set_xlabel("step")
    return ax


def _draw_line(ax: Axes, trace: Trace, values: Sequence[float], name: str | None, **style: Any) -> None:
    """A line over the steps, with dots where it is short enough for them."""
    dots = {"marker": "o" if len(trace) <= FEW else "", "markersize": 3}
    ax.plot([record.step for record in trace], values, label=name, **dots, **style)


def _draw_certainty(ax: Axes, trace: Trace) -> None:
    """As a bar a step, and their outline."""
    certainty = [record.certainty for record in trace]
    edges = [trace[0].step - 0.5, *(record.step + 0.5 for record in trace)]
    ax.stairs(certainty, edges, fill=True, color=SKY, alpha=0.35)
    ax.stairs(certainty, edges, color=theme_of(ax).line(BLUE), baseline=None, linewidth=1.5, label="certainty")


def _mark_events(ax: Axes, trace: Trace, *, columns: int = 3) -> None:
    """Lines where the agent noticed that it had been moved, and where it took back what it had learned; the legend."""
    theme = theme_of(ax)
    moved = [record.step for record in trace if record.moved >= MOVED]
    revised = [record.step for record in trace if record.revised]
    for steps, name, sign, style in ((moved, "moved", "v", (0, (4, 2))), (revised, "revised", "X", (0, (1, 1)))):
        for step in steps:
            ax.axvline(step, color=theme.shade(0.6), linewidth=0.9, linestyle=style, zorder=0.6)
        if steps:
            at: dict[str, Any] = {"transform": ax.get_xaxis_transform(), "clip_on": False, "zorder": 6}
            look: dict[str, Any] = {"linestyle": "", "marker": sign, "markersize": 7, "markeredgecolor": theme.paper}
            ax.plot(steps, [1.0] * len(steps), color=theme.ink, label=name, **look, **at)
    legend_below(ax, columns=columns)
