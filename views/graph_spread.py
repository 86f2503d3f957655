"""A layout for graphs without time: springs between neighbours, then everything pushed a unit apart."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..model import Factor, Variable
from .graph_layout import GraphLayout

if TYPE_CHECKING:
    import networkx as nx

Floats = NDArray[np.float64]

PUSHES = 300
MANY = 80  # nodes beyond which springs take too long to settle by distances


def spread(variables: Sequence[Variable], factors: Sequence[Factor]) -> GraphLayout:
    """Always the same for the same graph; no two nodes are nearer than a unit."""
    import networkx as nx

    graph: nx.Graph[str] = nx.Graph()
    graph.add_nodes_from(variable.name for variable in variables)
    for factor in factors:
        graph.add_edges_from((factor.label, variable.name) for variable in factor.scope)
    if not len(graph):
        return GraphLayout({}, {}, {})
    left, places = 0.0, {}
    for part in nx.connected_components(graph):
        nodes = [node for node in graph if node in part]  # in the order declared: sets have none
        points = _apart(_settled(nx.Graph(graph.subgraph(nodes)), nodes))
        points -= points.min(axis=0)
        places |= {node: (left + x, -y) for node, (x, y) in zip(nodes, points.tolist(), strict=True)}
        left += float(points[:, 0].max()) + 1.2
    names = {variable.name for variable in variables}
    return GraphLayout(
        {name: point for name, point in places.items() if name in names},
        {name: point for name, point in places.items() if name not in names},
        {},
    )


def _settled(graph: nx.Graph[str], nodes: Sequence[str]) -> Floats:
    import networkx as nx

    if len(nodes) == 1:
        return np.zeros((1, 2))
    start = nx.circular_layout(graph)
    if len(nodes) <= MANY:
        places = nx.kamada_kawai_layout(graph, pos=start)
    else:
        places = nx.spring_layout(graph, pos=start, seed=0)
    points = np.array([places[node] for node in nodes])
    lengths = [float(np.hypot(*(points[nodes.index(a)] - points[nodes.index(b)]))) for a, b in graph.edges]
    return points * 1.1 / max(float(np.median(lengths)), 1e-9)


def _apart(points: Floats) -> Floats:
    """Points pushed away from one another until no two are nearer than a unit."""
    rng = np.random.default_rng(0)
    points = points + rng.normal(scale=1e-3, size=points.shape)  # points on top of one another have no direction
    for _ in range(PUSHES):
        away = points[:, None] - points[None]
        distance = np.hypot(away[..., 0], away[..., 1]) + np.eye(len(points)) * 9.0
        short = np.maximum(1.02 - distance, 0.0)
        if short.max() <= 0.02:
            break
        points = points + 0.5 * (away / distance[..., None] * short[..., None]).sum(axis=1)
    return points
