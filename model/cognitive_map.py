"""The cognitive map: what the agent believes the world to be, to be read, drawn and exported."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from .graph import LabelledTable, table
from .map_graph import map_dot, map_graph, map_json
from .map_html import map_html, map_svg
from .map_tables import map_table
from .readable_map import ReadableMap

if TYPE_CHECKING:
    from networkx import MultiDiGraph


class CognitiveMap(ReadableMap):
    """The agent's model of the world. It grows, and removes only what it added by mistake."""

    def to_networkx(self) -> MultiDiGraph[Any]:
        """The map as a graph: places with what is known of them, transitions with action and probability."""
        return map_graph(self)

    def to_dot(self) -> str:
        """The map as Graphviz source; see `map_graph.map_dot`."""
        return map_dot(self)

    def to_json(self, *, indent: int | None = None) -> str:
        """The map as JSON, in networkx' node-link layout; see `map_graph.map_node_link`."""
        return map_json(self, indent=indent)

    def table(
        self, name: str, *, action: str | int | None = None, places: Sequence[int] | None = None
    ) -> LabelledTable:
        """`A_o`, `A_p`, or `B_s` of one action, with labels on both axes; see `map_tables.map_table`."""
        return table(map_table(self, name, action=action, places=places))

    def __repr__(self) -> str:
        seen = int(self.visited.sum())
        return (
            f"CognitiveMap({len(self.places)} places, {seen} visited, "
            f"{len(self.positions)} positions, {len(self.sights)} sights)"
        )

    def _repr_svg_(self) -> str | None:
        return map_svg(self)

    def _repr_html_(self) -> str:
        return map_html(self)
