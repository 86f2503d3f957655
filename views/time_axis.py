"""What plots over time share: the axis of steps, and marks where the agent was moved or changed its mind."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..agent import StepRecord
from ..model.errors import CogmapError
from .theme import theme_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Trace = Sequence[StepRecord]

MOVED = 0.5  # P(moved_t) from which a step is marked


def steps_of(trace: Trace) -> list[int]:
    """The steps of a trace.

    Raises:
        CogmapError: the trace is empty.
    """
    if not trace:
        raise CogmapError("plot: the trace is empty; let the agent take a step first")
    return [record.step for record in trace]


def marker(trace: Trace) -> str:
    """Dots on lines that are short enough for them."""
    return "o" if len(trace) <= 60 else ""


def bars_of(trace: Trace) -> list[float]:
    """Edges of one bar a step."""
    steps = steps_of(trace)
    return [steps[0] - 0.5, *(step + 0.5 for step in steps)]


def mark_events(ax: Axes, trace: Trace) -> None:
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


def finish(ax: Axes, trace: Trace, title: str | None) -> None:
    """The axis of steps, and the title."""
    from matplotlib.ticker import MaxNLocator

    first, last = trace[0].step, trace[-1].step
    ax.set_xlim(first - 0.5, last + 0.5)
    ax.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    ax.set_xlabel("step")
    if title is not None:
        ax.set_title(title)
