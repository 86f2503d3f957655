"""What the agent believes the world to be."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..model import CognitiveMap
from .axes import Cell, as_grid, axes_or_new, cell_points, fitting_size, flat
from .colours import ink_on, sight_colour

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Link = tuple[Cell, Cell, float]

RADIUS = 0.24  # of a place, cells
LEAST = 0.05  # probabilities below are not drawn


def plot_map(map_: CognitiveMap, *, title: str | None = None, ax: Axes | None = None) -> Axes:
    """Places at their positions, and the transitions between them.

    Visited places are filled with the colour of their most probable sight, imagined ones are hollow. The
    half of a link that leaves a place is as wide and as dark as the transition from there is probable. A bar
    beside a place is a wall: P(blocked). Places without a position are counted under the plot.

    Args:
        map_: the map, in one or two dimensions.
        title: above the plot.
        ax: axes to draw on; new ones unless given.

    Raises:
        CogmapError: positions of more than two dimensions.
    """
    ax = axes_or_new(ax)
    found = ((place, map_.position(place)) for place in map_.places)
    cells = {place: flat(position) for place, position in found if position is not None}
    as_grid(ax, cells.values() or [(0.0, 0.0)])
    links, walls = _links(map_, cells)
    points = cell_points(ax)
    _draw_lines(ax, links, widest=min(0.11 * points, 7.0))
    _draw_lines(ax, walls, widest=min(0.06 * points, 4.0))
    for place, cell in cells.items():
        _draw_place(ax, map_, place, cell)
    if lost := len(map_.places) - len(cells):
        note = f"{lost} place{'s' if lost > 1 else ''} without a position"
        ax.text(0.5, -0.02, note, transform=ax.transAxes, ha="center", va="top", color="0.35")
    if title is not None:
        ax.set_title(title)
    return ax


def _links(map_: CognitiveMap, cells: dict[int, Cell]) -> tuple[list[Link], list[Link]]:
    """Half links and walls as (from, to, probability)."""
    links: list[Link] = []
    walls: list[Link] = []
    for place, (row, column) in cells.items():
        for action, vector in enumerate(map_.motions.displacements):
            if action == map_.motions.stay:
                continue
            keys, p, _ = map_.B_s.mean(np.array([map_.row(place, action)]))
            down, right = flat(vector)
            for key, probability in zip(keys[0].tolist(), p[0].tolist(), strict=True):
                if key == place:
                    walls.append((*_bar(row, column, down, right), probability))
                elif key in cells:
                    middle = ((row + cells[key][0]) / 2, (column + cells[key][1]) / 2)
                    links.append(((row, column), middle, probability))
    return links, walls


def _bar(row: float, column: float, down: float, right: float) -> tuple[Cell, Cell]:
    """Ends of a wall across the way (down, right)."""
    row, column = row + 0.42 * down, column + 0.42 * right
    return (row - 0.2 * right, column - 0.2 * down), (row + 0.2 * right, column + 0.2 * down)


def _draw_lines(ax: Axes, lines: list[Link], *, widest: float) -> None:
    """Lines as wide (`widest` points) and as dark as they are probable, the likely ones on top."""
    from matplotlib.collections import LineCollection

    drawn = sorted((line for line in lines if line[2] >= LEAST), key=lambda line: line[2])
    collection = LineCollection(
        [[(a[1], a[0]), (b[1], b[0])] for a, b, _ in drawn],
        linewidths=[max(widest * p, 0.4) for _, _, p in drawn],
        colors=[str(1.0 - 0.85 * p) for _, _, p in drawn],
        capstyle="round",
        zorder=1,
    )
    ax.add_collection(collection)


def _draw_place(ax: Axes, map_: CognitiveMap, place: int, cell: Cell) -> None:
    from matplotlib.patches import Circle

    row, column = cell
    points = cell_points(ax)
    thin = min(1.4, points / 18)
    if not map_.visited[place]:
        hollow = {"facecolor": "white", "edgecolor": "0.35", "linestyle": (0, (2, 1.5))}
        ax.add_patch(Circle((column, row), RADIUS, linewidth=thin, zorder=2, **hollow))
        return
    keys, p, _ = map_.A_o.mean(np.array([place]))
    label = map_.sights[int(keys[0, p[0].argmax()])]
    colour = sight_colour(label)
    ax.add_patch(Circle((column, row), RADIUS, facecolor=colour, edgecolor="black", linewidth=thin, zorder=2))
    size = fitting_size(str(label), width=1.6 * RADIUS * points, height=1.4 * RADIUS * points)
    if size is not None:
        ink = ink_on(colour)
        ax.text(column, row, str(label), size=size, color=ink, ha="center", va="center", zorder=3, parse_math=False)
