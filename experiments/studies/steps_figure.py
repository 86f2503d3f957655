"""Steps by maze as points with intervals; means that are lower bounds are hollow and point upwards."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from .steps import Steps

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True, slots=True)
class Look:
    """How a model is drawn; colours of Okabe and Ito (2008), told apart with any colour vision."""

    colour: str
    marker: str


LEAST = 0.5
"""Steps that stand for none, which has no logarithm."""

LOOKS = {
    "oracle": Look("#000000", "_"),
    "cogmap": Look("#0072b2", "o"),
    "frontier": Look("#009e73", "P"),
    "random": Look("#999999", "X"),
    "cscg": Look("#d55e00", "s"),
    "cscg_pose": Look("#e69f00", "D"),
    "cscg_random": Look("#cc79a7", "^"),
    "cscg_pose_random": Look("#56b4e9", "v"),
    "static": Look("#cc79a7", "s"),
    "observed": Look("#e69f00", "D"),
    "predicted": Look("#0072b2", "o"),
}


@dataclass(frozen=True, slots=True)
class Series:
    """One model in every maze.

    Attributes:
        name: in the legend.
        look: colour and marker.
        steps: by maze.
        published: means of others to show beside, by maze; None where there is none.
    """

    name: str
    look: Look
    steps: Sequence[Steps]
    published: Sequence[float | None] = ()


def steps_figure(
    title: str, label: str, worlds: Sequence[str], series: Sequence[Series], *, cap: int, published: str = ""
) -> Figure:
    """Means with 95 % intervals, on a logarithmic scale.

    Args:
        title: of the figure.
        label: of its steps.
        worlds: the mazes.
        series: one or more, each with a value for every maze.
        cap: moves after which a run gave up; drawn where some run did.
        published: what `Series.published` are called; not drawn if empty.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 5.6), layout="constrained")
    ax = figure.add_subplot()
    ax.set_yscale("log")
    slot = 0.84 / len(series)
    for number, one in enumerate(series):
        at = [world + (number - (len(series) - 1) / 2) * slot for world in range(len(worlds))]
        _points(ax, at, one)
        _beside(ax, [x + 0.4 * slot for x in at], one)
    some_gave_up = any(steps.censored for one in series for steps in one.steps)
    _explain(ax, published, cap if some_gave_up else None)
    for edge in range(1, len(worlds)):
        ax.axvline(edge - 0.5, color="#dddddd", linewidth=0.8, zorder=0)
    _finish(ax, title, label, worlds, room=some_gave_up)
    return figure


def _points(ax: Axes, at: Sequence[float], series: Series) -> None:
    colour, line = series.look.colour, series.look.marker == "_"
    for number, (x, steps) in enumerate(zip(at, series.steps, strict=True)):
        value = max(steps.bound.value, LEAST)
        below, above = value - max(steps.bound.low, LEAST), steps.bound.high - value
        ax.errorbar(
            [x],
            [value],
            None if line else ([max(below, 0.0)], [max(above, 0.0)]),
            color=colour,
            marker=series.look.marker,
            markersize=12 if line else 6.5,
            markerfacecolor="white" if steps.censored else colour,
            markeredgewidth=2.0 if line else 1.4,
            elinewidth=1.4,
            capsize=2.5,
            linestyle="none",
            label="_" if number else series.name,
            zorder=3,
        )
        if steps.censored:
            _gave_up(ax, x, max(steps.bound.high, value), steps, colour)


def _gave_up(ax: Axes, x: float, top: float, steps: Steps, colour: str) -> None:
    """An arrow upwards, and how many got there of how many."""
    arrow = {"arrowstyle": "<-", "color": colour, "linewidth": 1.4, "shrinkA": 2, "shrinkB": 0}
    ax.annotate("", (x, top), (0, 20), textcoords="offset points", arrowprops=arrow)
    ax.annotate(
        f"{steps.got}/{steps.runs}",
        (x, top),
        (0, 23),
        textcoords="offset points",
        ha="center",
        va="bottom",
        fontsize=7,
        rotation=90,
    )


def _beside(ax: Axes, at: Sequence[float], series: Series) -> None:
    shown = [(x, value) for x, value in zip(at, series.published, strict=False) if value is not None]
    if shown:
        xs, ys = zip(*shown, strict=True)
        ax.plot(xs, ys, linestyle="none", marker="x", markersize=5, color=series.look.colour, zorder=4)


def _explain(ax: Axes, published: str, cap: int | None) -> None:
    """Entries of the legend that are of no model, and the line of the cap."""
    grey = "#444444"
    if published:
        ax.plot([], [], linestyle="none", color=grey, marker="x", markersize=5, label=published)
    if cap is not None:
        text = "some gave up (got there/runs): lower bound"
        ax.plot([], [], linestyle="none", color=grey, marker="o", markerfacecolor="white", label=text)
        ax.axhline(cap, color=grey, linewidth=0.8, linestyle=":", zorder=0, label=f"cap of {cap} moves")


def _finish(ax: Axes, title: str, label: str, worlds: Sequence[str], *, room: bool) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    ax.set_title(title, pad=10)
    ax.set_ylabel(label)
    ax.set_xticks(range(len(worlds)), worlds)
    ax.set_xlim(-0.5, len(worlds) - 0.5)
    low, high = ax.get_ylim()
    ax.set_ylim(low * 0.9, high * (1.5 if room else 1.1))
    ax.yaxis.set_major_locator(
        LogLocator(subs=(1.0, 2.0, 5.0) if high / low > 10.0 else (1.0, 1.5, 2.0, 3.0, 5.0, 7.0))
    )
    ax.yaxis.set_major_formatter(FuncFormatter(plain))
    ax.yaxis.set_minor_formatter(NullFormatter())
    ax.grid(axis="y", color="#eeeeee", linewidth=0.8)
    ax.set_axisbelow(True)
    ax.spines[["top", "right"]].set_visible(False)
    handles, labels = ax.get_legend_handles_labels()
    models_first = sorted(range(len(labels)), key=lambda i: isinstance(handles[i], Line2D))
    ax.legend(
        [handles[i] for i in models_first],
        [labels[i] for i in models_first],
        fontsize=8,
        frameon=False,
        loc="upper center",
        bbox_to_anchor=(0.5, -0.08),
        ncols=6,
    )


def plain(value: float, _: int) -> str:
    """A tick as a plain number."""
    return f"{value:g}"
