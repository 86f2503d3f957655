"""A cognitive map as plain arrays and labels, and back."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from .cognitive_map import CognitiveMap
from .growth_log import KINDS, GrowthEvent

Arrays = dict[str, NDArray[Any]]


def map_arrays(map_: CognitiveMap) -> Arrays:
    """Every number of the map; the labels of its domains are left to `map_.sights` and `map_.positions`."""
    arrays: Arrays = {}
    for name in ("A_o", "A_p", "B_s"):
        for part, values in getattr(map_, name).state().items():
            arrays[f"{name}.{part}"] = values
    for name, column in map_.columns.items():
        arrays[f"map.{name}"] = column.values
    events = [
        (event.step, KINDS.index(event.kind), event.index, _or(event.source), _or(event.action), event.label is None)
        for event in map_.growth
    ]
    arrays["growth"] = np.array(events, dtype=np.int64).reshape(-1, 6)
    return arrays


def restore_map(
    map_: CognitiveMap, arrays: Mapping[str, NDArray[Any]], sights: Sequence[Hashable], positions: Sequence[Hashable]
) -> None:
    """Fill an empty map with what `map_arrays` gave, and the labels of its domains."""
    for label in sights:
        map_.sights.add(label)
    for label in positions:
        map_.positions.add(label)
    map_.A_o.outcomes = len(map_.sights) + 1
    for name in ("A_o", "A_p", "B_s"):
        getattr(map_, name).restore({part: arrays[f"{name}.{part}"] for part in ("keys", "prior", "evidence")})
    for name, column in map_.columns.items():
        column.restore(arrays[f"map.{name}"])
    map_.growth.extend(_events(map_, arrays["growth"].tolist()))


def _or(number: int | None) -> int:
    return -1 if number is None else number


def _events(map_: CognitiveMap, rows: list[list[int]]) -> list[GrowthEvent]:
    return [
        GrowthEvent(
            step=step,
            kind=KINDS[kind],
            index=index,
            label=None if unlabelled else _label(map_, KINDS[kind], index),
            source=None if source < 0 else source,
            action=None if action < 0 else action,
        )
        for step, kind, index, source, action, unlabelled in rows
    ]


def _label(map_: CognitiveMap, kind: str, index: int) -> Hashable:
    if kind == "sight":
        return map_.sights[index]
    if kind == "position":
        return map_.positions[index]
    return cast(Hashable, map_.position(index))
