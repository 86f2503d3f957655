"""A cognitive map as plain arrays and labels, and back."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .change_rows import change_arrays, restore_changes
from .cognitive_map import CognitiveMap
from .dirichlet import EMPTY
from .errors import CogmapError
from .growth_event import KINDS, GrowthEvent

Arrays = dict[str, NDArray[Any]]


def map_arrays(map_: CognitiveMap) -> Arrays:
    """Every number of the map; the labels of its domains are left to `map_.sights` and `map_.positions`."""
    arrays: Arrays = {}
    for name in ("A_o", "A_p", "B_s"):
        for part, values in getattr(map_, name).state().items():
            arrays[f"{name}.{part}"] = values
    for name, column in map_.columns.items():
        arrays[f"map.{name}"] = column.values.copy()
    arrays["growth"] = _rows(map_)
    return arrays | change_arrays(map_.changes, map_.stores, map_.growth)


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
    map_.sights.extend(sights)
    map_.positions.extend(positions)
    map_.A_o.outcomes = len(map_.sights) + 1
    for name in ("A_o", "A_p", "B_s"):
        getattr(map_, name).restore({part: arrays[f"{name}.{part}"] for part in ("keys", "prior", "evidence")})
    map_.restore_columns({name: arrays[f"map.{name}"] for name in map_.columns})
    map_.growth.extend(_events(map_, arrays["growth"]))
    restore_changes(map_.changes, arrays, map_.stores, map_.growth)


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


def _rows(map_: CognitiveMap) -> NDArray[np.int64]:
    """`[events, 6]` the log of growth: step, kind, index, source, action, and number of the label; -1 for None."""
    rows = np.full((len(map_.growth), 6), -1, dtype=np.int64)
    rows[:, 0] = [event.step for event in map_.growth]
    rows[:, 1] = [KINDS.index(event.kind) for event in map_.growth]
    rows[:, 2] = [event.index for event in map_.growth]
    rows[:, 3] = [-1 if event.source is None else event.source for event in map_.growth]
    rows[:, 4] = [-1 if event.action is None else event.action for event in map_.growth]
    labelled = np.array([event.label is not None for event in map_.growth], dtype=np.bool_)
    sights = labelled & (rows[:, 1] == KINDS.index("sight"))
    for domain, chosen in ((map_.sights, sights), (map_.positions, labelled & ~sights)):
        labels = [map_.growth[i].label for i in np.flatnonzero(chosen).tolist()]
        rows[chosen, 5] = domain.indices(labels)
    return rows


def _events(map_: CognitiveMap, rows: NDArray[np.int64]) -> Iterator[GrowthEvent]:
    """The log of growth from its rows, column by column: it is long."""
    steps, kinds, indices, sources, actions, numbers = rows.T.tolist()
    domains = [list(map_.sights if kind == "sight" else map_.positions) for kind in KINDS]
    labels = [
        None if number < 0 else domain[number]
        for number, domain in zip(numbers, (domains[kind] for kind in kinds), strict=True)
    ]
    names = [KINDS[kind] for kind in kinds]
    return map(GrowthEvent, steps, names, indices, labels, _or_none(sources), _or_none(actions))


def _or_none(numbers: list[int]) -> list[int | None]:
    return [None if number < 0 else number for number in numbers]
