"""What the figures of the studies share: panels, bars with intervals, and ways through a maze."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Protocol

from ...views import VERMILION, plot_maze, plot_policies, theme_of
from ...worlds import Door, Maze, Position
from .imagined import ImaginedPath

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDEST = 13.0
"""Points of the door that was walked through most."""


class Sure(Protocol):
    """A figure and its interval."""

    @property
    def value(self) -> float:
        """The figure."""
        ...

    @property
    def low(self) -> float:
        """End of its interval."""
        ...

    @property
    def high(self) -> float:
        """The other end."""
        ...


def panels(title: str, count: int, size: tuple[float, float], **options: Any) -> tuple[Figure, list[Axes]]:
    """A figure with so many axes side by side; `options` are those of `Figure.subplots`."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, layout="constrained")
    figure.suptitle(title, fontsize=13)
    axes = list(figure.subplots(1, count, squeeze=False, **options)[0])
    for ax in axes:
        ax.spines[["top", "right"]].set_visible(False)
    return figure, axes


def legend_below(figure: Figure, ax: Axes, columns: int) -> None:
    """The legend of these axes, for all, under them."""
    handles, labels = ax.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=columns, frameon=False)


def shares_axis(ax: Axes, label: str, top: float = 1.0) -> None:
    """Shares upwards, in percent, with room up to `top`."""
    from matplotlib.ticker import PercentFormatter

    ax.set_ylabel(label)
    ax.set_ylim(0.0, top)
    ax.set_yticks([0.0, 0.25, 0.5, 0.75, 1.0])
    ax.yaxis.set_major_formatter(PercentFormatter(1.0))


def errors(values: Sequence[Sure]) -> tuple[list[float], list[float]]:
    """How far the intervals reach down and up, as `errorbar` wants it."""
    return [max(v.value - v.low, 0.0) for v in values], [max(v.high - v.value, 0.0) for v in values]


def plot_bars(
    ax: Axes, at: Sequence[float], values: Sequence[Sure | None], *, texts: Sequence[str] = (), **style: Any
) -> None:
    """Bars with their intervals, and texts above them; none where there is no value. `style` is that of `Axes.bar`."""
    there = [(x, value) for x, value in zip(at, values, strict=True) if value is not None]
    places, heights = [x for x, _ in there], [value.value for _, value in there]
    ax.bar(places, heights, **style)
    spans = errors([value for _, value in there])
    ax.errorbar(places, heights, spans, fmt="none", ecolor=theme_of(ax).shade(0.8), elinewidth=1.0, capsize=2.5)
    for x, value, text in zip(at, values, texts, strict=False):
        if value is not None:
            ax.annotate(text, (x, value.high), (0, 2), textcoords="offset points", ha="center", va="bottom", size=9)


def plot_ways(
    ax: Axes,
    maze: Maze,
    *,
    closed: Position | None = None,
    imagined: Sequence[ImaginedPath] = (),
    way: Sequence[Position] = (),
) -> None:
    """The maze, a closed room hatched, imagined paths by their probability, and the way of an agent up to its cross."""
    plot_maze({room: sight for room, sight in maze.sights.items() if room != closed}, ax=ax)
    theme = theme_of(ax)
    if closed is not None:
        draw_room(ax, closed, facecolor=theme.paper, edgecolor=theme.shade(0.75), hatch="////", zorder=2)
    if imagined:
        plot_policies({path.rooms: path.probability for path in imagined}, ax=ax)
    rows, columns = [room[0] for room in way], [room[1] for room in way]
    for colour, width in ((theme.shade(0.65), 3.6), (theme.paper, 1.8)):
        ax.plot(columns, rows, color=colour, linewidth=width, zorder=3)
    look: dict[str, Any] = {"color": VERMILION, "edgecolors": theme.paper, "linewidths": 1.3}
    ax.scatter(columns[-1:], rows[-1:], marker="X", s=150, zorder=6, **look)


def plot_flow(ax: Axes, maze: Maze, paths: Sequence[Sequence[Position]], *, closed: Position | None = None) -> None:
    """The maze, paler, with a line through each door, wider and darker the more often it was walked through."""
    plot_ways(ax, maze, closed=closed)
    theme, counts = theme_of(ax), flow(paths)
    for room in maze.rooms:
        draw_room(ax, room, facecolor=theme.paper, alpha=0.5, zorder=1.5)
    for (at, to), count in sorted(counts.items(), key=lambda item: item[1]):
        share = count / max(counts.values())
        look: dict[str, Any] = {"color": theme.shade(0.38 + 0.62 * share), "linewidth": 0.8 + WIDEST * share}
        ax.plot([at[1], to[1]], [at[0], to[0]], zorder=2.1 + share, solid_capstyle="round", **look)


def flow(paths: Sequence[Sequence[Position]]) -> Counter[Door]:
    """Moves through each door, both ways together, by its rooms in row-major order."""
    return Counter((min(at, to), max(at, to)) for path in paths for at, to in pairwise(path) if at != to)


def draw_room(ax: Axes, room: Position, **style: Any) -> None:
    """A square over a room; `style` is that of matplotlib's `Rectangle`."""
    from matplotlib.patches import Rectangle

    ax.add_patch(Rectangle((room[1] - 0.46, room[0] - 0.46), 0.92, 0.92, **style))
