"""A graph as it was written: nodes and edges with whatever attributes they have."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from reprlib import repr as shown
from typing import TYPE_CHECKING, Any

from ..errors import WorldError

if TYPE_CHECKING:
    import networkx as nx

_LONGEST = 32  # parts of a list that is a label
_SURROGATE = re.compile(r"[\ud800-\udfff]")

Attributes = Mapping[str, Any]
Edges = Sequence[tuple[Attributes, bool]]
"""The attributes of each way, and whether it is an undirected edge walked against how it was written."""


@dataclass(frozen=True, slots=True)
class RawGraph:
    """Nodes and edges before anybody has looked at them."""

    name: str  # what the graph is called
    source: str  # what errors call it, such as the path of its file
    directed: bool  # whether an edge leads one way only
    attributes: Attributes  # of the graph
    nodes: Sequence[tuple[Any, Attributes]]  # the id and the attributes of each
    edges: Sequence[tuple[Any, Any, Attributes]]  # source, target and attributes of each

    @classmethod
    def of(cls, graph: nx.Graph[Any], *, name: str, source: str) -> RawGraph:
        """The same of a networkx graph, directed or not, multigraph or not."""
        return cls(
            name, source, graph.is_directed(), graph.graph, list(graph.nodes(data=True)), list(graph.edges(data=True))
        )

    def ways(self) -> Iterator[tuple[Any, Any, Attributes, bool]]:
        """Each way: from, to, attributes, and whether it is an undirected edge walked against how it was written."""
        for source, target, attributes in self.edges:
            yield source, target, attributes, False
            if not self.directed and source != target:
                yield target, source, attributes, True


def label(value: Any, where: str, *, depth: int = 3) -> Any:
    """A value as a label: lists become tuples.

    Raises:
        WorldError: it is missing, not finite, half of a character, none of a word, a number or a short list of them.
    """
    if isinstance(value, list | tuple) and depth and _parts(value, depth) <= _LONGEST:  # pyright: ignore[reportUnknownArgumentType]
        return tuple(label(part, where, depth=depth - 1) for part in value)  # pyright: ignore[reportUnknownVariableType]
    if not isinstance(value, str | int | float) or (isinstance(value, float) and not math.isfinite(value)):
        raise WorldError(f"{where} is {shown(value)}; use a word, a finite number, or a short list of them")
    if isinstance(value, str) and _SURROGATE.search(value):
        raise WorldError(f"{where} is {shown(value)}, which has half of a character; write it anew")
    return value


def _parts(value: Any, depth: int) -> int:
    """How many parts a list has, those of lists in it too; more than `_LONGEST` are not counted."""
    if not isinstance(value, list | tuple) or not depth:
        return 1
    if len(value) > _LONGEST:  # pyright: ignore[reportUnknownArgumentType]
        return _LONGEST + 1
    return sum(_parts(part, depth - 1) for part in value)  # pyright: ignore[reportUnknownVariableType]


def number(value: Any, where: str) -> float:
    """A finite number, also where it is written as text. Raises WorldError: it is none."""
    try:
        found = math.nan if isinstance(value, bool) else float(value)
    except (TypeError, ValueError, OverflowError):
        found = math.nan
    if not math.isfinite(found):
        raise WorldError(f"{where} is {shown(value)}; use a finite number")
    return found


def some(names: Sequence[Any], *, most: int = 5) -> str:
    """The first few names, for messages."""
    return ", ".join(f"{shown(name)}" for name in names[:most]) + (", ..." if len(names) > most else "")
