"""Where the agent imagines to go."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any, Unpack

import numpy as np

from ..model import CogmapError, CognitiveMap
from ..planning import Plan
from .axes import Axes, Cell, Where, as_grid, axes_or_new, cell_points, flat
from .map_picture import MapPicture
from .theme import BLUE, RGB, SKY, Theme, contrast, mixed, theme_of

LEAST = 0.01  # ways that are less probable are not drawn
PALEST = 0.85  # how much of the ground is in the least probable way; none is in the most probable one
RING = 0.34  # radius behind a place where paths end, cells

Paths = Mapping[tuple[tuple[float, ...], ...], float]


def policy_paths(
    plan: Plan, map_: CognitiveMap, *, start: Sequence[float] = (0, 0), least: float = 1e-3
) -> dict[tuple[Cell, ...], float]:
    """The cells that each policy leads through on the map, with the most probable path first.

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
    drawn, model = MapPicture.of(map_).drawn(flat(start)).cells, plan.model
    cells = [drawn.get(place) for place in plan.places.tolist()]
    shares: defaultdict[tuple[Cell, ...], float] = defaultdict(float)
    for first in np.flatnonzero(model.belief >= least).tolist():
        for policy in np.flatnonzero(plan.probability >= least / 10).tolist():
            if path := _path(plan, cells, first, policy):
                shares[path] += float(model.belief[first] * plan.probability[policy])
    likely = [(path, p) for path, p in shares.items() if p >= least and p > 0.0]
    return dict(sorted(likely, key=lambda item: (-item[1], item[0])))


def plot_policies(paths: Paths, **where: Unpack[Where]) -> Axes:
    """Imagined paths. Each link is as strong as the agent will probably walk it, and a dot marks where paths end.

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
    ways: defaultdict[tuple[Cell, Cell], float] = defaultdict(float)  # in either direction
    ends: defaultdict[Cell, float] = defaultdict(float)
    for path, p in (([flat(cell) for cell in path], p) for path, p in paths.items()):
        for way in {(min(pair), max(pair)) for pair in pairwise(path) if pair[0] != pair[1]}:
            ways[way] += p
        ends[path[-1]] += p
    ax = axes_or_new(**where)
    if ax.axison:
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


def _draw(ax: Axes, ways: Mapping[tuple[Cell, Cell], float], ends: Mapping[Cell, float], theme: Theme) -> None:
    from matplotlib.collections import LineCollection
    from matplotlib.patches import Circle

    on_map = any(isinstance(patch, Circle) for patch in ax.patches)  # places, and links as dark as paths would be
    width = min(max(cell_points(ax) / 8, 2.0), 7.0)
    strongest = max((BLUE, SKY), key=lambda colour: contrast(colour, theme.paper)) if on_map else theme.ink

    def shade(p: float) -> RGB:
        return mixed(strongest, theme.paper, 1.0 - PALEST * (1.0 - min(p, 1.0)))

    drawn = sorted((item for item in ways.items() if item[1] >= LEAST), key=lambda item: item[1])
    lines = [[(a[1], a[0]), (b[1], b[0])] for (a, b), _ in drawn]
    # rims keep the palest and the darkest shade apart from any floor
    outer = theme.shade(0.45) if on_map else theme.ink
    shades = [shade(p) for _, p in drawn]
    for colours, wide, above in (([outer], 2.1, 1.5), ([theme.paper], 1.8, 1.6), (shades, 1.0, 1.7)):
        style: dict[str, Any] = {"colors": colours, "linewidths": width * wide, "capstyle": "round", "zorder": above}
        ax.add_collection(LineCollection(lines, **style))
    dots = {cell: shade(p) for cell, p in sorted(ends.items(), key=lambda e: e[1]) if p >= LEAST}
    look: dict[str, Any] = {"edgecolors": [theme.paper], "linewidths": 0.3 * width, "zorder": 1.8}
    if not on_map:
        x, y = [column for _, column in dots], [row for row, _ in dots]
        ax.scatter(x, y, s=(2.2 * width) ** 2, c=list(dots.values()), **look)
    for (row, column), colour in dots.items() if on_map else ():  # discs behind the places, which would hide a dot
        look = {"facecolor": colour, "edgecolor": theme.ink, "linewidth": 0.7, "zorder": 1.8}
        ax.add_artist(Circle((column, row), RING, **look))
