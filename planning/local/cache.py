"""What plans read of each place of a map, kept from step to step until the map has changed there."""

from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...model import ELSEWHERE, CogmapError
from .doubts import Doubts
from .kept import Kept
from .rows import Rows
from .transitions import Floats, Ints, Transitions, likeliest
from .view import MapView
from .where import Where

CUTS = 64  # cuts of the map that are kept, at most

Key = tuple[bytes, bytes, tuple[bool, ...], tuple[bool, ...]]
"""Of a cut: the places that the agent may be in, those that are in it, what is sensed of the ways, and of which not."""


@dataclass(frozen=True, slots=True)
class WayRows:
    """What plans read of the ways of `n` places."""

    successors: Ints  # `[n, K, slots]` where each action may lead to
    probability: Floats  # `[n, K, slots]` of each, zero where a slot is unused
    likely: Ints  # `[n, K]` where it most probably leads to besides the place itself; see `likeliest`
    blocked: Floats  # `[n, K]` P(staying | s, a)
    ways: Floats  # `[n, N + 1]` nats that visits teach of B_s by their ways


@dataclass(frozen=True, slots=True)
class SightRows:
    """What plans read of the sights and positions of `n` places."""

    positions: Floats  # `[n, N + 1]` nats that visits teach of A_p
    position: Floats  # `[n, D]` where each place is; NaN where nobody knows
    sights: Floats  # `[n, N + 1]` nats that visits teach of the sights


@dataclass(frozen=True, slots=True)
class Cut:
    """What a local model has of ways, local numbers throughout; it stays as it is until the ways of the map change."""

    places: Ints  # `[R]` places of the map, -1 the last
    at: Ints  # where among them the agent may be
    entered: NDArray[np.bool_]  # `[R]` whether the agent was ever there
    B: Transitions  # P(s' | s, a)
    successor: Ints  # `[R, K]` the place each action most probably leads to, or -1
    blocked: Floats  # `[R, K]` P(blocked | s, a)
    ways: Floats  # `[R, N + 1]` nats that visits teach of B_s
    untried: Floats | None  # `[R, K]` nats that the first step along each way teaches; None where all are zero
    kept: Kept  # what others worked out of these alone, to be found again


class LocalCache:
    """A cache of what plans read of a map. It costs only what has changed and what is asked for.

    Args:
        map_: the map.
        visits: visits, at most, that plans ask the information of: N.

    Attributes:
        links: how often it has changed where a way most probably leads.
        found: what a search of the map found last, for the next one to go on from.
        where: where its places are.
        doubts: which ways are only thought to lead where they do.
    """

    __slots__ = (
        "_beside",
        "_cuts",
        "_map",
        "_outcomes",
        "_read",
        "_sights",
        "_tries",
        "_unasked",
        "_unseen",
        "_untried",
        "_ways",
        "doubts",
        "found",
        "links",
        "visits",
        "where",
    )

    def __init__(self, map_: MapView, visits: int) -> None:
        self.visits = visits
        self._map = map_
        self._ways, self._sights, self._tries = Rows(self._new_ways), Rows(self._new_sights), Rows(self._new_tries)
        self._beside: dict[int, list[int]] = {}  # where each place may lead to
        self._read = -1  # of the log of changes
        self._outcomes: list[int] = []
        self._cuts: dict[Key, Cut] = {}
        self._unseen: Floats | None = None
        self.links = 0
        self.found: Any = None
        self.where, self.doubts = Where(map_), Doubts(map_)
        self._untried: dict[int, float] = {}
        self._unasked: set[int] | None = None  # what has changed since somebody asked for it; None for all

    def check(self, map_: MapView, look_ahead: int) -> None:
        """Raise `CogmapError` unless it is of this map, and tells of enough visits for this look-ahead."""
        if self._map is not map_:
            raise CogmapError("local cache: it is of another map; make one with LocalCache(map, look_ahead)")
        if self.visits < look_ahead:
            raise CogmapError(f"local cache: it tells of {self.visits} visits; make one for {look_ahead}")

    def refresh(self) -> None:
        """Forget what has changed since the last call."""
        map_, read = self._map, self._read
        ways, _ = map_.changed_places(read, map_.B_s, map_.visits, map_.transitions.walked)
        tables = [sensor.table for sensor in map_.sights_sensed]
        sights, self._read = map_.changed_places(read, map_.A_p, *tables)
        self._forget_ways(ways)
        self._tries.forget(ways)
        self._unasked = None if ways is None or self._unasked is None else self._unasked.union(ways)
        outcomes = [table.outcomes for table in tables]
        if outcomes != self._outcomes:
            sights, self._unseen = None, None
        self._sights.forget(sights)
        self._outcomes = outcomes

    @property
    def untried(self) -> dict[int, float]:
        """The most that a step along a way teaches, by place, where that is anything."""
        map_, many, changed = self._map, len(self._map.places), self._unasked
        if changed is None:
            self._untried, changed = {}, range(many)
        for place in changed:
            self._untried.pop(place, None)
        places = np.array([place for place in changed if place < many and map_.visited[place]], dtype=np.int64)
        most = map_.transitions.untried(places).max(axis=1, initial=0.0)
        self._untried |= {place: nats for place, nats in zip(places.tolist(), most.tolist(), strict=True) if nats}
        self._unasked = set()
        return self._untried

    def _forget_ways(self, places: Collection[int] | None) -> None:
        """What is known of the ways of these places, or of all."""
        if places is None:
            self._ways.forget()
            self._beside.clear()
            self._cuts.clear()
            self.links += 1
        elif places:
            known, last = self._ways.known(places), len(self._map.places)
            before, gone = self._ways.column(2, known), (known >= last).any()
            self._ways.forget(places)
            for place in places:
                self._beside.pop(place, None)
            self._cuts.clear()
            self.links += bool(gone) or not np.array_equal(before, self._ways.column(2, known))

    def ways(self, places: Ints) -> WayRows:
        """Of these places, and a row of zeros at the end."""
        return WayRows(*self._ways.columns(places))

    def tries(self, places: Ints) -> Floats:
        """`[n + 1, K]` nats that the first step along each way teaches, with a row of zeros at the end."""
        return self._tries.columns(places)[0]

    def sights(self, places: Ints) -> SightRows:
        """Of these places, and a row of zeros at the end."""
        return SightRows(*self._sights.columns(places))

    def cut(self, key: Key, make: Callable[[], Cut]) -> Cut:
        """The cut of this key, made anew if the ways of the map have changed since."""
        cut = self._cuts.pop(key, None) or make()
        self._cuts[key] = cut  # the last that was asked for is the last
        if len(self._cuts) > CUTS:
            del self._cuts[next(iter(self._cuts))]
        return cut

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

    def looks(self, place: int, action: int) -> Floats:
        """`[N + 1]` what visits teach of one way."""
        return self._map.transitions.looks(place, action, self.visits)

    def unseen(self) -> Floats:
        """`[N + 1]` what visits teach of the sights in a place never imagined."""
        if self._unseen is None:
            told = (sensor.information_unseen(self.visits) for sensor in self._map.sights_sensed)
            self._unseen = sum(told, np.zeros(self.visits + 1))
        return self._unseen

    def _new_ways(self, places: Ints) -> tuple[NDArray[np.generic], ...]:
        map_, size = self._map, len(self._map.motions)
        keys, alpha, _ = map_.B_s.concentration(map_.rows_of(places))
        keys, alpha = keys.reshape(len(places), size, -1), alpha.reshape(len(places), size, -1)
        p = alpha / alpha.sum(axis=2, keepdims=True)
        likely, blocked = likeliest(keys, p, places, ELSEWHERE)
        return keys, p, likely, blocked, map_.transitions.information(places, self.visits)

    def _new_tries(self, places: Ints) -> tuple[NDArray[np.generic], ...]:
        return (self._map.transitions.untried(places),)

    def _new_sights(self, places: Ints) -> tuple[NDArray[np.generic], ...]:
        map_, steps = self._map, self.visits
        told = (sensor.information(places, steps) for sensor in map_.sights_sensed)
        unknown = (np.nan,) * map_.pose.dimensions
        positions = [unknown if (at := map_.position(place)) is None else at for place in places.tolist()]
        position = np.array(positions, dtype=np.float64).reshape(len(places), -1)
        return map_.pose.information(places, steps), position, sum(told, np.zeros((len(places), steps + 1)))
