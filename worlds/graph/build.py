"""From nodes and edges as they were written to a world that can be lived in, or to one clear error."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import WorldError
from ..sights import Sights, give_sights
from .actions import STAY, actions, declared, local_labels, names
from .geometry import Ends, bearings, coordinates, lengths
from .layout import Layout
from .raw import Attributes, RawGraph, label, shown, some

POSES = ("motions", "displacement", "bearing", "none")
"""What an agent is told of a pose: the displacements that `graph.motions` declares; the displacement measured after
each move; the bearing of each way; nothing. The first that is known is the default."""

_GIVEN = "sights='distinct', 'ways' or K (on the command line --sights)"
_TAKEN = ("open", "ways", "bearings", "displacement", "taken", "outcome", "turn", "moved", "cost")
_NO_SENSORS = frozenset({"id", "position", "x", "y", "z", "name", "label"})


def build(
    raw: RawGraph,
    *,
    sights: Sights | None = None,
    seed: int = 0,
    sensors: Sequence[str] | None = None,
    pose: str | None = None,
    strong: bool = True,
) -> Layout:
    """The world of a graph.

    Args:
        raw: nodes and edges.
        sights: for nodes that have none; see `Sights`.
        seed: of sights at random.
        sensors: the attributes of nodes that are sensed; unless given those of `graph.sensors`, else `sight`, else
            every attribute with a label at each node.
        pose: one of `POSES`; the first that is known unless given.
        strong: refuse a graph in which some place cannot be reached from some other.

    Raises:
        WorldError: what cannot be a world, with what, where and how to mend it.
    """
    if pose is not None and pose not in POSES:
        raise WorldError(f"unknown pose {pose!r}; use one of {', '.join(POSES)}")
    places = _places(raw)
    ends, edges = _ends(raw, {place: i for i, place in enumerate(places)})
    motions = declared(raw)
    named = names(raw, edges, motions)
    ends, edges, named = _without_stays(raw, ends, edges, named)
    where = coordinates(raw, needed=pose != "none")
    degrees, far = bearings(raw, ends, edges, where), lengths(raw, ends, edges, where)
    known = {
        "motions": motions is not None,
        "displacement": where is not None or (degrees is not None and far is not None),
        "bearing": degrees is not None,
        "none": True,
    }
    told = pose or next(pose for pose in POSES if known[pose])
    if not known[told]:
        raise WorldError(
            f"{raw.source}: pose {told!r} is not known; use one of {', '.join(p for p in POSES if known[p])}"
        )
    order = np.lexsort((np.zeros(len(ends)) if degrees is None else degrees, ends[:, 0]))
    first = np.searchsorted(ends[order, 0], np.arange(len(places) + 1))
    seen = degrees if told in ("displacement", "bearing") else None
    ways = local_labels(first.tolist(), _sorted(seen, order)) if named is None else [named[i] for i in order.tolist()]
    _check_ways(raw, places, first, ways)
    _check_reach(raw, places, ends, strong=strong)
    sensed, labels = _sensors(raw, sensors, sights, np.diff(first).tolist(), seed)
    return Layout(
        name=raw.name,
        places=tuple(places),
        sensors=sensed,
        labels=labels,
        motions=actions(raw, named, motions, ends, told),
        pose=told,
        first=first,
        target=ends[order, 1],
        ways=tuple(ways),
        bearings=_sorted(degrees, order),
        lengths=_sorted(far, order),
        coordinates=where,
    )


def _places(raw: RawGraph) -> list[Any]:
    if not raw.nodes:
        raise WorldError(f"{raw.source} has no nodes; give at least one")
    places = [label(node, f"{raw.source}: id of node {i}") for i, (node, _) in enumerate(raw.nodes)]
    seen: set[Any] = set()
    if twice := [place for place in places if place in seen or seen.add(place)]:
        raise WorldError(f"{raw.source}: two nodes have the id {shown(twice[0])}; give each its own")
    return places


def _ends(raw: RawGraph, number: dict[Any, int]) -> tuple[Ends, list[tuple[Attributes, bool]]]:
    """`[W, 2]` the places that each way joins, and its attributes with whether it goes against how it was written."""
    found: list[tuple[int, int]] = []
    edges: list[tuple[Attributes, bool]] = []
    for source, target, attributes, against in raw.ways():
        ends = [number.get(label(end, f"{raw.source}: end of an edge")) for end in (source, target)]
        if ends[0] is None or ends[1] is None:
            nowhere = source if ends[0] is None else target
            edge = f"the edge from {shown(source)} to {shown(target)}"
            raise WorldError(f"{raw.source}: {edge} leads nowhere; there is no node {shown(nowhere)}")
        found.append((ends[0], ends[1]))
        edges.append((attributes, against))
    return np.array(found, dtype=np.int32).reshape(-1, 2), edges


def _without_stays(
    raw: RawGraph, ends: Ends, edges: list[tuple[Attributes, bool]], named: list[Any] | None
) -> tuple[Ends, list[tuple[Attributes, bool]], list[Any] | None]:
    """Every place has `stay`; a way of this name may lead back only, and is left out."""
    if named is None or STAY not in named:
        return ends, edges, named
    keep = [way != STAY for way in named]
    if ((ends[:, 0] != ends[:, 1]) & ~np.array(keep)).any():
        raise WorldError(f"{raw.source}: a way {STAY!r} leads to another place; every place has it, and it stays")
    kept = [i for i, stays in enumerate(keep) if stays]
    return ends[kept], [edges[i] for i in kept], [named[i] for i in kept]


def _check_ways(raw: RawGraph, places: Sequence[Any], first: NDArray[np.int64], ways: Sequence[Any]) -> None:
    for place, begin, end in zip(places, first.tolist(), first[1:].tolist(), strict=False):
        row = ways[begin:end]
        if len(set(row)) < len(row):
            twice = next(way for way in row if row.count(way) > 1)
            raise WorldError(
                f"{raw.source}: two ways at {shown(place)} are called {shown(twice)}; give each its own name"
            )


def _check_reach(raw: RawGraph, places: Sequence[Any], ends: Ends, *, strong: bool) -> None:
    from scipy.sparse import coo_array  # slow to import
    from scipy.sparse.csgraph import connected_components

    count = len(places)
    graph = coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(count, count)).tocsr()
    _, part = connected_components(graph, directed=True, connection="strong")
    outside = np.flatnonzero(part != np.bincount(part).argmax())
    if strong and outside.size:
        lost = some([places[i] for i in outside[:6].tolist()])
        raise WorldError(
            f"{raw.source} is not strongly connected: {outside.size} of {count} places can never be reached from the "
            f"rest, or never left for it ({lost}); add the ways that are missing, or remove these places"
        )


def _sensors(
    raw: RawGraph, sensors: Sequence[str] | None, sights: Sights | None, ways: Sequence[int], seed: int
) -> tuple[tuple[str, ...], tuple[tuple[Any, ...], ...]]:
    """The sensors, and the labels of each at each place."""
    sensed = tuple(_named_sensors(raw, sensors))
    if taken := [sensor for sensor in sensed if sensor in _TAKEN]:
        raise WorldError(f"{raw.source}: {taken[0]!r} cannot be a sensor; observations have another use for the name")
    columns = [[attributes.get(sensor) for _, attributes in raw.nodes] for sensor in sensed]
    if sights is not None and sensed in ((), ("sight",)):
        given = columns[0] if columns else [None] * len(raw.nodes)
        known = {label(value, "sight") for value in given if value is not None}
        drawn = give_sights(sights, ways, seed=seed, taken=known, where=raw.source)
        sensed, columns = ("sight",), [[b if a is None else a for a, b in zip(given, drawn, strict=True)]]
    if not columns:
        raise WorldError(
            f"{raw.source}: nodes have no sights; give each a 'sight', or use sights='distinct', 'ways' or K"
        )
    for sensor, column in zip(sensed, columns, strict=True):
        if missing := [node for (node, _), value in zip(raw.nodes, column, strict=True) if value is None]:
            raise WorldError(
                f"{raw.source}: {len(missing)} of {len(column)} nodes have no {shown(sensor)} ({some(missing)}); "
                f"give each one, or use {_GIVEN}"
            )
    return sensed, tuple(
        tuple(label(value, f"{raw.source}: {sensor} of a node") for value in column)
        for sensor, column in zip(sensed, columns, strict=True)
    )


def _named_sensors(raw: RawGraph, sensors: Sequence[str] | None) -> Sequence[str]:
    chosen: Any = raw.attributes.get("sensors") if sensors is None else sensors
    if isinstance(chosen, str):
        chosen = [chosen]
    if chosen is not None:
        if not isinstance(chosen, list | tuple) or not all(isinstance(name, str) for name in chosen):  # pyright: ignore[reportUnknownVariableType]
            raise WorldError(f"{raw.source}: sensors are {shown(chosen)}; give the names of attributes of nodes")
        return [str(name) for name in chosen]  # pyright: ignore[reportUnknownVariableType, reportUnknownArgumentType]
    if any("sight" in attributes for _, attributes in raw.nodes):
        return ["sight"]
    first = raw.nodes[0][1]
    return [
        key
        for key, value in first.items()
        if key not in _NO_SENSORS
        and isinstance(value, str | int)
        and all(isinstance(attributes.get(key), str | int) for _, attributes in raw.nodes)
    ]


def _sorted(values: NDArray[np.float64] | None, order: NDArray[np.intp]) -> NDArray[np.float64] | None:
    return None if values is None else values[order]
