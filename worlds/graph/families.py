"""Families of graph worlds of any size: toruses, halls with portals, rings, random geometric graphs."""

from __future__ import annotations

from typing import Any

import networkx as nx
import numpy as np

from ..errors import WorldError
from ..generate import at_least
from ..motions import GRID
from ..sights import Sights
from .world import GraphWorld

_MOTIONS = {name: vector for name, vector in zip(GRID.names, GRID.displacements, strict=True) if any(vector)}
_OPPOSITE = {"up": "down", "down": "up", "left": "right", "right": "left"}


def torus(
    rows: int, columns: int, *, sights: Sights = "distinct", diagonal: int | None = None, seed: int = 0
) -> GraphWorld:
    """A hall of `rows` by `columns` rooms whose right side joins its left and whose lower side joins its upper.

    Args:
        rows: how many.
        columns: how many.
        sights: `"distinct"`, or how many at random.
        diagonal: instead, the label of room (r, c) is (r + c) mod `diagonal`.
        seed: of sights at random.

    Raises:
        WorldError: a size or `diagonal` is below 1.
    """
    at_least("torus", rows=(rows, 1), columns=(columns, 1), diagonal=(1 if diagonal is None else diagonal, 1))
    graph = _hall(f"torus_{rows}x{columns}", rows, columns)
    for (row, column), way, (down, right) in ((room, *motion) for room in list(graph) for motion in _MOTIONS.items()):
        graph.add_edge((row, column), ((row + down) % rows, (column + right) % columns), key=way, way=way)
    for row, column in graph if diagonal else ():
        graph.nodes[row, column]["sight"] = (row + column) % (diagonal or 1)
    return GraphWorld.from_networkx(graph, sights=sights, seed=seed)


def portal_hall(rows: int, columns: int, *, portals: int = 1, sights: Sights = "distinct", seed: int = 0) -> GraphWorld:
    """An open hall in which some sides lead to sides opposite elsewhere: two-way portals, drawn at random.

    Args:
        rows: how many.
        columns: how many.
        portals: how many, at most one a side of the outer wall.
        sights: `"distinct"`, or how many at random.
        seed: of portals, and of sights at random.

    Raises:
        WorldError: a size is below 1, or there is no room for so many portals.
    """
    at_least("portal_hall", rows=(rows, 1), columns=(columns, 1), portals=(portals, 0))
    graph = _hall(f"portals_{rows}x{columns}", rows, columns)
    free: list[tuple[Any, str]] = []
    for (row, column), way, (down, right) in ((room, *motion) for room in list(graph) for motion in _MOTIONS.items()):
        if (row + down, column + right) in graph:
            graph.add_edge((row, column), (row + down, column + right), key=way, way=way)
        else:
            free.append(((row, column), way))
    rng = np.random.default_rng(seed)
    for _ in range(portals):
        pairs = [(a, b) for a in free for b in free if a[1] in ("up", "left") and b[1] == _OPPOSITE[a[1]]]
        if not pairs:
            raise WorldError(f"portal_hall: {portals} portals do not fit {rows} by {columns} rooms; use fewer")
        (room, way), (other, back) = pairs[int(rng.integers(len(pairs)))]
        graph.add_edge(room, other, key=way, way=way)
        graph.add_edge(other, room, key=back, way=back)
        free = [side for side in free if side not in ((room, way), (other, back))]
    return GraphWorld.from_networkx(graph, sights=sights, seed=seed)


def ring(places: int, *, one_way: bool = True, sights: Sights = "distinct", seed: int = 0) -> GraphWorld:
    """A ring of places; `right` leads on, and unless it is one-way `left` leads back.

    Raises:
        WorldError: fewer than two places.
    """
    at_least("ring", places=(places, 2))
    graph = _hall(f"ring_{places}", 1, places)
    for _, column in list(graph):
        graph.add_edge((0, column), (0, (column + 1) % places), key="right", way="right")
        if not one_way:
            graph.add_edge((0, (column + 1) % places), (0, column), key="left", way="left")
    return GraphWorld.from_networkx(graph, sights=sights, seed=seed)


def geometric(
    places: int, *, degree: float = 8.0, sights: Sights = "distinct", seed: int = 0, pose: str | None = None
) -> GraphWorld:
    """Places at random in a square, joined where they are near, and by a shortest tree that makes them one piece.

    Args:
        places: how many; there is one on each unit of area.
        degree: how many ways a place has in the mean, far from the border and the tree left out.
        sights: `"distinct"`, `"ways"`, or how many at random.
        seed: of all of it.
        pose: what is told of a pose; see `POSES`.

    Raises:
        WorldError: fewer than three places, or a degree that is not above 0.
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
    graph: nx.Graph[int] = nx.Graph(name=f"geometric_{places}")
    graph.add_nodes_from((i, {"position": point}) for i, point in enumerate(points.tolist()))
    graph.add_edges_from(KDTree(points).query_pairs(np.sqrt(degree / np.pi)))
    graph.add_edges_from(zip(tree.row.tolist(), tree.col.tolist(), strict=True))
    return GraphWorld.from_networkx(graph, sights=sights, seed=seed, pose=pose)


def _hall(name: str, rows: int, columns: int) -> nx.MultiDiGraph[Any]:
    """Rooms without ways."""
    graph: nx.MultiDiGraph[Any] = nx.MultiDiGraph(name=name, motions=_MOTIONS)
    graph.add_nodes_from((row, column) for row in range(rows) for column in range(columns))
    return graph
