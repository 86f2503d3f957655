"""A maze, and the way somebody took through it."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..model.errors import CogmapError
from .axes import as_grid, axes_or_new, cell_points, flat, write_in
from .colours import ink_on, mixed, sight_colour
from .theme import theme_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Sights = Mapping[tuple[int, int], Hashable]

LANE = 0.09  # cells to the right of the middle, so that there and back are two lines
FAINT = 0.3  # how much of a floor's colour is left beneath a map


def plot_maze(
    sights: Sights,
    *,
    path: Sequence[Sequence[int]] | None = None,
    title: str | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Rooms in the colours of their labels, and a path from black (first step) to white (last).

    Args:
        sights: label of each room, by (row, column).
        path: the rooms walked through, in order; moves keep to the right, and where a room is not next to the one
            before the line is dashed.
        title: above the plot.
        ax: axes to draw on; new ones unless given.

    Raises:
        CogmapError: no rooms, or a path that leaves them.
    """
    if not sights:
        raise CogmapError("plot_maze: there are no rooms; give at least one")
    if path is not None and (strange := [tuple(room) for room in path if tuple(room) not in sights]):
        raise CogmapError(f"plot_maze: the path goes through {strange[0]}, which is no room; give rooms only")
    ax = axes_or_new(ax)
    as_grid(ax, sights)
    draw_rooms(ax, sights)
    if path is not None and len(path):
        _draw_path(ax, np.array([flat(room) for room in path]))
    if title is not None:
        ax.set_title(title)
    return ax


def draw_rooms(ax: Axes, sights: Sights, *, faint: bool = False) -> None:
    """The floors with their labels; `faint` ones are pale and have none, to be drawn over."""
    from matplotlib.patches import Rectangle
    from matplotlib.patheffects import withStroke

    edge, paper = min(1.5, cell_points(ax) / 20), theme_of(ax).paper
    for (row, column), label in sights.items():
        colour = sight_colour(label)
        floor = mixed(colour, paper, FAINT) if faint else colour
        ax.add_artist(Rectangle((column - 0.5, row - 0.5), 1, 1, facecolor=floor, edgecolor=paper, linewidth=edge))
        if not faint:
            at = (column - 0.44, row - 0.44)
            style: dict[str, Any] = {"color": ink_on(colour), "ha": "left", "va": "top", "zorder": 5}
            text = write_in(ax, *at, str(label), box=(0.8, 0.27), **style)
            text.set_path_effects([withStroke(linewidth=2, foreground=colour)])


def _draw_path(ax: Axes, rooms: NDArray[np.float64]) -> None:
    """`rooms [T, 2]`, rows and columns."""
    from matplotlib.collections import LineCollection

    width = min(max(cell_points(ax) / 14, 1.0), 5.0)
    pieces = [lanes(piece)[:, ::-1] for piece in np.split(rooms, _jumps(rooms))]
    segments = [segment for piece in pieces for segment in np.stack([piece[:-1], piece[1:]], axis=1)]
    shades = np.linspace(0.0, 1.0, max(len(segments), 1))
    for left, entered in pairwise(pieces):
        jump: dict[str, Any] = {"color": "black", "gapcolor": "white", "linewidth": width / 2, "zorder": 2.9}
        ax.plot(*zip(left[-1], entered[0], strict=True), linestyle=(0, (3, 2)), **jump)
    # a white rim around a black one: whatever the floor and the shade, one of the two borders shows
    for colour, wide, above in (("white", 2.4, 3.0), ("black", 1.2, 3.1)):
        rim: dict[str, Any] = {"colors": colour, "linewidths": width + wide, "capstyle": "round", "zorder": above}
        ax.add_collection(LineCollection(segments, **rim))
    ax.add_collection(
        LineCollection(segments, colors=[str(s) for s in shades], linewidths=width, capstyle="round", zorder=3.2)
    )
    ends: dict[str, Any] = {"marker": "o", "s": (2.2 * width) ** 2, "linewidths": 1.2, "zorder": 4}
    ax.scatter(*pieces[-1][-1], color="white", edgecolors="black", label="end", **ends)
    ax.scatter(*pieces[0][0], color="black", edgecolors="white", label="start", **{**ends, "s": (1.6 * width) ** 2})


def _jumps(rooms: NDArray[np.float64]) -> NDArray[np.int64]:
    """Indices of the rooms that are not next to the one before: whoever walked was put there."""
    return np.flatnonzero(np.abs(np.diff(rooms, axis=0)).sum(axis=1) > 1) + 1


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
