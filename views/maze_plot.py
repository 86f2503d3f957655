"""A maze, and the way somebody took through it."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..model.errors import CogmapError
from .axes import as_grid, axes_or_new, cell_points, fitting_size, flat
from .colours import ink_on, sight_colour

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LANE = 0.09  # cells to the right of the middle, so that there and back are two lines


def plot_maze(
    sights: Mapping[tuple[int, int], Hashable],
    *,
    path: Sequence[Sequence[int]] | None = None,
    title: str | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Rooms in the colours of their labels, and a path from black (first step) to white (last).

    Args:
        sights: label of each room, by (row, column).
        path: the rooms walked through, in order; moves keep to the right.
        title: above the plot.
        ax: axes to draw on; new ones unless given.

    Raises:
        CogmapError: no rooms, or a path that leaves them.
    """
    if not sights:
        raise CogmapError("plot_maze: there are no rooms; give at least one")
    if strange := [tuple(room) for room in path or () if tuple(room) not in sights]:
        raise CogmapError(f"plot_maze: the path goes through {strange[0]}, which is no room; give rooms only")
    ax = axes_or_new(ax)
    as_grid(ax, sights)
    _draw_rooms(ax, sights)
    if path:
        _draw_path(ax, np.array([flat(room) for room in path]))
    if title is not None:
        ax.set_title(title)
    return ax


def _draw_rooms(ax: Axes, sights: Mapping[tuple[int, int], Hashable]) -> None:
    from matplotlib.patches import Rectangle
    from matplotlib.patheffects import withStroke

    points = cell_points(ax)
    for (row, column), label in sights.items():
        colour = sight_colour(label)
        corner = (column - 0.5, row - 0.5)
        ax.add_patch(Rectangle(corner, 1, 1, facecolor=colour, edgecolor="white", linewidth=min(1.5, points / 20)))
        size = fitting_size(str(label), width=0.8 * points, height=0.25 * points)
        if size is not None:
            place = (column - 0.44, row - 0.44)
            text = ax.text(*place, str(label), size=size, color=ink_on(colour), va="top", parse_math=False, zorder=5)
            text.set_path_effects([withStroke(linewidth=2, foreground=colour)])


def _draw_path(ax: Axes, rooms: NDArray[np.float64]) -> None:
    """`rooms [T, 2]`, rows and columns."""
    from matplotlib.collections import LineCollection

    points = cell_points(ax)
    line = lanes(rooms)[:, ::-1]
    width = min(max(points / 18, 0.8), 4.0)
    shades = np.linspace(0.0, 1.0, max(len(line) - 1, 1))
    segments = list(np.stack([line[:-1], line[1:]], axis=1)) if len(line) > 1 else []
    # a grey rim keeps both ends of the scale apart from any floor
    ax.add_collection(LineCollection(segments, colors="0.35", linewidths=width * 1.7, capstyle="round", zorder=3))
    ax.add_collection(
        LineCollection(segments, colors=[str(s) for s in shades], linewidths=width, capstyle="round", zorder=3.1)
    )
    ends = {"marker": "o", "s": (2.6 * width) ** 2, "linewidths": width * 0.5, "zorder": 4}
    ax.scatter(*line[-1], color="white", edgecolors="black", label="end", **ends)
    ax.scatter(*line[0], color="black", edgecolors="white", label="start", **{**ends, "s": (1.8 * width) ** 2})


def lanes(rooms: NDArray[np.float64]) -> NDArray[np.float64]:
    """The line of a walk `[T, 2]` (row, column) that keeps to the right of the middle.

    A corner lies where the lanes of its two moves meet; the turn at a dead end crosses over.
    """
    moves = np.diff(rooms, axis=0)
    moves = moves[np.abs(moves).sum(axis=1) > 0]
    if not len(moves):
        return rooms[:1]
    stops = np.concatenate([rooms[:1], rooms[0] + moves.cumsum(axis=0)])
    right = LANE * np.stack([moves[:, 1], -moves[:, 0]], axis=1)  # of "up" is "right": (-1, 0) -> (0, 1)
    line = [stops[0] + right[0]]
    for before, after, move, stop in zip(right[:-1], right[1:], moves, stops[1:-1], strict=False):
        if (before == -after).all():
            line.extend([stop + before + LANE * move, stop + after + LANE * move])
        else:
            line.append(stop + np.where(before == 0, after, before))
    return np.array([*line, stops[-1] + right[-1]])
