"""What plans read of each place of a map, kept from step to step until the map has changed there."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..model import ELSEWHERE, CognitiveMap
from ..model.errors import CogmapError
from .information import dirichlet_information
from .kept import Kept
from .transitions import Floats, Ints, likeliest


@dataclass(frozen=True, slots=True)
class Doors:
    """The doors of `n` places.

    Attributes:
        successors: `[n, K, slots]` where each action may lead to.
        probability: `[n, K, slots]` of each, zero where a slot is unused.
        likely: `[n, K]` where it most probably leads to besides the place itself; see `likeliest`.
        blocked: `[n, K]` P(staying | s, a).
    """

    successors: Ints
    probability: Floats
    likely: Ints
    blocked: Floats

    @classmethod
    def of(cls, places: Ints, successors: Ints, probability: Floats) -> Doors:
        """The doors that have these successors."""
        likely, blocked = likeliest(successors, probability, places, ELSEWHERE)
        return cls(successors, probability, likely, blocked)


class Outlook:
    """What plans read of the places of one map. Costs what has changed and what is asked for.

    Args:
        map_: the map.
        steps: visits, at most, that plans ask the information of: N.
    """

    __slots__ = ("_doors", "_map", "_outcomes", "_read", "_sights", "steps")

    def __init__(self, map_: CognitiveMap, steps: int) -> None:
        self.steps = steps
        self._map = map_
        self._doors, self._sights = Kept(self._new_doors), Kept(self._new_sights)
        self._read = -1  # of the log of changes
        self._outcomes = 0

    def check(self, map_: CognitiveMap, look_ahead: int) -> None:
        """Raise `CogmapError` unless it is of this map, and tells of enough visits for this look-ahead."""
        if self._map is not map_:
            raise CogmapError("outlook: it is of another map; make one with Outlook(map, look_ahead)")
        if self.steps < look_ahead:
            raise CogmapError(f"outlook: it tells of {self.steps} visits; make one for {look_ahead}")

    def refresh(self) -> None:
        """Forget what has changed since the last call."""
        map_, read = self._map, self._read
        of_doors, _ = map_.changed_places(read, map_.B_s, map_.visits)
        of_sights, self._read = map_.changed_places(read, map_.A_o, map_.A_p)
        self._doors.forget(of_doors)
        self._sights.forget(of_sights if map_.A_o.outcomes == self._outcomes else None)
        self._outcomes = map_.A_o.outcomes

    def doors(self, places: Ints) -> tuple[Doors, Floats]:
        """The doors of `places`, and what looks at them teach of B_s: `[n, N + 1]` nats."""
        successors, probability, likely, blocked, information = self._doors.rows(places)
        return Doors(successors, probability, likely, blocked), information

    def ways(self, places: Ints) -> Ints:
        """`[n, K]` where each action most probably leads to; -1 where that is nowhere else, or not known."""
        return self._doors.row_of(2, places)

    def sights(self, places: Ints) -> tuple[Floats, Floats]:
        """What visits teach of A_o and of A_p, `[n, N + 1]` nats each."""
        of_sights, of_positions = self._sights.rows(places)
        return of_sights, of_positions

    def _new_doors(self, places: Ints) -> tuple[NDArray[np.generic], ...]:
        size = len(self._map.motions)
        keys, alpha, _ = self._map.B_s.concentration(self._map.rows_of(places))
        keys, alpha = keys.reshape(len(places), size, -1), alpha.reshape(len(places), size, -1)
        doors = Doors.of(places, keys, alpha / alpha.sum(axis=2, keepdims=True))
        # a look teaches nothing where a visit has shown all it can, and no place lies beyond
        told = self._map.visited[places][:, None] & (keys == ELSEWHERE).any(axis=2)
        information = (_information(alpha, self.steps) * ~told[..., None]).sum(axis=1)
        return doors.successors, doors.probability, doors.likely, doors.blocked, information

    def _new_sights(self, places: Ints) -> tuple[NDArray[np.generic], ...]:
        _, alpha, others = self._map.A_o.concentration(places)
        told = alpha.shape[1]
        alpha = np.concatenate([alpha, np.full((len(places), 1), self._map.A_o.background)], axis=1)
        many = np.ones((len(places), told + 1))
        many[:, -1] = others
        of_positions = _information(self._map.A_p.concentration(places)[1], self.steps)
        return _information(alpha, self.steps, many), of_positions

    def unseen(self) -> Floats:
        """`[N + 1]` what visits teach of A_o in a place never imagined."""
        return _row_information(np.array([self._map.A_o.background, self._map.A_o.outcomes]).tobytes(), self.steps)


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
