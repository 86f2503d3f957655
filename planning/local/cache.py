"""What plans read of each place of a map, kept from step to step until the map has changed there."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ...model import ELSEWHERE, CogmapError
from ..information import dirichlet_information
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
        sights: `[n, N + 1]` nats that visits teach of A_o.
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
        self._outcomes = 0

    def check(self, map_: MapView, look_ahead: int) -> None:
        """Raise `CogmapError` unless it is of this map, and tells of enough visits for this look-ahead."""
        if self._map is not map_:
            raise CogmapError("local cache: it is of another map; make one with LocalCache(map, look_ahead)")
        if self.visits < look_ahead:
            raise CogmapError(f"local cache: it tells of {self.visits} visits; make one for {look_ahead}")

    def refresh(self) -> None:
        """Forget what has changed since the last call."""
        map_, read = self._map, self._read
        ways, _ = map_.changed_places(read, map_.B_s, map_.A_p, map_.visits)
        sights, self._read = map_.changed_places(read, map_.A_o)
        self._ways.forget(ways)
        if ways is None:
            self._beside.clear()
        for place in ways or ():
            self._beside.pop(place, None)
        self._sights.forget(sights if map_.A_o.outcomes == self._outcomes else None)
        self._outcomes = map_.A_o.outcomes

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
        """`[N + 1]` what visits teach of A_o in a place never imagined."""
        return _row_information(np.array([self._map.A_o.background, self._map.A_o.outcomes]).tobytes(), self.visits)

    def _new_ways(self, places: Ints) -> tuple[NDArray[np.generic], ...]:
        map_, size = self._map, len(self._map.motions)
        keys, alpha, _ = map_.B_s.concentration(map_.rows_of(places))
        keys, alpha = keys.reshape(len(places), size, -1), alpha.reshape(len(places), size, -1)
        p = alpha / alpha.sum(axis=2, keepdims=True)
        likely, blocked = likeliest(keys, p, places, ELSEWHERE)
        # a look teaches nothing where a visit has shown all it can, and no place lies beyond
        shown = map_.visited[places][:, None] & (keys == ELSEWHERE).any(axis=2)
        of_ways = (_information(alpha, self.visits) * ~shown[..., None]).sum(axis=1)
        of_positions = _information(map_.A_p.concentration(places)[1], self.visits)
        unknown = (np.nan,) * len(map_.motions.displacements[0])
        positions = [unknown if (at := map_.position(place)) is None else at for place in places.tolist()]
        position = np.array(positions, dtype=np.float64).reshape(len(places), -1)
        return keys, p, likely, blocked, of_ways, of_positions, position

    def _new_sights(self, places: Ints) -> tuple[NDArray[np.generic], ...]:
        _, alpha, others = self._map.A_o.concentration(places)
        slots = alpha.shape[1]
        alpha = np.concatenate([alpha, np.full((len(places), 1), self._map.A_o.background)], axis=1)
        many = np.ones((len(places), slots + 1))
        many[:, -1] = others
        return (_information(alpha, self.visits, many),)


def _information(alpha: Floats, steps: int, multiplicity: Floats | None = None) -> Floats:
    """`dirichlet_information` of `[..., O]` concentrations; rows met before are looked up."""
    outcomes = alpha.shape[-1]
    if outcomes == 1 and multiplicity is None:  # one outcome teaches nothing
        return np.zeros((*alpha.shape[:-1], steps + 1))
    many = np.ones_like(alpha) if multiplicity is None else multiplicity
    packed = np.concatenate([alpha, many], axis=-1).tobytes()
    width = 16 * outcomes
    table = [_row_information(packed[i : i + width], steps) for i in range(0, len(packed), width)]
    return np.array(table).reshape(*alpha.shape[:-1], steps + 1)


@lru_cache(maxsize=1 << 14)
def _row_information(packed: bytes, steps: int) -> Floats:
    """One row: its concentrations, then their multiplicities."""
    both = np.frombuffer(packed).reshape(2, -1)
    alpha, many = both[:, both[0] > 0.0]  # to the bit the same, however many slots are unused
    if many.sum() <= 1.0:  # one outcome teaches nothing
        return np.zeros(steps + 1)
    return dirichlet_information(alpha, steps, multiplicity=many)
