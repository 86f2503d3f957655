"""What the agent believes the world to be."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..model import CognitiveMap
from .axes import Cell, as_grid, axes_or_new, cell_points, flat, write_in
from .colours import ink_on, sight_colour
from .map_picture import MapPicture, PlacePicture, picture_of
from .maze_plot import Sights, draw_rooms
from .theme import Theme, theme_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Line = tuple[Cell, Cell, float]

RADIUS = 0.24  # of a place, cells


def plot_map(
    map_: CognitiveMap,
    *,
    sights: Sights | None = None,
    start: Sequence[float] = (0, 0),
    title: str | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Places at their positions, and the transitions between them.

    Visited places are filled with the colour of their most probable sight, imagined ones are hollow and dashed.
    The half of a link that leaves a place is as wide and as dark as the transition from there is probable. A bar
    beside a place is a wall: P(blocked); a door of which nothing is known has none. Places without a position are
    counted under the plot.

    Args:
        map_: the map, in one or two dimensions.
        sights: the rooms of the true maze, drawn faintly beneath; label by (row, column).
        start: row and column of the place that the agent takes as its origin.
        title: above the plot.
        ax: axes to draw on; new ones unless given.

    Raises:
        CogmapError: positions of more than two dimensions.
    """
    ax = axes_or_new(ax)
    draw_picture(ax, picture_of(map_), sights=sights, start=start)
    if title is not None:
        ax.set_title(title)
    return ax


def draw_picture(
    ax: Axes,
    picture: MapPicture,
    *,
    sights: Sights | None = None,
    start: Sequence[float] = (0, 0),
    notes: Sequence[str] = (),
    room: Sequence[Cell] = (),
    margin: float = 0.15,
) -> None:
    """The picture of a map, over the rooms of the true maze where they are given, and notes under it.

    `room` are cells that are left room for, whether there is a place or not.
    """
    places = [shifted(place, start) for place in picture.places.values()]
    cells = [place.cell for place in places]
    as_grid(ax, [*cells, *(sights or {}), *room] or [(0.0, 0.0)], margin=margin)
    theme = theme_of(ax)
    if sights:
        draw_rooms(ax, sights, faint=True)
    points = cell_points(ax)
    links = [_half(place.cell, to, p) for place in places for to, p in place.links]
    walls = [(*_bar(place.cell, way), p) for place in places for way, p in place.walls]
    _draw_lines(ax, links, theme, widest=min(0.11 * points, 7.0), cap="butt")
    _draw_lines(ax, walls, theme, widest=min(0.06 * points, 4.0), cap="round")
    for place in places:
        _draw_place(ax, place, theme, thin=min(1.4, points / 18))
    if picture.lost:
        notes = (f"{picture.lost} place{'s' if picture.lost > 1 else ''} without a position", *notes)
    if notes:
        ax.text(0.5, -0.02, "\n".join(notes), transform=ax.transAxes, ha="center", va="top", color=theme.shade(0.8))


def shifted(place: PlacePicture, start: Sequence[float]) -> PlacePicture:
    """The place where the true maze has it."""
    row, column = flat(start)
    if not row and not column:
        return place
    links = tuple(((to[0] + row, to[1] + column), p) for to, p in place.links)
    cell = (place.cell[0] + row, place.cell[1] + column)
    return PlacePicture(cell, place.visited, place.sight, links, place.walls)


def _half(cell: Cell, to: Cell, probability: float) -> Line:
    # a hair beyond the middle: halves that only met would show a seam
    return cell, (cell[0] + 0.51 * (to[0] - cell[0]), cell[1] + 0.51 * (to[1] - cell[1])), probability


def _bar(cell: Cell, way: Cell) -> tuple[Cell, Cell]:
    """Ends of a wall across the way (down, right)."""
    down, right = way
    row, column = cell[0] + 0.42 * down, cell[1] + 0.42 * right
    return (row - 0.2 * right, column - 0.2 * down), (row + 0.2 * right, column + 0.2 * down)


def _draw_lines(ax: Axes, lines: Sequence[Line], theme: Theme, *, widest: float, cap: str) -> None:
    """Lines as wide (`widest` points) and as strong as they are probable, the likely ones on top."""
    from matplotlib.collections import LineCollection

    drawn = sorted(lines, key=lambda line: line[2])
    collection = LineCollection(
        [[(a[1], a[0]), (b[1], b[0])] for a, b, _ in drawn],
        linewidths=[max(widest * p, 0.8) for _, _, p in drawn],
        colors=[theme.shade(0.3 + 0.6 * p) for _, _, p in drawn],
        capstyle=cap,  # pyright: ignore[reportArgumentType]
        zorder=1.2,
    )
    ax.add_collection(collection)


def _draw_place(ax: Axes, place: PlacePicture, theme: Theme, *, thin: float) -> None:
    from matplotlib.patches import Circle

    row, column = place.cell
    if not place.visited:
        hollow: dict[str, Any] = {"facecolor": theme.paper, "edgecolor": theme.shade(0.75), "linestyle": (0, (2, 1.5))}
        ax.add_artist(Circle((column, row), RADIUS, linewidth=thin, zorder=2, **hollow))
        return
    colour = sight_colour(place.sight)
    ax.add_artist(Circle((column, row), RADIUS, facecolor=colour, edgecolor=theme.ink, linewidth=thin, zorder=2))
    box = (1.6 * RADIUS, 1.2 * RADIUS)
    write_in(ax, column, row, str(place.sight), box=box, color=ink_on(colour), zorder=3)
