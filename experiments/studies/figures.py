"""What the figures of the studies share: panels, bars and lines with intervals, and ways through a maze."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from ...model import CognitiveMap
from ...planning import Plan
from ...views import VERMILION, plot_policies, plot_world, policy_paths, theme_of
from ...worlds import Door, Maze, Position
from .intervals import Interval, Share

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
else:  # imported when something is drawn
    Axes = Figure = Any

LEAST = 1e-3  # imagined paths that are less probable are left out
WIDEST = 13.0  # points of the door that was walked through most

Sure = Interval | Share
Way = Sequence[Position]  # the rooms that were walked through
Look = dict[str, Any]  # of what is drawn, as matplotlib takes it


def panels(title: str, shape: tuple[int, int], size: tuple[float, float], **options: Any) -> tuple[Figure, list[Axes]]:
    """A figure with so many axes down and across; `options` are those of `Figure.subplots`."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, layout="constrained")
    figure.suptitle(title, fontsize=13)
    axes = list(figure.subplots(*shape, squeeze=False, **options).ravel())
    for ax in axes:
        ax.spines[["top", "right"]].set_visible(False)
    return figure, axes


def legend_below(figure: Figure, ax: Axes, columns: int) -> None:
    """The legend of these axes, for all, under them."""
    handles, labels = ax.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=columns, frameon=False)


def shares_axis(ax: Axes, label: str, low: float = 0.0, high: float = 1.0) -> None:
    """Shares upwards, in percent."""
    from matplotlib.ticker import PercentFormatter

    ax.set_ylabel(label)
    ax.set_ylim(low, high)
    ax.set_yticks([0.0, 0.25, 0.5, 0.75, 1.0])
    ax.yaxis.set_major_formatter(PercentFormatter(1.0))


def errors(values: Sequence[Sure]) -> tuple[list[float], list[float]]:
    """How far the intervals reach down and up, as `errorbar` wants it."""
    return [max(v.value - v.low, 0.0) for v in values], [max(v.high - v.value, 0.0) for v in values]


def plot_line(ax: Axes, at: Sequence[float], values: Sequence[Sure], **style: Any) -> None:
    """A line through values with their intervals; `style` is that of `Axes.errorbar`."""
    look: Look = {"capsize": 2, **style}
    ax.errorbar(at, [value.value for value in values], errors(values), **look)


def plot_bars(
    ax: Axes, at: Sequence[float], values: Sequence[Sure | None], *, texts: Sequence[str] = (), **style: Any
) -> None:
    """Bars with their intervals, and texts above them; none where there is no value. `style` is that of `Axes.bar`."""
    there = [(x, value) for x, value in zip(at, values, strict=True) if value is not None]
    places, shown = [x for x, _ in there], [value for _, value in there]
    ax.bar(places, [value.value for value in shown], **style)
    plot_line(ax, places, shown, fmt="none", ecolor=theme_of(ax).shade(0.8), elinewidth=1.0)
    for x, value, text in zip(at, values, texts, strict=False):
        if value is not None:
            ax.annotate(text, (x, value.high), (0, 2), textcoords="offset points", ha="center", va="bottom", size=9)


@dataclass(frozen=True, slots=True)
class ImaginedPath:
    """A path that some policies lead along, from where the agent may be."""

    rooms: tuple[Position, ...]  # one after the other; where a policy stays or bumps, the room is not repeated
    probability: float  # Q(s) of its first place times P(policy), summed over the policies that lead along it


def imagined_paths(plan: Plan, map_: CognitiveMap, start: Position) -> tuple[ImaginedPath, ...]:
    """Where the policies of a plan lead if every way is as the map has it, the most probable path first.

    `start` is the room that the agent takes as its origin.
    """
    paths = policy_paths(plan, map_, start=start, least=LEAST)
    return tuple(
        ImaginedPath(tuple((int(row), int(column)) for row, column in path), round(probability, 6))
        for path, probability in paths.items()
    )


def plot_ways(
    ax: Axes, maze: Maze, *, closed: Position | None = None, imagined: Sequence[ImaginedPath] = (), way: Way = ()
) -> None:
    """The maze, a closed room hatched, imagined paths by their probability, and the way of an agent up to its cross."""
    plot_world(maze, closed=[] if closed is None else [closed], ax=ax)
    theme, rows, columns = theme_of(ax), [room[0] for room in way], [room[1] for room in way]
    if imagined:
        plot_policies({path.rooms: path.probability for path in imagined}, ax=ax)
    for colour, width in ((theme.shade(0.65), 3.6), (theme.paper, 1.8)):
        ax.plot(columns, rows, color=colour, linewidth=width, zorder=3)
    look: Look = {"color": VERMILION, "edgecolors": theme.paper, "linewidths": 1.3}
    ax.scatter(columns[-1:], rows[-1:], marker="X", s=150, zorder=6, **look)


def plot_flow(ax: Axes, maze: Maze, paths: Sequence[Way], *, closed: Position | None = None) -> None:
    """The maze, paler, with a line through each door, wider and darker the more often it was walked through."""
    plot_ways(ax, maze, closed=closed)
    moves = [(min(at, to), max(at, to)) for path in paths for at, to in pairwise(path) if at != to]
    theme, counts = theme_of(ax), Counter[Door](moves)
    for room in set(maze.rooms) - {closed}:
        draw_room(ax, room, 1.0, facecolor=theme.paper, alpha=0.5, zorder=1.5)
    for (at, to), count in sorted(counts.items(), key=lambda item: item[1]):
        share = count / max(counts.values())
        look: Look = {"color": theme.shade(0.38 + 0.62 * share), "linewidth": 0.8 + WIDEST * share}
        ax.plot([at[1], to[1]], [at[0], to[0]], zorder=2.1 + share, solid_capstyle="round", **look)


def draw_room(ax: Axes, room: Position, side: float = 0.92, **style: Any) -> None:
    """A square over a room; `style` is that of matplotlib's `Rectangle`."""
    from matplotlib.patches import Rectangle

    ax.add_patch(Rectangle((room[1] - side / 2, room[0] - side / 2), side, side, **style))
