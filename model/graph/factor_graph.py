"""A small language for discrete factor graphs: declare variables, then factors over them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Self

from . import export, plain_json
from .html import graph_html
from .structure import GraphStructure
from .tables import LabelledTable, table

if TYPE_CHECKING:
    import networkx as nx


class FactorGraph(GraphStructure):
    """P(x) ∝ Π_f f(x_f): variables with labelled domains and factors over them. Append-only.

    Example: `g = FactorGraph(); g.variable("rain", (False, True)); g.factor("P", ["rain"], [0.8, 0.2])`.
    Everything raises `CogmapError` on names unknown or taken, and on values that do not fit their scope.
    """

    def to_networkx(self) -> nx.Graph[Any]:
        """A bipartite networkx graph; see `export.to_networkx`."""
        return export.to_networkx(self)

    def to_dot(self) -> str:
        """Graphviz source; see `export.to_dot`."""
        return export.to_dot(self)

    def to_dict(self) -> dict[str, Any]:
        """The graph as plain JSON values; see `plain_json.graph_to_dict`."""
        return plain_json.graph_to_dict(self)

    def to_json(self, *, indent: int | None = None) -> str:
        """The graph as JSON text, with every digit; see `plain_json.graph_to_dict`."""
        return plain_json.graph_to_json(self, indent=indent)

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Self:
        """The graph that `to_dict` took apart: `same_as` the first."""
        return plain_json.graph_from_dict(values, cls())

    @classmethod
    def from_json(cls, text: str) -> Self:
        """The graph that `to_json` wrote: `same_as` the first."""
        return plain_json.graph_from_json(text, cls())

    def same_as(self, other: GraphStructure) -> bool:
        """Whether variables, factors and evidence are the same to the last digit; see `plain_json.same_graph`."""
        return plain_json.same_graph(self, other)

    def __eq__(self, other: object) -> bool:
        return self.same_as(other) if isinstance(other, FactorGraph) else NotImplemented

    def table(self, name: str) -> LabelledTable:
        """The values of the factor with that label or name, with labels on both axes; see `tables.table`."""
        return table(self.factor_named(name))

    def __repr__(self) -> str:
        return export.equation(self, most_terms=12)

    def _repr_html_(self) -> str:
        return graph_html(self)
