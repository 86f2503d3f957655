"""What sensors were expected to show in a place, before the last step taught it."""

from collections.abc import Hashable, Iterable

from ..model import CognitiveMap, ParameterUpdate, Sensor, Sight, SparseDirichlet, Ways

LEAST = 5e-4
"""Counts below which nothing is known."""


def expected_at(map_: CognitiveMap, place: int, learned: Iterable[ParameterUpdate]) -> dict[str, Hashable]:
    """Of each sensor what was most probable in the place, of ways None where nothing was known; None where of nothing.

    Args:
        map_: as it is now.
        place: of the map.
        learned: the counts that the last step has changed.
    """
    taught = [update for update in learned if update.place == place]
    return {name: _expected(map_, sensor, place, taught) for name, sensor in map_.sensors.items()}


def _expected(map_: CognitiveMap, sensor: Sensor, place: int, taught: Iterable[ParameterUpdate]) -> Hashable:
    if isinstance(sensor, Sight):
        counts = _before(sensor.table, place, None, taught)
        best = max(counts, key=counts.__getitem__, default=-1)
        return sensor.labels[best] if best >= 0 and counts[best] > LEAST else None
    if not isinstance(sensor, Ways):
        return None
    stay = map_.motions.stay
    ways = [True if way == stay else _was_open(map_, place, way, taught) for way in range(len(map_.motions))]
    return tuple(ways) if any(way is not None for action, way in enumerate(ways) if action != stay) else None


def _was_open(map_: CognitiveMap, place: int, action: int, taught: Iterable[ParameterUpdate]) -> bool | None:
    counts = _before(map_.B_s, map_.row(place, action), action, taught)
    shut = counts.pop(place, 0.0)
    opened = sum(counts.values())
    return None if abs(opened - shut) <= LEAST else opened > shut


def _before(
    table: SparseDirichlet, row: int, action: int | None, taught: Iterable[ParameterUpdate]
) -> dict[int, float]:
    """Evidence for each outcome, without what the last step added."""
    counts = table.counts(row)
    for update in taught:
        if (update.table, update.action) == (table.name, action):
            counts[update.outcome] = counts.get(update.outcome, 0.0) - update.amount
    return counts
