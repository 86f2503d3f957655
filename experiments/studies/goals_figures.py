"""The figures of the study `goals`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .goals import DIFFER, REPEAT, GoalsResult
from .goals_summary import Summary
from .intervals import Interval

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

DISTANCES: tuple[tuple[float, float], ...] = ((0, 0), (1, 1), (2, 2), (3, 3), (4, 4), (5, 6), (7, float("inf")))
"""Lengths of the shortest path that are shown together, ends included."""

_BLUE, _ORANGE, _GREEN, _GREY, _RED = "#0072b2", "#e69f00", "#009e73", "#999999", "#d55e00"


def goals_figures(result: GoalsResult) -> dict[str, Figure]:
    """`goals_by_distance` and `goals_by_world`."""
    return {"goals_by_distance": _by_distance(result), "goals_by_world": _by_world(result)}


def _by_distance(result: GoalsResult) -> Figure:
    figure, panels = _panels("Steps to the goal, by the length of the shortest path (bars: mean, 95 % bootstrap)")
    for ax, known in zip(panels, (True, False), strict=True):
        for shift, aliased, colour in ((-0.2, False, _BLUE), (0.2, True, _ORANGE)):
            groups = [result.select(known=known, aliased=aliased, between=distance) for distance in DISTANCES]
            at = [i + shift for i in range(len(groups))]
            _bars(ax, at, [group.steps for group in groups], 0.38, colour, REPEAT if aliased else DIFFER)
            _marks(ax, at, [group.shortest for group in groups], "_", "black", "shortest path", first=not aliased)
            if not known:
                stood, frontier = [group.to_stand for group in groups], [group.frontier for group in groups]
                _marks(ax, at, stood, "o", _GREEN, "agent first there", first=not aliased)
                _marks(ax, at, frontier, "D", "white", "nearest-frontier search first there", first=not aliased)
            _failures(ax, at, groups)
        ax.set_xticks(range(len(DISTANCES)), [_distance(*distance) for distance in DISTANCES])
        ax.set_xlabel("steps of the shortest path")
        _finish(ax, known)
    return figure


def _by_world(result: GoalsResult) -> Figure:
    figure, panels = _panels("Steps to the goal, by maze (bars: mean, 95 % bootstrap)")
    for ax, known in zip(panels, (True, False), strict=True):
        groups = [result.select(known=known, world=world) for world in result.worlds]
        series = [("agent stays", _BLUE, [group.steps for group in groups])]
        if not known:
            series.insert(0, ("agent first there", _GREEN, [group.to_stand for group in groups]))
            series.append(("nearest-frontier search first there", _GREY, [group.frontier for group in groups]))
        width = 0.8 / max(len(series), 2)
        for number, (name, colour, bars) in enumerate(series):
            at = [i + (number - (len(series) - 1) / 2) * width for i in range(len(groups))]
            _bars(ax, at, bars, width * 0.95, colour, name)
        middle = [float(i) for i in range(len(groups))]
        _marks(ax, middle, [group.shortest for group in groups], "_", "black", "shortest path", first=True)
        _failures(ax, middle, groups)
        ax.set_xticks(range(len(groups)), result.worlds, rotation=30, ha="right")
        _finish(ax, known)
    return figure


def _panels(title: str) -> tuple[Figure, tuple[Axes, Axes]]:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 4.6), layout="constrained")
    figure.suptitle(title)
    return figure, (figure.add_subplot(1, 2, 1), figure.add_subplot(1, 2, 2))


def _bars(ax: Axes, at: list[float], bars: list[Interval | None], width: float, colour: str, name: str) -> None:
    shown = [(x, bar) for x, bar in zip(at, bars, strict=True) if bar is not None]
    heights = [bar.value for _, bar in shown]
    below = [max(bar.value - bar.low, 0.0) for _, bar in shown]
    above = [max(bar.high - bar.value, 0.0) for _, bar in shown]
    ax.bar([x for x, _ in shown], heights, width, color=colour, label=name)
    ax.errorbar([x for x, _ in shown], heights, (below, above), fmt="none", ecolor="black", elinewidth=1, capsize=2)


def _marks(
    ax: Axes, at: list[float], means: list[Interval | None], marker: str, colour: str, name: str, *, first: bool
) -> None:
    shown = [(x, mean.value) for x, mean in zip(at, means, strict=True) if mean is not None]
    size, width = (14, 2) if marker == "_" else (6, 0.8)
    ax.plot(
        [x for x, _ in shown],
        [y for _, y in shown],
        linestyle="none",
        marker=marker,
        markersize=size,
        markerfacecolor=colour,
        markeredgecolor="black",
        markeredgewidth=width,
        label=name if first else None,
        zorder=4,
    )


def _failures(ax: Axes, at: list[float], groups: list[Summary]) -> None:
    for x, group in zip(at, groups, strict=True):
        if group.failed:
            top = 0.0 if group.steps is None else group.steps.high
            text = f"{group.failed} of {group.runs} failed"
            ax.annotate(
                text, (x, top), (0, 4), textcoords="offset points", color=_RED, fontsize=7, rotation=90, ha="center"
            )


def _distance(least: float, most: float) -> str:
    return f"{least:g}" if least == most else f"{least:g} or more" if most == float("inf") else f"{least:g}, {most:g}"


def _finish(ax: Axes, known: bool) -> None:
    ax.set_title("with a map, moved without a word" if known else "in an unknown maze")
    ax.set_ylabel("steps until the agent stays on the goal" if known else "steps")
    ax.set_ylim(bottom=0.0)
    ax.spines[["top", "right"]].set_visible(False)
    ax.legend(fontsize=8, frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=3)
