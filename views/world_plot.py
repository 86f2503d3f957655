"""A world, and the way somebody took through it."""

from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import Any, Unpack

import numpy as np

from ..model import CogmapError
from ..worlds import Chart, Place
from .axes import Axes, Cell, Where, as_grid, axes_or_new, cell_points
from .layout import spread
from .picture import Floats, Picture, draw_picture

LANE = 0.09  # to the right of the middle, so that there and back are two lines


def plot_world(
    chart: Chart, *, path: Sequence[Place] = (), closed: Iterable[Place] = (), **where: Unpack[Where]
) -> Axes:
    """Places in the colours of their labels, and a path from black (first step) to white (last).

    Rooms on a grid are squares, with a line where a wall stands between two side by side. Other places are circles at
    their positions, or laid out where they have none; of a way that leads back nowhere only the first half is drawn.

    Args:
        chart: the true map of a world: `world.chart`, or a maze.
        path: the places walked through, in order; moves keep to the right, and where no way leads from one place to
            the next the line is dashed.
        closed: places that are closed, to be hatched.

    Raises:
        CogmapError: a path through, or a closed place that is, no place of the chart.
    """
    picture = world_picture(chart)
    path, shut = [as_place(place) for place in path], {as_place(place) for place in closed}
    if strange := [place for place in (*path, *shut) if place not in picture.cells]:
        raise CogmapError(f"plot_world: {strange[0]!r} is no place of {chart.name!r}; see chart.places")
    ax = axes_or_new(**where)
    as_grid(ax, picture.cells.values())
    draw_picture(ax, picture, thick=0.04, closed=shut)
    if path:
        _draw_path(ax, picture, path)
    return ax


def as_place(place: Any) -> Place:
    """A place as charts have it: rooms may come as lists or arrays."""
    return tuple(int(part) for part in place) if isinstance(place, list | np.ndarray) else place


def world_picture(chart: Chart) -> Picture:
    """Places at their positions, seen from above, or laid out where there are none."""
    ways = {(a, b): None for a in chart.places for b in chart.successors(a).values() if a != b}
    cells = {place: (0.0 - y, x) for place, (x, y) in _points(chart, ways).items()}  # 0.0 -: no -0.0
    whole = len(set(cells.values())) == len(cells) and all(
        part.is_integer() for cell in cells.values() for part in cell
    )
    beside = all(abs(cells[a][0] - cells[b][0]) + abs(cells[a][1] - cells[b][1]) == 1.0 for a, b in ways)
    rooms = whole and beside and all((b, a) in ways for a, b in ways)
    return Picture(cells, chart.sights, [(a, b, 1.0) for a, b in ways], _walls(cells, ways) if rooms else (), rooms)


def _points(chart: Chart, ways: Iterable[tuple[Place, Place]]) -> Mapping[Place, tuple[float, float]]:
    """x and y of each place; those side by side are a unit apart."""
    from scipy.spatial import KDTree

    where = chart.positions
    if where is None:
        return spread(chart.places, ways)
    space = np.array([(*where[place], 0.0, 0.0)[:3] for place in chart.places], dtype=np.float64)
    points = space[:, :2] + space[:, 2:] * (0.0, 0.5)  # what lies higher is drawn further up
    if len(points) > 1:
        nearest = KDTree(points).query(points, k=2)[0][:, 1]
        points = points / (np.median(nearest[nearest > 0.0]) if nearest.any() else 1.0)
    return dict(zip(chart.places, map(tuple, points.tolist()), strict=True))


def _walls(cells: Mapping[Place, Cell], ways: Mapping[tuple[Place, Place], Any]) -> list[tuple[Cell, Cell, float]]:
    """Between rooms side by side that no way joins."""
    found: list[tuple[Cell, Cell, float]] = []
    at = {cell: place for place, cell in cells.items()}
    for (row, column), place in at.items():
        for down, right in ((0.5, 0.0), (0.0, 0.5)):
            other = at.get((row + 2 * down, column + 2 * right))
            if other is not None and (place, other) not in ways:
                one, end = ((row + down + sign * right, column + right + sign * down) for sign in (-1.0, 1.0))
                found.append((one, end, 1.0))
    return found


def _draw_path(ax: Axes, picture: Picture, path: Sequence[Place]) -> None:
    from matplotlib.collections import LineCollection

    width = min(max(cell_points(ax) / 14, 1.0), 5.0)
    pieces = [lanes(piece)[:, ::-1] for piece in _pieces(picture, path)]
    segments = [segment for piece in pieces for segment in np.stack([piece[:-1], piece[1:]], axis=1)]
    shades = np.linspace(0.0, 1.0, max(len(segments), 1))
    for left, entered in pairwise(pieces):
        jump: dict[str, Any] = {"color": "black", "gapcolor": "white", "linewidth": width / 2, "zorder": 2.9}
        ax.plot(*zip(left[-1], entered[0], strict=True), linestyle=(0, (3, 2)), **jump)
    # a white rim around a black one: whatever the floor and the shade, one of the two borders shows
    looks = (("white", width + 2.4, 3.0), ("black", width + 1.2, 3.1), ([str(shade) for shade in shades], width, 3.2))
    for colours, wide, above in looks:
        style: dict[str, Any] = {"colors": colours, "linewidths": wide, "capstyle": "round", "zorder": above}
        ax.add_collection(LineCollection(segments, **style))
    ends: dict[str, Any] = {"marker": "o", "linewidths": 1.2, "zorder": 4}
    for point, size, inside, rim, name in (
        (pieces[-1][-1], 2.2 * width, "white", "black", "end"),
        (pieces[0][0], 1.6 * width, "black", "white", "start"),
    ):
        ax.scatter(*point, s=size**2, color=inside, edgecolors=rim, label=name, **ends)


def _pieces(picture: Picture, path: Sequence[Place]) -> list[Floats]:
    """The line `[T, 2]` of each part of a path that was walked; where no way leads on, somebody was put there."""
    lines, pieces = picture.lines, [[np.array([picture.cells[path[0]]])]]
    for a, b in pairwise(path):
        if (a, b) in lines:
            pieces[-1].append(lines[a, b][1:])
        elif a != b:
            pieces.append([np.array([picture.cells[b]])])
    return [np.concatenate(piece) for piece in pieces]


def lanes(line: Floats) -> Floats:
    """A line `[T, 2]` (row, column) that keeps to the right of the one given.

    A corner lies where the lanes of its two sides meet; where they turn back it crosses over.
    """
    moves = np.diff(line, axis=0)
    moves = moves[np.abs(moves).sum(axis=1) > 0.0]
    if not len(moves):
        return line[:1]
    stops = np.concatenate([line[:1], line[0] + moves.cumsum(axis=0)])
    ahead = moves / np.linalg.norm(moves, axis=1, keepdims=True)
    right = np.stack([ahead[:, 1], -ahead[:, 0]], axis=1)  # of "up" is "right": (-1, 0) -> (0, 1)
    found = [stops[0] + LANE * right[0]]
    for before, after, way, stop in zip(right[:-1], right[1:], ahead, stops[1:-1], strict=False):
        if before @ after < -0.5:
            found.extend([stop + LANE * (before + way), stop + LANE * (after + way)])
        else:
            found.append(stop + LANE * (before + after) / (1.0 + before @ after))
    return np.array([*found, stops[-1] + LANE * right[-1]])
