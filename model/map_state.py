"""A cognitive map as plain arrays and labels, and back."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .cognitive_map import CognitiveMap
from .dirichlet import EMPTY
from .errors import CogmapError
from .growth_log import KINDS, GrowthEvent

Arrays = dict[str, NDArray[Any]]


def map_arrays(map_: CognitiveMap) -> Arrays:
    """Every number of the map; the labels of its domains are left to `map_.sights` and `map_.positions`."""
    arrays: Arrays = {}
    for name in ("A_o", "A_p", "B_s"):
        for part, values in getattr(map_, name).state().items():
            arrays[f"{name}.{part}"] = values
    for name, column in map_.columns.items():
        arrays[f"map.{name}"] = column.values.copy()
    events = [
        (event.step, KINDS.index(event.kind), event.index, _or(event.source), _or(event.action), _number(map_, event))
        for event in map_.growth
    ]
    arrays["growth"] = np.array(events, dtype=np.int64).reshape(-1, 6)
    return arrays


def restore_map(
    map_: CognitiveMap, arrays: Mapping[str, NDArray[Any]], sights: Sequence[Hashable], positions: Sequence[Hashable]
) -> None:
    """Fill an empty map with what `map_arrays` gave, and the labels of its domains.

    Raises:
        CogmapError: the arrays do not fit one another or the labels, or hold numbers out of range.
        KeyError: an array is missing.
    """
    _check_counts(arrays, len(sights), len(positions), len(map_.motions))
    _check_columns(arrays, len(arrays["A_o.keys"]), len(positions), len(map_.motions))
    if arrays["growth"].ndim != 2 or not _within(arrays["growth"][:, 1], 0, len(KINDS)):
        raise CogmapError("map: the log of growth has kinds that are none; save it again")
    for label in sights:
        map_.sights.add(label)
    for label in positions:
        map_.positions.add(label)
    map_.A_o.outcomes = len(map_.sights) + 1
    for name in ("A_o", "A_p", "B_s"):
        getattr(map_, name).restore({part: arrays[f"{name}.{part}"] for part in ("keys", "prior", "evidence")})
    map_.restore_columns({name: arrays[f"map.{name}"] for name in map_.columns})
    map_.growth.extend(_events(map_, arrays["growth"].tolist()))


def _check_counts(arrays: Mapping[str, NDArray[Any]], sights: int, positions: int, actions: int) -> None:
    places = len(arrays["A_o.keys"])
    tables = {"A_o": (places, sights), "A_p": (places, positions), "B_s": (places * actions, places)}
    for name, (rows, outcomes) in tables.items():
        keys, prior, evidence = (arrays[f"{name}.{part}"] for part in ("keys", "prior", "evidence"))
        fits = keys.ndim == 2 and len(keys) == rows and keys.shape == prior.shape == evidence.shape
        fits = fits and all(_within(counts, 0, np.inf) for counts in (prior, evidence))
        if not (fits and keys.dtype.kind == "i" and _within(keys, EMPTY, outcomes)):
            raise CogmapError(f"map: the counts of {name} do not fit {rows} rows of {outcomes} outcomes; save it again")


def _check_columns(arrays: Mapping[str, NDArray[Any]], places: int, positions: int, actions: int) -> None:
    visits = int(np.count_nonzero(arrays["map.visited"]))
    columns = {
        "position_of": ((places,), -1, positions),
        "place_at": ((positions,), -1, places),
        "beyond": ((positions, actions), -1, positions),
        "visited": ((places,), 0, 2),
        "visits": ((visits,), 0, places),
        "sensed": ((places, actions), 0, 3),
        "walked": ((places, actions), 0, 2),
    }
    for name, (shape, least, bound) in columns.items():
        values = arrays[f"map.{name}"]
        if values.shape != shape or values.dtype.kind not in "ib" or not _within(values, least, bound):
            raise CogmapError(f"map: {name} does not fit {places} places and {positions} positions; save it again")


def _within(numbers: NDArray[Any], least: float, bound: float) -> bool:
    """Whether all numbers are in [least, bound); a NaN is not."""
    return numbers.dtype.kind in "ibf" and bool(((numbers >= least) & (numbers < bound)).all())


def _or(number: int | None) -> int:
    return -1 if number is None else number


def _events(map_: CognitiveMap, rows: list[list[int]]) -> list[GrowthEvent]:
    return [
        GrowthEvent(
            step=step,
            kind=KINDS[kind],
            index=index,
            label=None if label < 0 else map_.sights[label] if KINDS[kind] == "sight" else map_.positions[label],
            source=None if source < 0 else source,
            action=None if action < 0 else action,
        )
        for step, kind, index, source, action, label in rows
    ]


def _number(map_: CognitiveMap, event: GrowthEvent) -> int:
    """Number of the event's label in its domain, or -1."""
    domain = map_.sights if event.kind == "sight" else map_.positions
    return -1 if event.label is None else domain.index(event.label)
