"""Families of graph worlds of any size: toruses, halls with portals, rings, random geometric graphs.

In all of them `sights` is `"distinct"`, `"ways"`, or how many at random, and `seed` settles what is drawn.
"""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ..errors import WorldError
from ..generate import at_least
from ..motions import GRID
from ..sights import Sights
from .build import build
from .raw import RawGraph
from .world import GraphWorld

Room = tuple[int, int]
Link = tuple[Room, str, Room]

_MOTIONS = {name: vector for name, vector in zip(GRID.names, GRID.displacements, strict=True) if any(vector)}
_OPPOSITE = {"up": "down", "down": "up", "left": "right", "right": "left"}


def torus(
    rows: int, columns: int, *, sights: Sights = "distinct", diagonal: int | None = None, seed: int = 0
) -> GraphWorld:
    """A hall of `rows` by `columns` rooms whose right side joins its left and whose lower side joins its upper.

    With `diagonal` the label of room (r, c) is (r + c) mod `diagonal`.

    Raises:
        WorldError: a size or `diagonal` is below 1, or no such sights.
    """
    at_least("torus", rows=(rows, 1), columns=(columns, 1), diagonal=(1 if diagonal is None else diagonal, 1))
    links = [(room, way, (row % rows, column % columns)) for room, way, (row, column) in _sides(rows, columns)]
    labels = {(r, c): (r + c) % diagonal for r, c in np.ndindex(rows, columns)} if diagonal else {}
    return _world(f"torus_{rows}x{columns}", rows, columns, links, labels, sights, seed)


def portal_hall(rows: int, columns: int, *, portals: int = 1, sights: Sights = "distinct", seed: int = 0) -> GraphWorld:
    """An open hall with two-way portals, drawn at random, between sides of its outer wall that face opposite ways.

    Raises:
        WorldError: a size is below 1, there is no room for so many portals, or no such sights.
    """
    at_least("portal_hall", rows=(rows, 1), columns=(columns, 1), portals=(portals, 0))
    inside, free = list[Link](), list[tuple[Room, str]]()
    for room, way, ahead in _sides(rows, columns):
        if 0 <= ahead[0] < rows and 0 <= ahead[1] < columns:
            inside.append((room, way, ahead))
        else:
            free.append((room, way))
    rng = np.random.default_rng(seed)
    for _ in range(portals):
        pairs = [(a, b) for a in free for b in free if a[1] in ("up", "left") and b[1] == _OPPOSITE[a[1]]]
        if not pairs:
            raise WorldError(f"portal_hall: {portals} portals do not fit {rows} by {columns} rooms; use fewer")
        (room, way), (other, back) = pairs[int(rng.integers(len(pairs)))]
        inside += [(room, way, other), (other, back, room)]
        free = [side for side in free if side not in ((room, way), (other, back))]
    return _world(f"portals_{rows}x{columns}", rows, columns, inside, {}, sights, seed)


def ring(places: int, *, one_way: bool = True, sights: Sights = "distinct", seed: int = 0) -> GraphWorld:
    """A ring of places; `right` leads on, and unless it is one-way `left` leads back.

    Raises:
        WorldError: fewer than two places, or no such sights.
    """
    at_least("ring", places=(places, 2))
    ways = ("right",) if one_way else ("left", "right")
    links = [(room, way, (0, column % places)) for room, way, (_, column) in _sides(1, places) if way in ways]
    return _world(f"ring_{places}", 1, places, links, {}, sights, seed)


def geometric(
    places: int, *, degree: float = 8.0, sights: Sights = "distinct", seed: int = 0, pose: str | None = None
) -> GraphWorld:
    """Places at random in a square, joined where they are near, and by a shortest tree that makes them one piece.

    Args:
        places: how many; there is one on each unit of area.
        degree: how many ways a place has in the mean, far from the border and the tree left out.
        sights: as in the other families, and so is `seed`.
        seed: of positions, and of sights at random.
        pose: what is told of a pose; see `POSES`.

    Raises:
        WorldError: fewer than three places, a degree that is not above 0, no such sights, or no such pose.
    """
    from scipy.sparse import coo_array  # slow to import
    from scipy.sparse.csgraph import minimum_spanning_tree
    from scipy.spatial import Delaunay, KDTree

    at_least("geometric", places=(places, 3))
    if not 0.0 < degree < np.inf:
        raise WorldError(f"geometric: degree is {degree}; use a number above 0")
    points = np.random.default_rng(seed).uniform(0.0, np.sqrt(places), size=(places, 2)).round(3)
    corners = Delaunay(points).simplices
    ends = np.unique(np.sort(np.vstack([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [0, 2]]])), axis=0)
    far = np.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]], axis=1)
    tree = minimum_spanning_tree(coo_array((far, ends.T.astype(np.int32)), shape=(places, places)).tocsr()).tocoo()
    joined = KDTree(points).query_pairs(np.sqrt(degree / np.pi))
    joined.update((min(edge), max(edge)) for edge in zip(tree.row.tolist(), tree.col.tolist(), strict=True))
    name = f"geometric_{places}"
    nodes = [(i, {"position": point}) for i, point in enumerate(points.tolist())]
    raw = RawGraph(name, name, False, {}, nodes, [(a, b, {}) for a, b in sorted(joined)])
    return GraphWorld(build(raw, sights=sights, seed=seed, pose=pose))


def _sides(rows: int, columns: int) -> Iterator[Link]:
    """Each room of a hall, each motion, and the cell where it would lead."""
    for row, column in np.ndindex(rows, columns):
        for way, (down, right) in _MOTIONS.items():
            yield (row, column), way, (row + down, column + right)


def _world(
    name: str, rows: int, columns: int, links: list[Link], labels: Mapping[Room, int], sights: Sights, seed: int
) -> GraphWorld:
    nodes: list[tuple[Any, dict[str, Any]]] = [
        (room, {"sight": labels[room]} if labels else {}) for room in np.ndindex(rows, columns)
    ]
    edges = [(room, ahead, {"way": way}) for room, way, ahead in links]
    return GraphWorld(build(RawGraph(name, name, True, {"motions": _MOTIONS}, nodes, edges), sights=sights, seed=seed))
