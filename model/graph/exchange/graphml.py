"""Networks as GraphML, which knows numbers and text only."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import CogmapError
from ...labels import plain
from ...written import jsonable
from ..export import to_networkx
from ..structure import GraphStructure

if TYPE_CHECKING:
    import networkx as nx


def write_graphml(graph: GraphStructure | nx.Graph[Any]) -> str:
    """A factor graph, or a network such as `CognitiveMap.to_networkx` gives, as GraphML text.

    Numbers, truth values and text stay what they are; other values, such as domains and positions, are written as
    JSON; what is None is left out. Nodes are named by their text.

    Raises:
        CogmapError: two nodes have the same name as text.
    """
    import networkx as nx

    source = to_networkx(graph) if isinstance(graph, GraphStructure) else graph
    names = {node: str(plain(node)) for node in source}
    if len(set(names.values())) < len(names):
        raise CogmapError("GraphML: two nodes have the same name as text; rename one")
    result: Any = source.__class__()
    result.graph.update(_plain(source.graph))
    result.add_nodes_from((names[node], _plain(values)) for node, values in source.nodes(data=True))
    edges: Any = source.edges
    for a, b, *key, values in edges(keys=True, data=True) if source.is_multigraph() else edges(data=True):
        result.add_edge(names[a], names[b], *map(str, key), **_plain(values))
    return "\n".join(nx.generate_graphml(result)) + "\n"


def _plain(values: dict[str, Any]) -> dict[str, str | int | float | bool]:
    return {str(name): _value(value) for name, value in values.items() if value is not None}


def _value(value: Any) -> str | int | float | bool:
    value = value.item() if isinstance(value, np.generic) else value
    if isinstance(value, str | int | float | bool):
        return value
    return json.dumps(jsonable(value))
