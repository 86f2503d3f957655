"""Hypotheses about the map as a planner asks them: what they would have the agent sense on its way."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping, Sequence
from heapq import nlargest
from math import exp

from ..inference import NOWHERE, Hypothesis, open_probability

LEAST = 1e-2
"""Hypotheses less probable than this are not worth a way."""

DOORS = 7
"""Doors that are asked for at a time, at most."""

NEAREST = 200
"""Places around the agent whose doors are asked for, at most."""

Door = frozenset[tuple[int, int]]
"""A door by the (place, way) of its sides."""


class OpenQuestion:
    """The hypotheses that are worth telling apart; places go by the numbers of each.

    Attributes:
        weights: their probabilities.
        here: where the agent is in each.
    """

    def __init__(self, hypotheses: Sequence[Hypothesis], ways: Mapping[int, int]) -> None:
        kept = [(exp(h.weight), h, Door()) for h in hypotheses if exp(h.weight) >= LEAST]
        self._begin(kept, ways)

    @classmethod
    def of_doors(cls, h: Hypothesis, ways: Mapping[int, int]) -> OpenQuestion | None:
        """Whether the doors of one hypothesis were read right, each for itself; None where that is hardly in doubt."""
        kept = [(p / (1.0 - p), h, door) for p, door in nlargest(DOORS, _doubtful(h), key=lambda found: found[0])]
        if not kept:
            return None
        question = cls.__new__(cls)
        question._begin([(1.0, h, Door()), *kept], ways)
        return question

    def _begin(self, kept: Sequence[tuple[float, Hypothesis, Door]], ways: Mapping[int, int]) -> None:
        self._kept, self._ways = [(h, misread) for _, h, misread in kept], ways
        self.weights: Sequence[float] = [weight for weight, _, _ in kept]
        self.here: Sequence[Hashable] = [h.here for _, h, _ in kept]

    def _open(self, h: int, number: int, way: int) -> bool:
        found, misread = self._kept[h]
        return (open_probability(found, number, way) > 0.5) != ((number, way) in misread)

    def ahead(self, h: int, place: Hashable, action: int, /) -> Hashable | None:
        """The place that an action leads to; the same where its way is believed shut, None for one never seen."""
        (found, _), number, way = self._kept[h], _number(place), self._ways.get(action)
        if way is None or not self._open(h, number, way):
            return number
        to = found.neighbour(found.places[number], way)
        return None if to == NOWHERE else to

    def expected(self, h: int, place: Hashable, /) -> Hashable:
        """Its sights, and its ways as far as they were looked at."""
        (found, _), number = self._kept[h], _number(place)
        record = found.places[number]
        looked = [
            None if not (way.open or way.blocked) else self._open(h, number, k) for k, way in enumerate(record.ways)
        ]
        return tuple(record.label(sensor) for sensor in range(found.scheme.sensors)), tuple(looked)


def _doubtful(h: Hypothesis) -> Iterator[tuple[float, Door]]:
    """(P(it is not as it was read), the door), of each door that was looked at."""
    asked = set[tuple[int, int]]()
    for number in _around(h):
        record = h.places[number]
        for way, known in enumerate(record.ways):
            if (number, way) in asked or not (known.open or known.blocked):
                continue
            door = _sides(h, number, way)
            asked |= door
            p = open_probability(h, number, way)
            if min(p, 1.0 - p) >= LEAST:
                yield min(p, 1.0 - p), door


def _around(h: Hypothesis) -> Sequence[int]:
    """The places nearest to the agent's, itself included."""
    found = [h.here]
    for number in found:
        record = h.places[number]
        beyond = (h.neighbour(record, way) for way in range(h.scheme.count))
        found += dict.fromkeys(to for to in beyond if to != NOWHERE and to not in found)
        if len(found) >= NEAREST:
            break
    return found[:NEAREST]


def _sides(h: Hypothesis, number: int, way: int) -> Door:
    other = h.neighbour(h.places[number], way)
    if other == NOWHERE or h.scheme.inverse is None:
        return Door({(number, way)})
    return Door({(number, way), (other, h.scheme.inverse[way])})


def _number(place: Hashable) -> int:
    assert isinstance(place, int)
    return place
