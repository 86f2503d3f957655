"""From nodes and edges as they were written to a world that can be lived in, or to one clear error."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import WorldError
from ..sights import Sights
from .actions import STAY, actions, declared, local_labels, names
from .geometry import Ends, Geometry
from .layout import Layout
from .raw import Attributes, RawGraph, label, shown, some
from .sensors import sensors_of

POSES = ("motions", "displacement", "lengths", "bearing", "none")
"""What an agent is told of a pose: the displacements that `graph.motions` declares; the displacement measured after
each move, and the bearing of each way; the same, and how long each way is before it was walked; bearings alone;
nothing. The first that is known is the default."""

BEARINGS = ("displacement", "lengths", "bearing")  # Those of which the bearings of ways are part


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
    places = _places(raw)
    ends, edges = _ends(raw, {place: i for i, place in enumerate(places)})
    motions = declared(raw)
    ends, edges, named = _without_stays(raw, ends, edges, names(raw, edges, motions))
    geometry = Geometry.of(raw, ends, edges, needed=pose != "none")
    told = _told(raw, pose, ["motions"] * (motions is not None) + geometry.poses())
    order = geometry.order(ends[:, 0])
    first = np.searchsorted(ends[order, 0], np.arange(len(places) + 1))
    ordered = geometry.ordered(order)
    if named is None:
        ways = local_labels(first.tolist(), ordered.bearings if told in BEARINGS else None)
    else:
        ways = [named[i] for i in order.tolist()]
    _check_ways(raw, places, first, ways)
    if strong:
        _check_reach(raw, places, ends)
    sensed, labels = sensors_of(raw, sensors, sights, np.diff(first).tolist(), seed)
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
        bearings=ordered.bearings,
        lengths=ordered.lengths,
        coordinates=ordered.coordinates,
    )


def _told(raw: RawGraph, pose: str | None, known: Sequence[str]) -> str:
    if pose is not None and pose not in POSES:
        raise WorldError(f"unknown pose {pose!r}; use one of {', '.join(POSES)}")
    if pose is not None and pose not in known:
        raise WorldError(f"{raw.source}: pose {pose!r} is not known; use one of {', '.join(known)}")
    return pose or known[0]


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


def _check_reach(raw: RawGraph, places: Sequence[Any], ends: Ends) -> None:
    from scipy.sparse import coo_array  # slow to import
    from scipy.sparse.csgraph import connected_components

    count = len(places)
    graph = coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(count, count)).tocsr()
    _, part = connected_components(graph, directed=True, connection="strong")
    outside = np.flatnonzero(part != np.bincount(part).argmax())
    if outside.size:
        lost = some([places[i] for i in outside[:6].tolist()])
        raise WorldError(
            f"{raw.source} is not strongly connected: {outside.size} of {count} places can never be reached from the "
            f"rest, or never left for it ({lost}); add the ways that are missing, or remove these places"
        )
