"""What plans read of each place of a map, kept from step to step until the map has changed there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...model import ELSEWHERE, CogmapError
from .rows import Rows
from .transitions import Floats, Ints, likeliest
from .view import MapView


@dataclass(frozen=True, slots=True)
class PlaceRows:
    """What plans read of `n` places.

    Attributes:
        successors: `[n, K, slots]` where each action may lead to.
        probability: `[n, K, slots]` of each, zero where a slot is unused.
        likely: `[n, K]` where it most probably leads to besides the place itself; see `likeliest`.
        blocked: `[n, K]` P(staying | s, a).
        ways: `[n, N + 1]` nats that visits teach of B_s by their ways.
        positions: `[n, N + 1]` nats that visits teach of A_p.
        position: `[n, D]` where each place is; NaN where nobody knows.
        sights: `[n, N + 1]` nats that visits teach of the sights.
    """

    successors: Ints
    probability: Floats
    likely: Ints
    blocked: Floats
    ways: Floats
    positions: Floats
    position: Floats
    sights: Floats


class LocalCache:
    """What plans read of the places of one map. Costs what has changed and what is asked for.

    Args:
        map_: the map.
        visits: visits, at most, that plans ask the information of: N.
    """

    __slots__ = ("_beside", "_map", "_outcomes", "_read", "_sights", "_ways", "visits")

    def __init__(self, map_: MapView, visits: int) -> None:
        self.visits = visits
        self._map = map_
        self._ways, self._sights = Rows(self._new_ways), Rows(self._new_sights)
        self._beside: dict[int, list[int]] = {}  # where each place may lead to
        self._read = -1  # of the log of changes
        self._outcomes: list[int] = []

    def check(self, map_: MapView, look_ahead: int) -> None:
        """Raise `CogmapError` unless it is of this map, and tells of enough visits for this look-ahead."""
        if self._map is not map_:
            raise CogmapError("local cache: it is of another map; make one with LocalCache(map, look_ahead)")
        if self.visits < look_ahead:
            raise CogmapError(f"local cache: it tells of {self.visits} visits; make one for {look_ahead}")

    def refresh(self) -> None:
        """Forget what has changed since the last call."""
        map_, read = self._map, self._read
        ways, _ = map_.changed_places(read, map_.B_s, map_.visits)
        tables = [sensor.table for sensor in map_.sights_sensed]
        sights, self._read = map_.changed_places(read, map_.A_p, *tables)
        self._ways.forget(ways)
        if ways is None:
            self._beside.clear()
        for place in ways or ():
            self._beside.pop(place, None)
        outcomes = [table.outcomes for table in tables]
        self._sights.forget(sights if outcomes == self._outcomes else None)
        self._outcomes = outcomes

    def rows(self, places: Ints) -> PlaceRows:
        """All of these places, and a row of zeros at the end."""
        return PlaceRows(*self._ways.columns(places), *self._sights.columns(places))

    def within(self, places: Ints, steps: int) -> Ints:
        """Places within so many steps, however improbable, ascending."""
        beside, frontier = self._beside, places.tolist()
        known = set(frontier)
        for _ in range(steps):
            ahead: set[int] = set()
            for place in frontier:
                if place not in beside:
                    keys = self._map.B_s.keys(self._map.rows_of(np.array([place])))
                    beside[place] = [after for after in set(keys.ravel().tolist()) if after >= 0]
                ahead.update(beside[place])
            frontier = ahead - known
            known |= frontier
        return np.array(sorted(known), dtype=np.int64)

    def likely(self, places: Ints) -> Ints:
        """`[n, K]` where each action most probably leads to; -1 where that is nowhere else, or not known."""
        return self._ways.column(2, places)

    def unseen(self) -> Floats:
        """`[N + 1]` what visits teach of the sights in a place never imagined."""
        told = (sensor.information_unseen(self.visits) for sensor in self._map.sights_sensed)
        return sum(told, np.zeros(self.visits + 1))

    def _new_ways(self, places: Ints) -> tuple[NDArray[np.generic], ...]:
        map_, size = self._map, len(self._map.motions)
        keys, alpha, _ = map_.B_s.concentration(map_.rows_of(places))
        keys, alpha = keys.reshape(len(places), size, -1), alpha.reshape(len(places), size, -1)
        p = alpha / alpha.sum(axis=2, keepdims=True)
        likely, blocked = likeliest(keys, p, places, ELSEWHERE)
        of_ways = map_.transitions.information(places, self.visits)
        return keys, p, likely, blocked, of_ways

    def _new_sights(self, places: Ints) -> tuple[NDArray[np.generic], ...]:
        map_, steps = self._map, self.visits
        told = (sensor.information(places, steps) for sensor in map_.sights_sensed)
        unknown = (np.nan,) * len(map_.motions.displacements[0])
        positions = [unknown if (at := map_.position(place)) is None else at for place in places.tolist()]
        position = np.array(positions, dtype=np.float64).reshape(len(places), -1)
        return map_.pose.information(places, steps), position, sum(told, np.zeros((len(places), steps + 1)))
