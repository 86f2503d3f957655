"""The cognitive map as a networkx graph, for people's own scripts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import networkx as nx
import numpy as np

if TYPE_CHECKING:
    from .cognitive_map import CognitiveMap


def map_graph(map_: CognitiveMap) -> nx.MultiDiGraph[Any]:
    """Places as nodes, transitions as edges keyed by action name.

    Nodes carry `position`, `visited`, and `sights` (label -> probability above a thousandth). Edges carry
    `action`, `probability` (of B_s), and `known`: `walked`, `imagined` (its door was sensed open), `refuted`
    (sensed blocked) or `unknown`.
    """
    graph: nx.MultiDiGraph[Any] = nx.MultiDiGraph()
    for place in map_.places:
        graph.add_node(
            place,
            position=map_.position(place),
            visited=bool(map_.visited[place]),
            sights=_sights(map_, place),
        )
    for place in map_.places:
        for action, name in enumerate(map_.motions.names):
            keys, p, _ = map_.B_s.mean(np.array([map_.row(place, action)]))
            for key, probability in zip(keys[0].tolist(), p[0].tolist(), strict=True):
                if key >= 0:
                    known = _how_known(map_, place, action)
                    graph.add_edge(place, key, key=name, action=name, probability=probability, known=known)
    return graph


def _sights(map_: CognitiveMap, place: int) -> dict[object, float]:
    keys, p, _ = map_.A_o.mean(np.array([place]))
    pairs = zip(keys[0].tolist(), p[0].tolist(), strict=True)
    return {map_.sights[key]: probability for key, probability in pairs if key >= 0 and probability > 1e-3}


def _how_known(map_: CognitiveMap, place: int, action: int) -> str:
    from .cognitive_map import BLOCKED, OPEN

    if action == map_.motions.stay:
        return "walked"
    sensed = int(map_.sensed[place, action])
    if sensed == BLOCKED:
        return "refuted"
    if map_.walked[place, action]:
        return "walked"
    return "imagined" if sensed == OPEN else "unknown"
