"""Hypotheses about the map as a planner asks them: what they would have the agent sense on its way."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from math import exp

from ..inference import NOWHERE, Hypothesis, open_probability

LEAST = 1e-5
"""Hypotheses less probable than this are not worth a way; they are asked where nothing else is to be done."""


class OpenQuestion:
    """The hypotheses that are worth telling apart; places go by the numbers of each.

    Of those whose maps look the same (they differ in poses, if in anything) the most probable stands for all.

    Attributes:
        weights: their probabilities.
        here: where the agent is in each.
    """

    def __init__(self, hypotheses: Sequence[Hypothesis], ways: Mapping[int, int]) -> None:
        self._kept, alike = list[Hypothesis](), dict[tuple[int, int], float]()
        for h in hypotheses:
            key, p = (h.digest, h.here), exp(h.weight)
            if p >= LEAST and key not in alike:
                self._kept.append(h)
            alike[key] = alike.get(key, 0.0) + p
        self._ways = ways
        self._ahead, self._expected = dict[tuple[int, int, int], int | None](), dict[tuple[int, int], Hashable]()
        self.weights: Sequence[float] = [alike[h.digest, h.here] for h in self._kept]
        self.here: Sequence[Hashable] = [h.here for h in self._kept]

    def ahead(self, h: int, place: Hashable, action: int, /) -> Hashable | None:
        """The place that an action leads to; the same where its way is believed shut, None for one never seen."""
        key = h, _number(place), action
        if key not in self._ahead:
            self._ahead[key] = self._leads(*key)
        return self._ahead[key]

    def _leads(self, h: int, number: int, action: int) -> int | None:
        found, way = self._kept[h], self._ways.get(action)
        if way is None or open_probability(found, number, way) < 0.5:
            return number
        to = found.neighbour(found.places[number], way)
        return None if to == NOWHERE else to

    def expected(self, h: int, place: Hashable, /) -> Hashable:
        """Its sights, and its ways as far as they were looked at."""
        key = h, _number(place)
        if key not in self._expected:
            self._expected[key] = self._shows(*key)
        return self._expected[key]

    def _shows(self, h: int, number: int) -> Hashable:
        found = self._kept[h]
        record = found.places[number]
        looked = [
            None if not (way.open or way.blocked) else open_probability(found, number, k) > 0.5
            for k, way in enumerate(record.ways)
        ]
        return tuple(record.label(sensor) for sensor in range(found.scheme.sensors)), tuple(looked)


def _number(place: Hashable) -> int:
    assert isinstance(place, int)
    return place
