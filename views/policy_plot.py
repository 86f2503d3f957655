"""Where the agent imagines to go."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from ..model.errors import CogmapError
from .axes import Cell, as_grid, axes_or_new, cell_points, flat

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LEAST = 0.01  # ways that are less probable are not drawn
PALEST = 0.85  # grey of the least probable way; the most probable one is black

Paths = Mapping[tuple[tuple[float, ...], ...], float]


def plot_policies(paths: Paths, *, title: str | None = None, ax: Axes | None = None) -> Axes:
    """Imagined paths, each way as dark as it is probable that it will be walked, with a dot where paths end.

    Args:
        paths: the cells (row, column) of each path, and P(policy); those of several policies may be added up.
        title: above the plot.
        ax: axes with a grid of cells to draw on, as `plot_maze` and `plot_map` leave them; new ones unless given.

    Raises:
        CogmapError: a path without cells, or cells of more than two dimensions.
    """
    if not all(paths):
        raise CogmapError("plot_policies: a path has no cells; give at least the one where the agent is")
    ways, ends = _shares([([flat(cell) for cell in path], p) for path, p in paths.items()])
    if ax is None:
        ax = axes_or_new(None)
        as_grid(ax, [flat(cell) for path in paths for cell in path] or [(0.0, 0.0)])
    _draw(ax, ways, ends)
    if title is not None:
        ax.set_title(title)
    return ax


def _shares(
    paths: Sequence[tuple[list[Cell], float]],
) -> tuple[dict[tuple[Cell, Cell], float], dict[Cell, float]]:
    """P that each way is walked, in either direction, and that each cell is the last."""
    ways: defaultdict[tuple[Cell, Cell], float] = defaultdict(float)
    ends: defaultdict[Cell, float] = defaultdict(float)
    for path, probability in paths:
        for way in {(min(pair), max(pair)) for pair in pairwise(path) if pair[0] != pair[1]}:
            ways[way] += probability
        ends[path[-1]] += probability
    return dict(ways), dict(ends)


def _draw(ax: Axes, ways: Mapping[tuple[Cell, Cell], float], ends: Mapping[Cell, float]) -> None:
    from matplotlib.collections import LineCollection

    width = min(max(cell_points(ax) / 8, 2.0), 7.0)
    drawn = sorted((item for item in ways.items() if item[1] >= LEAST), key=lambda item: item[1])
    lines = [[(a[1], a[0]), (b[1], b[0])] for (a, b), _ in drawn]
    shades = [_shade(p) for _, p in drawn]
    # a rim keeps the palest grey apart from any floor
    ax.add_collection(LineCollection(lines, colors="white", linewidths=width * 1.8, capstyle="round", zorder=2.5))
    ax.add_collection(LineCollection(lines, colors=shades, linewidths=width, capstyle="round", zorder=2.6))
    dots = sorted((item for item in ends.items() if item[1] >= LEAST), key=lambda item: item[1])
    ax.scatter(
        [column for (_, column), _ in dots],
        [row for (row, _), _ in dots],
        s=(2.2 * width) ** 2,
        c=[_shade(p) for _, p in dots],
        edgecolors="white",
        linewidths=0.3 * width,
        zorder=2.7,
    )


def _shade(p: float) -> str:
    return str(PALEST * (1.0 - min(p, 1.0)))
