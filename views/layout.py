"""A layout for graphs whose nodes lie nowhere: springs between neighbours, then everything pushed a unit apart."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..model import Floats

if TYPE_CHECKING:
    import networkx as nx

Point = tuple[float, float]

PUSHES = 300
MANY = 80  # nodes beyond which springs take too long to settle by distances


def spread(nodes: Iterable[Hashable], edges: Iterable[tuple[Hashable, Hashable]]) -> dict[Any, Point]:
    """A point for each node; the same whenever the graph is the same. Parts that no edge joins stand in a row.

    Neighbours are about a unit apart, and no two nodes are much nearer than that.
    """
    import networkx as nx

    graph: nx.Graph[Any] = nx.Graph()
    graph.add_nodes_from(nodes)
    graph.add_edges_from((a, b) for a, b in edges if a != b)
    order = {node: number for number, node in enumerate(graph)}
    left, found = 0.0, dict[Any, Point]()
    for part in nx.connected_components(graph):
        members = sorted(part, key=order.__getitem__)  # in the order given: sets have none
        points = _apart(_settled(nx.Graph(graph.subgraph(members)), members))
        points -= points.min(axis=0)
        found |= {node: (left + x, -y) for node, (x, y) in zip(members, points.tolist(), strict=True)}
        left += float(points[:, 0].max()) + 1.2
    return found


def _settled(graph: nx.Graph[Any], nodes: Sequence[Any]) -> Floats:
    import networkx as nx

    if len(nodes) == 1:
        return np.zeros((1, 2))
    start, few = nx.circular_layout(graph), len(nodes) <= MANY
    places = nx.kamada_kawai_layout(graph, pos=start) if few else nx.spring_layout(graph, pos=start, seed=0)
    lengths = [float(np.linalg.norm(places[a] - places[b])) for a, b in graph.edges]
    return np.array([places[node] for node in nodes]) * 1.1 / max(float(np.median(lengths)), 1e-9)


def _apart(points: Floats) -> Floats:
    """Points pushed away from one another until no two are nearer than a unit."""
    from scipy.spatial import KDTree

    rng = np.random.default_rng(0)
    points = points + rng.normal(scale=1e-3, size=points.shape)  # points on top of one another have no direction
    for _ in range(PUSHES):
        a, b = KDTree(points).query_pairs(1.0, output_type="ndarray").T
        if not len(a):
            break
        away = points[a] - points[b]
        distance = np.linalg.norm(away, axis=1, keepdims=True)
        push = 0.5 * (1.02 - distance) * away / distance
        np.add.at(points, a, push)
        np.add.at(points, b, -push)
    return points
