"""A map as plain JSON values and arrays, and back."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .domain import Domain
from .errors import CogmapError
from .factors import parts_of
from .growth_event import KINDS, GrowthEvent, check_growth
from .readable_map import ReadableMap

Arrays = dict[str, NDArray[Any]]


def map_state(map_: ReadableMap) -> tuple[dict[str, Any], Arrays]:
    """Everything of a map that a file has to keep: the state of every factor, and the growth log."""
    stores = (map_.visits, *(store for factor in map_.factors for store in factor.stores))
    arrays = {f"{store.name}.{part}": values for store in stores for part, values in store.state().items()}
    header = {"places": len(map_.places), "factors": {factor.name: factor.state() for factor in map_.factors}}
    return header, arrays | {"growth": _rows(map_)}


def restore_map(map_: ReadableMap, header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> None:
    """Fill an empty map of the same factors with what `map_state` gave.

    Raises:
        CogmapError: the arrays do not fit one another or the labels, or hold numbers out of range.
        KeyError: an array, or what a factor has to keep, is missing.
    """
    places = header["places"]
    _check_places(map_, places, arrays)
    for factor in map_.factors:
        factor.restore(header["factors"][factor.name], arrays, places)
    map_.resize(places)
    map_.visits.restore(parts_of(map_.visits, arrays))
    growth = arrays["growth"]
    check_growth(growth, places=places, actions=len(map_.motions), sensors=len(map_.sensors))
    map_.growth.extend(_events(map_, growth))
    for name in arrays:
        if name.startswith("changes."):  # earlier versions could take steps back; that is forgotten, yet not damaged
            _ = arrays[name]


def _check_places(map_: ReadableMap, places: Any, arrays: Mapping[str, NDArray[Any]]) -> None:
    """Refuse a number of places that the arrays do not have, before there is room made for them."""
    rows = len(arrays[f"{map_.transitions.sensed.name}.values"])
    if not isinstance(places, int) or isinstance(places, bool) or not 1 <= places == rows:
        raise CogmapError(f"map: it has {places!r} places, and what is known of {rows}; save it again")


def _rows(map_: ReadableMap) -> NDArray[np.int64]:
    """`[events, 7]` the log of growth: step, kind, index, source, action, numbers of label and sensor; -1 for None."""
    rows = np.full((len(map_.growth), 7), -1, dtype=np.int64)
    sensors, domains = list(map_.sensors), _domains(map_)
    for row, event in zip(rows, map_.growth, strict=True):
        row[:3] = event.step, KINDS.index(event.kind), event.index
        row[3:5] = [-1 if number is None else number for number in (event.source, event.action)]
        if event.label is not None or event.sensor is not None:
            number = domains[event.sensor].find(event.label)
            row[5] = -1 if number is None else number  # it was forgotten
        if event.sensor is not None:
            row[6] = sensors.index(event.sensor)
    return rows


def _domains(map_: ReadableMap) -> dict[str | None, Domain]:
    """The labels of each sensor by its name, and the positions."""
    return {None: map_.positions, **{sight.name: sight.labels for sight in map_.sights_sensed}}


def _events(map_: ReadableMap, rows: NDArray[np.int64]) -> Iterator[GrowthEvent]:
    sensors, domains = list(map_.sensors), _domains(map_)
    for step, kind, index, source, action, number, by in rows.tolist():
        sensor = None if by < 0 else sensors[by]
        label = None if number < 0 else domains[sensor][number]
        source, action = (None if place < 0 else place for place in (source, action))
        yield GrowthEvent(step, KINDS[kind], index, label, source, action, sensor)
