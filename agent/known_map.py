"""A graph of places that is given to an agent: from networkx, or a file."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from os import PathLike, fspath
from typing import Any, NamedTuple, cast

from ..model import CogmapError, parse_json, read_file, unpack_gzip

Facts = Mapping[str, Any]


class GivenWay(NamedTuple):
    """One way: from, to, its attributes, and whether it is an undirected edge walked against how it was written."""

    source: Hashable
    target: Hashable
    facts: Facts
    reverse: bool


@dataclass(frozen=True, slots=True)
class KnownMap:
    """A graph of places, before anybody has been there.

    A graph whose attribute `contexts` lists some is taken once for each: a node may say in `contexts` what differs,
    such as `{"left": {"sight": "reward"}}`; an edge may say `only`, the contexts in which it is open, and `then`, the
    context that it leads to (the way that takes a key).
    """

    where: str  # what errors call it
    attributes: Facts  # of the graph
    nodes: Mapping[Hashable, Facts]  # attributes by id, in order
    ways: tuple[GivenWay, ...]  # all that are open
    contexts: tuple[Hashable, ...] = ()  # those that the world may be in; none where there is but one

    @classmethod
    def of(cls, source: Any) -> KnownMap:
        """The same of a networkx graph, or of a file of one: node-link JSON (as networkx writes it) or GraphML.

        Of the map of an agent, what was only imagined is left out.

        Raises:
            CogmapError: it is none, or has no node.
        """
        import networkx as nx

        where = "map" if isinstance(source, nx.Graph) else f"map {source}"
        graph: Any = source if isinstance(source, nx.Graph) else _read(source)
        seen = {node: facts for node, facts in graph.nodes(data=True) if facts.get("visited", True) is not False}
        if not seen:
            raise CogmapError(f"{where}: it has no node; give a graph of places")
        ways = tuple(way for way in _ways(graph) if way.source in seen and way.target in seen)
        return cls(where, dict(graph.graph), seen, ways)._in_contexts()

    def _in_contexts(self) -> KnownMap:
        """Each place and each way once a context, if there are any."""
        given = self.attributes.get("contexts")
        if given is None:
            return self
        contexts = tuple(cast(Iterable[Any], given)) if isinstance(given, list | tuple) else ()
        if len(contexts) < 2:
            raise CogmapError(f"{self.where}: its contexts are {given!r}; give a list of two or more")
        nodes = {
            (k, node): {**facts, **self._differs(node, contexts).get(k, {}), "context": k}
            for k in contexts
            for node, facts in self.nodes.items()
        }
        ways = [
            GivenWay((k, way.source), (way.facts.get("then", k), way.target), way.facts, way.reverse)
            for k in contexts
            for way in self.ways
            if k in self._open_in(way, contexts)
        ]
        return replace(self, nodes=nodes, ways=tuple(ways), contexts=contexts)

    def _differs(self, node: Hashable, contexts: tuple[Any, ...]) -> Mapping[Any, Facts]:
        own = self.nodes[node].get("contexts", {})
        if not isinstance(own, Mapping) or not all(isinstance(facts, Mapping) for facts in cast(Facts, own).values()):
            raise CogmapError(f"{self.where}: node {node!r}: contexts are {own!r}; give {{context: {{sensor: value}}}}")
        self._check(f"node {node!r}", cast(Facts, own), contexts)
        return cast(Mapping[Any, Facts], own)

    def _open_in(self, way: GivenWay, contexts: tuple[Any, ...]) -> tuple[Any, ...]:
        only = way.facts.get("only", contexts)
        only = tuple(cast(Iterable[Any], only)) if isinstance(only, list | tuple) else (only,)
        self._check(f"the way from {way.source!r}", (*only, way.facts.get("then", contexts[0])), contexts)
        return only

    def _check(self, what: str, named: Iterable[Any], contexts: tuple[Any, ...]) -> None:
        for k in named:
            if k not in contexts:
                known = ", ".join(map(repr, contexts))
                raise CogmapError(f"{self.where}: {what} speaks of context {k!r}; the contexts are {known}")

    @property
    def motions(self) -> dict[str, tuple[int, ...]]:
        """Names and displacements of the actions, with one that stays. Raises CogmapError: the graph does not say."""
        given = self.attributes.get("motions")
        if not isinstance(given, Mapping) or not given:
            raise CogmapError(f"{self.where}: it does not say 'motions'; give the agent some: Agent(motions, map=...)")
        try:
            moves = {str(name): tuple(int(x) for x in vector) for name, vector in cast(Facts, given).items()}
        except (TypeError, ValueError) as error:
            raise CogmapError(f"{self.where}: its motions are no whole numbers; give name: displacement") from error
        if not any(any(vector) for vector in moves.values()) or all(any(vector) for vector in moves.values()):
            moves["stay"] = (0,) * len(next(iter(moves.values())))
        return moves


def _ways(graph: Any) -> Iterator[GivenWay]:
    keyed = graph.is_multigraph()
    for one, other, *key, facts in graph.edges(data=True, **({"keys": True} if keyed else {})):
        named = {"way": key[0]} if key and isinstance(key[0], str) else {}
        if facts.get("known") == "refuted":
            continue
        yield GivenWay(one, other, {**named, **facts}, False)
        if not graph.is_directed() and one != other:
            yield GivenWay(other, one, {**named, **facts}, True)


def _read(source: Any) -> Any:
    import networkx as nx

    if not isinstance(source, str | PathLike):
        raise CogmapError(f"map: it is a {type(source).__name__}; give a networkx graph, or a file of one")
    path = fspath(cast("str | PathLike[str]", source))
    try:
        content = read_file(path)
        content = unpack_gzip(path, content) if path.endswith(".gz") else content
        if path.removesuffix(".gz").endswith(".graphml"):
            return _unwritten(nx.parse_graphml(content.decode()))
        data: Any = parse_json(content)
        return nx.node_link_graph(data, edges="edges" if "edges" in data else "links")
    except CogmapError:
        raise
    except OSError as error:
        raise CogmapError(
            f"map {path}: it cannot be read ({error.strerror or error}); give a file of a graph"
        ) from error
    except Exception as error:  # whatever networkx makes of what is no graph
        kind = type(error).__name__
        raise CogmapError(f"map {path}: it is no graph in node-link JSON or GraphML ({kind}); give one") from error


def _unwritten(graph: Any) -> Any:
    """The graph with positions and sights that an agent's map had, which GraphML holds as JSON text."""
    for _, facts in graph.nodes(data=True):
        for name, value in facts.items():
            if isinstance(value, str) and value[:1] in ("[", "{"):
                try:
                    facts[name] = parse_json(value.encode())
                except ValueError:  # a label that begins so
                    continue
    return graph
