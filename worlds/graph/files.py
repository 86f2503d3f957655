"""Graphs in files: node-link JSON as networkx writes it, GraphML, and topological maps of ROS in YAML."""

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ..errors import WorldError
from ..text import read_text
from .build import build
from .layout import Layout
from .raw import RawGraph, shown

LARGEST = 100 * 2**20  # bytes of the largest graph file that is read
LARGEST_YAML = 16 * 2**20  # the same of YAML, which takes long to read
MOST = 4_000_000  # nodes and edges in a file; aliases of YAML make many of little text


def is_graph_file(path: str | Path) -> bool:
    """Whether the name of a file says that it has a graph in it."""
    return Path(path).suffix.lower() in _READERS


def read_graph(path: str | Path, **options: Any) -> Layout:
    """The world in a graph file: `.json`, `.graphml`, `.xml`, `.yaml`, `.yml`, `.tmap` or `.tmap2`.

    Args:
        path: the file.
        options: `sights`, `seed`, `sensors`, `pose`, `strong`; see `GraphWorld.from_networkx`.

    Raises:
        WorldError: the file cannot be read, is too large, of another format, or has no world in it.
    """
    return build(read_raw(path), **options)


def read_raw(path: str | Path) -> RawGraph:
    """The nodes and edges of a graph file.

    Raises:
        WorldError: the file cannot be read, is too large, or of another format.
    """
    path = Path(path)
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        raise WorldError(f"{path} is no graph file by its name; use one of {', '.join(_READERS)}")
    text = read_text(path, most=LARGEST_YAML if reader is _read_yaml else LARGEST)
    try:
        return reader(text, path.stem, str(path))
    except RecursionError as error:
        raise WorldError(f"{path} is nested too deeply for a graph") from error


def _read_json(text: str, name: str, source: str) -> RawGraph:
    try:
        _check_count(sum(map(text.count, "{[")), source)
        found = json.loads(text)
    except ValueError as error:
        raise error if isinstance(error, WorldError) else WorldError(f"{source} is no JSON: {error}") from error
    if not isinstance(found, dict) or not isinstance(found.get("nodes"), list):  # pyright: ignore[reportUnknownMemberType]
        raise WorldError(
            f"{source} is no graph: give an object with 'nodes' and 'edges', as nx.node_link_data writes it"
        )
    graph: dict[str, Any] = found  # pyright: ignore[reportUnknownVariableType]
    edges = graph.get("edges", graph.get("links"))
    attributes = _mapping(graph.get("graph", {}), f"{source}: 'graph'")
    if not isinstance(edges, list):
        raise WorldError(f"{source} is no graph: it has no list 'edges'")
    return RawGraph(
        _name(attributes, name),
        source,
        bool(graph.get("directed", False)),
        attributes,
        [(_taken(node, "id", f"{source}: node {i}"), node) for i, node in enumerate(graph["nodes"])],
        [
            (_taken(edge, "source", f"{source}: edge {i}"), _taken(edge, "target", f"{source}: edge {i}"), edge)
            for i, edge in enumerate(edges)  # pyright: ignore[reportUnknownVariableType]
        ],
    )


def _read_graphml(text: str, name: str, source: str) -> RawGraph:
    import networkx as nx

    if "<!ENTITY" in text:  # a few that speak of one another can stand for any length
        raise WorldError(f"{source} declares entities; write out what they mean")
    _check_count(text.count("<node") + text.count("<edge"), source)
    try:
        graph = nx.parse_graphml(text)
    except RecursionError:
        raise
    except Exception as error:  # of the XML parser, of networkx, or of a value that it converts
        raise WorldError(f"{source} is no GraphML: {error}") from error
    return RawGraph.of(graph, name=_name(graph.graph, name), source=source)


def _read_yaml(text: str, name: str, source: str) -> RawGraph:
    import yaml

    try:
        found = yaml.load(text, Loader=_loader())
    except (yaml.YAMLError, LookupError, TypeError, ValueError) as error:
        raise WorldError(f"{source} is no YAML: {' '.join(str(error).split())}") from error
    whole = found if isinstance(found, dict) else {"nodes": found}  # pyright: ignore[reportUnknownVariableType]
    listed: Any = whole.get("nodes")  # pyright: ignore[reportUnknownMemberType]
    if not isinstance(listed, list):
        raise WorldError(f"{source} is no topological map: give a list 'nodes', as topological_navigation writes it")
    _check_count(sum(map(_size, listed)), source)  # pyright: ignore[reportUnknownArgumentType]
    nodes: list[tuple[Any, Mapping[str, Any]]] = []
    edges: list[tuple[Any, Any, Mapping[str, Any]]] = []
    for i, entry in enumerate(listed):  # pyright: ignore[reportUnknownVariableType]
        where = f"{source}: node {i}"
        node = _mapping(_mapping(entry, where).get("node", entry), where)
        waypoint = _taken(node, "name", where)
        nodes.append((waypoint, _waypoint(node, where)))
        leading = node.get("edges") or ()
        if not isinstance(leading, list | tuple):
            raise WorldError(f"{where}: edges are {shown(leading)}; give a list")
        for edge in leading:  # pyright: ignore[reportUnknownVariableType]
            edges.append((waypoint, _taken(edge, "node", f"{where}: an edge"), {}))
    return RawGraph(_name(whole, name), source, True, {}, nodes, edges)  # pyright: ignore[reportUnknownMemberType]


def _loader() -> Any:
    """The fast loader of plain values, without merge keys: those of merged mappings double at every level."""
    import yaml

    base: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)

    class Loader(base):
        def flatten_mapping(self, node: Any) -> None:
            if any(key.tag == "tag:yaml.org,2002:merge" for key, _ in node.value):
                raise yaml.YAMLError("merge keys (<<) are not read; write out what they merge")
            super().flatten_mapping(node)

    return Loader


def _size(entry: Any) -> int:
    """A node of a topological map and its edges."""
    node = entry.get("node", entry) if isinstance(entry, dict) else None  # pyright: ignore[reportUnknownMemberType, reportUnknownVariableType]
    edges = node.get("edges") if isinstance(node, dict) else None  # pyright: ignore[reportUnknownMemberType, reportUnknownVariableType]
    return 1 + (len(edges) if isinstance(edges, list) else 0)  # pyright: ignore[reportUnknownArgumentType]


def _check_count(count: int, source: str) -> None:
    if count > MOST:
        raise WorldError(f"{source} has {count:,} nodes and edges or so; {MOST:,} are read at most")


def _name(attributes: Mapping[str, Any], name: str) -> str:
    """The name that a graph has, if it can be printed; else that of the file."""
    given = attributes.get("name")
    return given if isinstance(given, str) and given and given.isprintable() else name


def _waypoint(node: Mapping[str, Any], where: str) -> Mapping[str, Any]:
    """The attributes of a waypoint that count here: its position, and what `properties` say of it."""
    pose = _mapping(node.get("pose") or {}, f"{where}: pose")
    position = _mapping(pose.get("position") or {}, f"{where}: position")
    properties = _mapping(node.get("properties") or {}, f"{where}: properties")
    return {**{key: properties[key] for key in ("sight",) if key in properties}, **dict(position)}


def _mapping(value: Any, where: str) -> Mapping[str, Any]:
    if not isinstance(value, dict):
        raise WorldError(f"{where} is {shown(value)}; give names with values")
    return value  # pyright: ignore[reportUnknownVariableType]


def _taken(entry: Any, key: str, where: str) -> Any:
    value = _mapping(entry, where).get(key)
    if value is None:
        raise WorldError(f"{where} has no {key!r}; give it one")
    return value


_READERS: Mapping[str, Callable[[str, str, str], RawGraph]] = {
    ".json": _read_json,
    ".graphml": _read_graphml,
    ".xml": _read_graphml,
    ".yaml": _read_yaml,
    ".yml": _read_yaml,
    ".tmap": _read_yaml,
    ".tmap2": _read_yaml,
}
