"""A map that is known beforehand, as records of hypotheses."""

from collections import Counter, deque
from collections.abc import Hashable, Mapping
from typing import Any, cast

from ..inference import Place, Share, Way, readings_of
from ..model import CogmapError, GenerativeModel, Position
from .known_map import GivenWay, KnownMap, position_of
from .sensing import Sensing

SURE = 4.0  # readings that what the graph says of a sight or a way is worth


def records_of_graph(known: KnownMap, model: GenerativeModel, sensing: Sensing) -> dict[int, Place]:
    """The places of a graph as records, numbered in its order.

    Raises:
        CogmapError: a way is no action, two ways of one place are the same, places lie in one another, or a sight is
            none that its sensor could see.
    """
    numbers = {node: number for number, node in enumerate(known.nodes)}
    leads = _leads(known, model, numbers)
    positions = _positions(known, model, leads) if sensing.scheme.displacements else dict.fromkeys(numbers.values(), ())
    into: dict[int, set[tuple[int, int]]] = {number: set() for number in numbers.values()}
    for number, ahead in leads.items():
        for way, action in enumerate(sensing.actions):
            if action in ahead:
                into[ahead[action]].add((number, way))
    shown = {node: [_sights(known, node, model, k) for k in range(sensing.scheme.sensors)] for node in numbers}
    labels = sensing.labels()
    return {
        number: Place(
            tuple(
                readings_of(shares, many + 1, sure=SURE) if shares else {}
                for shares, many in zip(shown[node], labels, strict=True)
            ),
            tuple(_way(leads[number].get(action)) for action in sensing.actions) or (Way(),),
            0,
            positions[number],
            (number,),
            frozenset(into[number]),
            Share(),
        )
        for node, number in numbers.items()
    }


def _way(to: int | None) -> Way:
    return Way(-SURE, 0.0, SURE) if to is None else Way(SURE, SURE, 0.0, 1, to)


def _leads(known: KnownMap, model: GenerativeModel, numbers: Mapping[Hashable, int]) -> dict[int, dict[int, int]]:
    """By place and action, where the way leads."""
    leads: dict[int, dict[int, int]] = {number: {} for number in numbers.values()}
    for way in known.ways:
        action, source, target = _action(known, model, way), numbers[way.source], numbers[way.target]
        if action == model.motions.stay or (source == target and "known" in way.facts):
            continue  # a map's own edges from a place to itself say that it is shut
        if leads[source].setdefault(action, target) != target:
            name = model.motions.names[action]
            raise CogmapError(f"{known.where}: two ways of {way.source!r} are {name!r}; give each its own action")
    return leads


def _action(known: KnownMap, model: GenerativeModel, way: GivenWay) -> int:
    motions = model.motions
    name = next((way.facts[key] for key in ("way", "action") if key in way.facts), None)
    if name in motions.names:
        action = motions.names.index(name)
        return motions.inverse[action] if way.reverse else action
    here, there = (position_of(known.nodes[node]) for node in (way.source, way.target))
    if name is None and here is not None and there is not None:
        try:
            across = tuple(b - a for a, b in zip(here, there, strict=False))
        except TypeError as error:
            ends = f"{way.source!r} lies at {here!r} and {way.target!r} at {there!r}"
            raise CogmapError(f"{known.where}: {ends}; give tuples of numbers") from error
        if across in motions.displacements:
            return motions.displacements.index(across)
    moving = [action for action in range(len(motions)) if action != motions.stay]
    if not motions.placed and known.listed.get(way, len(moving)) < len(moving):
        return moving[known.listed[way]]
    ends = f"from {way.source!r} to {way.target!r}"
    names = ", ".join(motions.names)
    raise CogmapError(f"{known.where}: the way {ends} is {name!r}, no action; label it 'way' with one of {names}")


def _positions(known: KnownMap, model: GenerativeModel, leads: Mapping[int, Mapping[int, int]]) -> dict[int, Position]:
    """Of each place, counted from the first: as the graph has them, or else as its ways lead."""
    given = [position_of(facts) for facts in known.nodes.values()]
    if all(position is not None for position in given):
        whole = [_whole(known, position, len(model.motions.displacements[0])) for position in given]
        found = {k: tuple(x - y for x, y in zip(at, whole[0], strict=True)) for k, at in enumerate(whole)}
    else:
        found = {0: model.pose.origin or ()}
        waiting = deque([0])
        while waiting:
            number = waiting.popleft()
            for action, to in leads[number].items():
                if to not in found:
                    found[to] = model.motions.move(found[number], action)
                    waiting.append(to)
    if len(found) < len(given):
        raise CogmapError(f"{known.where}: not all its places hang together; give each node a 'position'")
    twice = [at for at, count in Counter(found.values()).items() if count > 1]
    if twice:
        raise CogmapError(f"{known.where}: two places lie at {twice[0]}, counted from the first; give pose=NoPose()")
    return found


def _whole(known: KnownMap, position: Any, size: int) -> Position:
    try:
        whole = tuple(round(float(x)) for x in position)
        fits = len(whole) == size and all(x == float(y) for x, y in zip(whole, position, strict=True))
    except (TypeError, ValueError, OverflowError):
        whole, fits = (), False
    if not fits:
        raise CogmapError(f"{known.where}: position {position!r} is not {size} whole numbers; give pose=NoPose()")
    return whole


def _sights(known: KnownMap, node: Hashable, model: GenerativeModel, sensor: int) -> Mapping[int, float]:
    """Shares of the labels of a sensor that a node shows, or may show; none where it says nothing."""
    if not model.sights_sensed:
        return {}
    sight, facts = model.sights_sensed[sensor], known.nodes[node]
    value = facts.get(sight.name, None if sensor else facts.get("sights"))
    told = _shown(value)
    if told is None:
        return {}
    try:
        reading: Any = sight.read(sight.check(told), step=0)
    except CogmapError as error:
        raise CogmapError(f"{known.where}: node {node!r}: {error}") from error
    return reading if isinstance(reading, Mapping) else {reading: 1.0}


def _shown(value: Any) -> Any:
    """A label; JSON has lists where labels are tuples, and the labels of a map in a list of their own."""
    if isinstance(value, list):
        items = cast(list[Any], value)
        if all(isinstance(item, dict) and {"sight", "probability"} <= {*item} for item in items):
            return {_shown(item["sight"]): item["probability"] for item in items} or None
        return tuple(_shown(item) for item in items)
    if isinstance(value, Mapping):
        given = cast(Mapping[Any, Any], value)
        return tuple(_shown(item) for item in given["tuple"]) if set(given) == {"tuple"} else given or None
    return value
