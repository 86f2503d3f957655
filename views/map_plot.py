"""What the agent believes the world to be."""

from collections.abc import Iterable
from typing import Any, Unpack

from ..model import CogmapError, CognitiveMap
from ..worlds import Chart
from .axes import Axes, Cell, Where, as_grid, axes_or_new, flat
from .map_picture import MapPicture
from .picture import Picture, draw_picture
from .theme import theme_of
from .world_plot import as_place, world_picture

Beneath = tuple[Picture | None, Cell]


def plot_map(map_: CognitiveMap, *, chart: Chart | None = None, start: Any = (0, 0), **where: Unpack[Where]) -> Axes:
    """Places at their positions, or laid out where there are none, and the transitions between them.

    Visited places are filled with the colour of their most probable sight, imagined ones are hollow and dashed.
    The half of a link that leaves a place is as wide and as dark as the transition from there is probable. A bar
    beside a place is a wall: P(blocked); a door of which nothing is known has none. Places without a position are
    counted under the plot.

    Raises:
        CogmapError: positions of more than two dimensions, or `start` is no place of the chart.
    """
    ax = axes_or_new(**where)
    draw_map(ax, MapPicture.of(map_), underlay(chart, start))
    return ax


def underlay(chart: Chart | None, start: Any) -> Beneath:
    """The picture of the true map, if there is one, and the cell that the agent takes as its origin.

    Raises:
        CogmapError: `start` is no place of the chart.
    """
    if chart is None:
        return None, flat(start)
    world, place = world_picture(chart), as_place(start)
    if place not in world.cells:
        raise CogmapError(f"plot: start {start!r} is no place of {chart.name!r}; see chart.places")
    return world, world.cells[place]


def draw_map(
    ax: Axes, map_: MapPicture, beneath: Beneath, *, note: str = "", room: Iterable[Cell] = (), margin: float = 0.15
) -> Picture:
    """Draw a map, over the true one where it is given, with a note under it, and return what was drawn of it.

    `room` are cells that are left room for, whether there is a place or not.
    """
    world, origin = beneath
    picture = map_.drawn(origin)
    cells = [*picture.cells.values(), *(world.cells.values() if world else ()), *room]
    as_grid(ax, cells or [(0.0, 0.0)], margin=margin)
    if world:
        draw_picture(ax, world, thick=0.04, faint=True)
    draw_picture(ax, picture)
    if lost := len(map_.places) - len(picture.cells):
        note = f"{lost} place{'s' if lost > 1 else ''} without a position\n{note}".strip()
    if note:
        ax.text(0.5, -0.02, note, transform=ax.transAxes, ha="center", va="top", color=theme_of(ax).shade(0.8))
    return picture
