"""A graph of places that is given to an agent: from networkx, or a file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import atan2, degrees
from os import PathLike, fspath
from pathlib import PurePath
from typing import Any, cast

from ..model import CogmapError, Motions, MotionSpec, parse_json, read_file, unpack_gzip

Facts = Mapping[str, Any]

LARGEST_YAML = 16 * 2**20  # bytes of YAML that are read, which takes long


@dataclass(frozen=True, slots=True, eq=False)
class GivenWay:
    """One way: from, to, its attributes, and whether it is an undirected edge walked against how it was written."""

    source: Hashable
    target: Hashable
    facts: Facts
    reverse: bool


@dataclass(frozen=True)
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
        """The same of a networkx graph, or of a file of one: every file that `read_graph` makes a world of.

        That is node-link JSON (as networkx writes it), GraphML, and topological maps of ROS in YAML.

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

    @cached_property
    def listed(self) -> Mapping[GivenWay, int]:
        """Where no way is named, how many ways of its place come before each: by bearing, as worlds list them."""
        if any("way" in way.facts or "action" in way.facts for way in self.ways):
            return {}
        ranks, before = dict[GivenWay, int](), Counter[Hashable]()
        for way in sorted(self.ways, key=self._bearing):
            ranks[way] = before[way.source]
            before[way.source] += 1
        return ranks

    def _bearing(self, way: GivenWay) -> float:
        """Degrees from +y, clockwise: what the way says, else where its ends lie; 0 where nobody knows."""
        ends = [position_of(self.nodes[node]) for node in (way.source, way.target)]
        try:
            if "bearing" in way.facts:
                return float(way.facts["bearing"]) % 360.0
            if ends[0] is None or ends[1] is None:
                return 0.0
            right, up = (float(b) - float(a) for a, b in zip(*(end[:2] for end in ends if end), strict=True))
            return degrees(atan2(right, up)) % 360.0
        except (TypeError, ValueError) as error:
            raise CogmapError(f"{self.where}: where {way.source!r} lies is no numbers; give x and y") from error

    @property
    def motions(self) -> MotionSpec | dict[str, tuple[int, ...]]:
        """The actions: names and displacements, with one that stays; of a robot's map as many ways as a place has.

        Raises:
            CogmapError: the graph does not say.
        """
        given = self.attributes.get("motions")
        if given is None and self.listed and "robot" in self.attributes:
            return Motions(("stay", *(f"way {i + 1}" for i in range(max(self.listed.values()) + 1))))
        if not isinstance(given, Mapping) or not given:
            raise CogmapError(f"{self.where}: it does not say 'motions'; give the agent some: Agent(motions, map=...)")
        try:
            moves = {str(name): tuple(int(x) for x in vector) for name, vector in cast(Facts, given).items()}
        except (TypeError, ValueError) as error:
            raise CogmapError(f"{self.where}: its motions are no whole numbers; give name: displacement") from error
        if not any(any(vector) for vector in moves.values()) or all(any(vector) for vector in moves.values()):
            moves["stay"] = (0,) * len(next(iter(moves.values())))
        return moves


def position_of(facts: Facts) -> Any:
    """Where a node lies: its `position`, or its `x`, `y` and perhaps `z`; None where it does not say."""
    apart = tuple(facts[axis] for axis in "xyz" if axis in facts)
    return facts.get("position", apart if "x" in facts and "y" in facts else None)


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
        suffix = PurePath(path.removesuffix(".gz")).suffix.lower()
        if suffix in (".yaml", ".yml", ".tmap", ".tmap2"):
            return _topological(content)
        if suffix in (".graphml", ".xml"):
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
        kinds = "node-link JSON, GraphML or topological YAML"
        raise CogmapError(f"map {path}: it is no graph in {kinds} ({kind}); give one") from error


def _topological(content: bytes) -> Any:
    """The graph of a topological map of ROS: nodes with a name, a pose and edges to others."""
    import networkx as nx
    import yaml

    if len(content) > LARGEST_YAML:
        raise CogmapError(f"map: it has {len(content):,} bytes of YAML; {LARGEST_YAML:,} are read at most")
    found = yaml.load(content, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    listed = [entry.get("node", entry) for entry in (found["nodes"] if isinstance(found, dict) else found)]
    graph: Any = nx.DiGraph(robot=True)
    for node in listed:
        pose, told = node.get("pose") or {}, node.get("properties") or {}
        graph.add_node(node["name"], **(pose.get("position") or {}), **{k: told[k] for k in ("sight",) if k in told})
    ends = [(node["name"], edge["node"]) for node in listed for edge in node.get("edges") or ()]
    if nowhere := [end for end in ends if end[1] not in graph]:
        raise CogmapError(f"map: the edge from {nowhere[0][0]!r} leads to {nowhere[0][1]!r}, which is no node")
    graph.add_edges_from(ends)
    return graph


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
