"""How sure the agent was, and how surprised."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..model.errors import CogmapError
from .axes import axes_or_new, legend_below
from .colours import BLUE, ORANGE, SKY, VERMILION
from .theme import theme_of
from .time_axis import Trace, bars_of, finish, mark_events, marker, steps_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes


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
    steps = steps_of(trace)
    ax = axes_or_new(ax, size=(6.0, 3.4))
    theme = theme_of(ax)
    certainty = [record.certainty for record in trace]
    ax.stairs(certainty, bars_of(trace), fill=True, color=SKY, alpha=0.35)
    ax.stairs(certainty, bars_of(trace), color=theme.line(BLUE), baseline=None, linewidth=1.5, label="certainty")
    doubt: dict[str, Any] = {
        "color": theme.line(VERMILION),
        "linestyle": "--",
        "marker": marker(trace),
        "markersize": 3,
    }
    ax.plot(steps, [record.doubt for record in trace], label="doubt", **doubt)
    if threshold is not None:
        line: dict[str, Any] = {"color": theme.shade(0.7), "linewidth": 0.9, "linestyle": (0, (4, 3))}
        ax.axhline(threshold, label=f"learns from {threshold:g}", **line)
    ax.set_ylim(-0.03, 1.05)
    ax.set_ylabel("probability")
    mark_events(ax, trace)
    legend_below(ax, columns=5)
    finish(ax, trace, title)
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
    steps = steps_of(trace)
    ax = axes_or_new(ax, size=(6.0, 3.4))
    theme = theme_of(ax)
    complexity = np.array([record.complexity for record in trace])
    inaccuracy = -np.array([record.accuracy for record in trace])
    style: dict[str, Any] = {"width": 0.8, "edgecolor": theme.paper, "linewidth": 0.4 if len(trace) <= 60 else 0.0}
    ax.bar(steps, complexity, color=BLUE, label="complexity", **style)
    ax.bar(steps, inaccuracy, bottom=complexity, color=ORANGE, label="−accuracy", **style)
    look: dict[str, Any] = {"color": theme.ink, "linewidth": 1.0, "marker": marker(trace), "markersize": 4}
    ax.plot(steps, [-record.evidence for record in trace], label="surprise", **look)
    ax.set_ylabel("nats")
    low, high = ax.get_ylim()
    ax.set_ylim(min(0.0, low), high + 0.08 * (high - low))
    mark_events(ax, trace)
    legend_below(ax, columns=5)
    finish(ax, trace, title)
    return ax
