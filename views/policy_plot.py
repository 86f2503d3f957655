"""Where the agent imagines to go."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from ..model import CogmapError, CognitiveMap
from ..planning import Plan
from .axes import Cell, as_grid, axes_or_new, cell_points, flat
from .colours import BLUE, RGB, SKY, contrast, mixed
from .map_picture import MapPicture
from .theme import Theme, theme_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LEAST = 0.01  # ways that are less probable are not drawn
PALEST = 0.85  # how much of the ground is in the least probable way; none is in the most probable one
RING = 0.34  # radius behind a place where paths end, cells

Paths = Mapping[tuple[tuple[float, ...], ...], float]


def policy_paths(
    plan: Plan, map_: CognitiveMap, *, start: Sequence[float] = (0, 0), least: float = 1e-3
) -> dict[tuple[Cell, ...], float]:
    """The cells that the policies lead along if every way is as the map has it, the most probable path first.

    Args:
        plan: of the agent.
        map_: of the agent, in one or two dimensions.
        start: row and column of the place that the agent takes as its origin.
        least: paths that are less probable are left out; those that are impossible always are.

    Returns:
        For each path Q(s) of its first place times P(policy), summed over the policies that lead along it. Where a
        policy stays or bumps, the cell is not repeated; places without a position are passed over.

    Raises:
        CogmapError: positions of more than two dimensions.
    """
    drawn = MapPicture.of(map_).drawn(flat(start)).cells
    cells = [drawn.get(place) for place in plan.places.tolist()]
    shares: defaultdict[tuple[Cell, ...], float] = defaultdict(float)
    for first in np.flatnonzero(plan.model.belief >= least).tolist():
        for policy in np.flatnonzero(plan.probability >= least / 10).tolist():
            if path := _path(plan, cells, first, policy):
                shares[path] += float(plan.model.belief[first] * plan.probability[policy])
    return dict(
        sorted(
            (item for item in shares.items() if item[1] >= least and item[1] > 0.0),
            key=lambda item: (-item[1], item[0]),
        )
    )


def plot_policies(paths: Paths, *, title: str | None = None, ax: Axes | None = None) -> Axes:
    """Imagined paths, each way as strong as it is probable that it will be walked, with a dot where paths end.

    They are grey over a maze, and blue, beneath the places, over a map.

    Args:
        paths: the cells (row, column) of each path, and P(policy), as `policy_paths` has them; those of several
            policies may be added up.
        title: above the plot.
        ax: axes with a grid of cells to draw on, as `plot_world` and `plot_map` leave them; new ones unless given.

    Raises:
        CogmapError: a path without cells, or cells of more than two dimensions.
    """
    if not all(paths):
        raise CogmapError("plot_policies: a path has no cells; give at least the one where the agent is")
    ways, ends = _shares([([flat(cell) for cell in path], p) for path, p in paths.items()])
    new, ax = ax is None, axes_or_new(ax, title)
    if new:
        as_grid(ax, [flat(cell) for path in paths for cell in path] or [(0.0, 0.0)])
    _draw(ax, ways, ends, theme_of(ax))
    return ax


def _path(plan: Plan, cells: Sequence[Cell | None], first: int, policy: int) -> tuple[Cell, ...]:
    at, path = first, [cells[first]]
    for action in plan.policies[policy].tolist():
        ahead = int(plan.model.successor[at, action])
        at = at if ahead < 0 else ahead
        if cells[at] != path[-1]:
            path.append(cells[at])
    return tuple(cell for cell in path if cell is not None)


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


def _draw(ax: Axes, ways: Mapping[tuple[Cell, Cell], float], ends: Mapping[Cell, float], theme: Theme) -> None:
    from matplotlib.collections import LineCollection

    width, on_map = min(max(cell_points(ax) / 8, 2.0), 7.0), _on_map(ax)
    strongest = _strongest(theme) if on_map else theme.ink
    drawn = sorted((item for item in ways.items() if item[1] >= LEAST), key=lambda item: item[1])
    lines = [[(a[1], a[0]), (b[1], b[0])] for (a, b), _ in drawn]
    shades = [_shade(p, strongest, theme) for _, p in drawn]
    # rims keep the palest and the darkest shade apart from any floor
    outer = theme.shade(0.45) if on_map else theme.ink
    for colour, wide, above in ((outer, 2.1, 1.5), (theme.paper, 1.8, 1.6)):
        rim: dict[str, Any] = {"colors": [colour], "linewidths": width * wide, "capstyle": "round", "zorder": above}
        ax.add_collection(LineCollection(lines, **rim))
    ax.add_collection(LineCollection(lines, colors=shades, linewidths=width, capstyle="round", zorder=1.7))
    dots = {cell: _shade(p, strongest, theme) for cell, p in sorted(ends.items(), key=lambda e: e[1]) if p >= LEAST}
    if on_map:
        _draw_rings(ax, dots, theme)
        return
    x, y = [column for _, column in dots], [row for row, _ in dots]
    look: dict[str, Any] = {"c": list(dots.values()), "edgecolors": [theme.paper], "linewidths": 0.3 * width}
    ax.scatter(x, y, s=(2.2 * width) ** 2, zorder=1.8, **look)


def _draw_rings(ax: Axes, dots: Mapping[Cell, RGB], theme: Theme) -> None:
    """Discs behind the places of a map, which would hide a dot."""
    from matplotlib.patches import Circle

    for (row, column), shade in dots.items():
        look: dict[str, Any] = {"facecolor": shade, "edgecolor": theme.ink, "linewidth": 0.7, "zorder": 1.8}
        ax.add_artist(Circle((column, row), RING, **look))


def _on_map(ax: Axes) -> bool:
    """Whether there are places, and links as dark as paths would be."""
    from matplotlib.patches import Circle

    return any(isinstance(patch, Circle) for patch in ax.patches)


def _strongest(theme: Theme) -> RGB:
    return max((BLUE, SKY), key=lambda colour: contrast(colour, theme.paper))


def _shade(p: float, strongest: RGB, theme: Theme) -> RGB:
    return mixed(strongest, theme.paper, 1.0 - PALEST * (1.0 - min(p, 1.0)))
