"""What the ways of a graph are called, and which actions an agent has there."""

import json
from collections.abc import Mapping, Sequence
from contextlib import suppress
from itertools import pairwise
from typing import Any

import numpy as np

from ..errors import WorldError
from ..motions import Motions
from .geometry import Ends, Floats
from .raw import Edges, RawGraph, label, number, shown, some

STAY = "stay"
MOST_ACTIONS = 16  # so many names of ways are actions of the whole world; with more, ways belong to the place


def declared(raw: RawGraph) -> dict[str, tuple[int, ...]] | None:
    """The displacement of each motion in `graph.motions`, `stay` added; None where there are none.

    Raises:
        WorldError: they are no vectors of whole numbers, all of one length.
    """
    given = _attribute(raw, "motions")
    if not given:
        return None
    found = {name: _vector(raw, name, vector) for name, vector in given.items()}
    sizes = {len(vector) for vector in found.values()}
    if len(sizes) != 1 or 0 in sizes:
        raise WorldError(f"{raw.source}: motions differ in length; give each as many whole numbers as the others")
    moves = {name: vector for name, vector in found.items() if any(vector)}
    return {**moves, STAY: (0,) * sizes.pop()}


def names(raw: RawGraph, edges: Edges, motions: Mapping[str, tuple[int, ...]] | None) -> list[Any] | None:
    """The `way` of each way; None if none has one.

    An undirected edge is called the same from both sides, unless motions are declared: then by the motion that undoes.

    Raises:
        WorldError: some have none, one is no label, or is none of the motions, or has none that undoes it.
    """
    given = [attributes.get("way") for attributes, _ in edges]
    missing = given.count(None)
    if missing and (missing < len(given) or motions):
        raise WorldError(f"{raw.source}: {missing} of {len(given)} edges name no way; give each a 'way'")
    if missing or not given:
        return None
    found = [label(way, f"{raw.source}: way of an edge") for way in given]
    if motions is None:
        return found
    if unknown := [way for way in found if way not in motions]:
        raise WorldError(f"{raw.source}: way {shown(unknown[0])} is none of the motions ({some(list(motions))})")
    undo = {name: _undone(motions, name) for name in motions}
    back = [undo[way] if against else way for way, (_, against) in zip(found, edges, strict=True)]
    if None in back:
        way = found[back.index(None)]
        raise WorldError(f"{raw.source}: no motion undoes {shown(way)}; add one, or write directed edges")
    return back


def actions(
    raw: RawGraph, ways: Sequence[Any] | None, motions: Mapping[str, tuple[int, ...]] | None, ends: Ends, pose: str
) -> Motions:
    """The actions of the world: the motions declared, else the names of ways while they are few, else `stay` alone."""
    if motions is not None:
        undo = [_undone(motions, name) for name in motions]
        order = list(motions)
        reverse = () if None in undo else tuple(order.index(name) for name in undo if name is not None)
        return Motions(tuple(order), tuple(motions.values()) if pose == "motions" else (), reverse)
    distinct = dict.fromkeys(ways or ())
    if not 0 < len(distinct) <= MOST_ACTIONS or any(not isinstance(name, str) for name in distinct):
        return Motions((STAY,), local=True)
    order = [name for name in distinct if name != STAY] + [STAY]
    return Motions(tuple(order), (), _reverse(raw, order, ways or (), ends))


def local_labels(first: Sequence[int], degrees: Floats | None) -> list[int]:
    """Labels for ways without names: whole degrees, no two alike at one place, or 0, 1, 2 … where none are told."""
    found: list[int] = []
    for begin, end in pairwise(first):
        taken: set[int] = set()
        for i in range(begin, end):
            angle = i - begin if degrees is None else round(float(degrees[i])) % 360
            while angle in taken:
                angle += 1
            taken.add(angle)
            found.append(angle)
    return found


def _reverse(raw: RawGraph, order: list[str], ways: Sequence[Any], ends: Ends) -> tuple[int, ...]:
    """The action that undoes each: as `graph.reverse` says, else where one always does; nothing if some have none."""
    given = _attribute(raw, "reverse")
    if given is None:
        leads = set(zip(ends[:, 0].tolist(), ways, ends[:, 1].tolist(), strict=True))
        able = {name: set(order) - {STAY} for name in order}
        for source, way, target in leads:
            able[way] = {back for back in able[way] if (target, back, source) in leads}
        given = {name: min(backs) for name, backs in able.items() if len(backs) == 1}
    undo = {**given, STAY: STAY}
    return tuple(order.index(undo[name]) for name in order) if all(undo.get(name) in order for name in order) else ()


def _undone(motions: Mapping[str, tuple[int, ...]], name: str) -> str | None:
    backwards = tuple(-x for x in motions[name])
    return next((other for other, vector in motions.items() if vector == backwards), None)


def _vector(raw: RawGraph, name: str, vector: Any) -> tuple[int, ...]:
    where = f"{raw.source}: motion {shown(name)}"
    if not isinstance(vector, list | tuple):
        raise WorldError(f"{where} is {shown(vector)}; give a displacement such as [0, 1]")
    found = [number(part, where) for part in vector]  # pyright: ignore[reportUnknownVariableType]
    if any(part != np.rint(part) for part in found):
        raise WorldError(f"{where} is {shown(vector)}; use whole numbers")
    return tuple(int(part) for part in found)


def _attribute(raw: RawGraph, key: str) -> dict[str, Any] | None:
    """An attribute of the graph that maps names, also where it is written as text (GraphML has no mappings)."""
    value: Any = raw.attributes.get(key)
    if isinstance(value, str):
        with suppress(ValueError):
            value = json.loads(value)
    if value is not None and not (isinstance(value, dict) and all(isinstance(name, str) for name in value)):  # pyright: ignore[reportUnknownVariableType]
        raise WorldError(f"{raw.source}: graph.{key} is {shown(value)}; give an object with a value for each name")
    return value  # pyright: ignore[reportUnknownVariableType]
