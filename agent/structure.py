"""Hypotheses about the map as a planner asks them: what they would have the agent sense on its way."""

from collections.abc import Hashable, Iterator, Mapping, Sequence
from heapq import nlargest
from math import exp, sqrt

from ..inference import NOWHERE, Hypothesis, indistinguishable, open_probability

LEAST = 1e-5
"""Hypotheses less probable than this are not worth a way; they are asked where nothing else is to be done."""

MISREAD = 1e-3  # probability that a door is not as it was read from which on it is worth another look

DOORS = 7
"""Doors that are asked for at a time, at most."""

NEAREST = 200  # places around the agent whose doors are asked for, at most

Door = frozenset[tuple[int, int]]
"""A door by the (place, way) of its sides."""


class OpenQuestion:
    """The hypotheses that are worth telling apart; places go by the numbers of each.

    Args:
        hypotheses: all of them.
        ways: of actions, as hypotheses number them.
        doors_of: one of them of which it is asked besides, door by door, whether it was read right.
        tries: all that is left to do is to walk into walls, or what may be walls: what is hardly probable is worth a
            bump then, and hypotheses count by the roots of their probabilities.

    Attributes:
        weights: their probabilities.
        here: where the agent is in each.
    """

    def __init__(
        self,
        hypotheses: Sequence[Hypothesis],
        ways: Mapping[int, int],
        *,
        doors_of: Hypothesis | None = None,
        tries: bool = False,
    ) -> None:
        kept = [(weight, h, Door()) for weight, h in _different(hypotheses)]
        if doors_of is not None:
            doubtful, weight = nlargest(DOORS, _doubtful(doors_of), key=lambda found: found[0]), exp(doors_of.weight)
            kept += [(weight * p / (1.0 - p), doors_of, door) for p, door in doubtful]
        self._tries = tries
        self._kept, self._ways = [(h, misread) for _, h, misread in kept], ways
        self._ahead, self._expected = dict[tuple[int, int, int], int | None](), dict[tuple[int, int], Hashable]()
        self.weights: Sequence[float] = [sqrt(weight) if tries else weight for weight, _, _ in kept]
        self.here: Sequence[Hashable] = [h.here for _, h, _ in kept]
        awake = {way for _, h, _ in kept for way in h.awake}
        self.moves: Sequence[int] = [action for action, way in ways.items() if way in awake]

    def ahead(self, h: int, place: Hashable, action: int, /) -> Hashable | None:
        """The place that an action leads to; the same where its way is believed shut, None for one never seen."""
        key = h, _number(place), action
        if key not in self._ahead:
            self._ahead[key] = self._leads(*key)
        return self._ahead[key]

    def _leads(self, h: int, number: int, action: int) -> int | None:
        (found, _), way = self._kept[h], self._ways.get(action)
        if way is None or way not in found.awake:
            return number
        record = found.places[number]
        to = found.neighbour(record, way)
        if to == NOWHERE and not record.ways[way].net:
            return None  # nobody knows yet whether it leads anywhere
        if not self._open(h, number, way):
            return number
        return None if to == NOWHERE else to

    def _open(self, h: int, number: int, way: int) -> bool:
        found, misread = self._kept[h]
        return (open_probability(found, number, way) > 0.5) != ((number, way) in misread)

    def expected(self, h: int, place: Hashable, /) -> Hashable:
        """Its sights, and its ways as far as they were looked at."""
        key = h, _number(place)
        if key not in self._expected:
            self._expected[key] = self._shows(*key)
        return self._expected[key]

    def _shows(self, h: int, number: int) -> Hashable:
        found, _ = self._kept[h]
        record = found.places[number]
        read = {k: bool(record.ways[k].open or record.ways[k].blocked) for k in found.awake}
        looked = [self._open(h, number, k) if looked_at else None for k, looked_at in read.items()]
        return tuple(record.label(sensor) for sensor in range(found.scheme.sensors)), tuple(looked)


def _different(hypotheses: Sequence[Hypothesis]) -> Sequence[tuple[float, Hypothesis]]:
    """The hypotheses that some walk tells apart, each with the weight of all that it stands for."""
    kept = list[tuple[float, Hypothesis]]()
    for h in hypotheses:
        if (weight := exp(h.weight)) >= LEAST:
            same = next((k for k, (_, other) in enumerate(kept) if indistinguishable(h, other)), None)
            if same is None:
                kept.append((weight, h))
            else:
                kept[same] = kept[same][0] + weight, kept[same][1]
    return kept


def _doubtful(h: Hypothesis) -> Iterator[tuple[float, Door]]:
    """(P(it is not as it was read), the door), of each door that was looked at."""
    asked = set[tuple[int, int]]()
    for number in _around(h):
        record = h.places[number]
        for way in h.awake:
            known = record.ways[way]
            if (number, way) in asked or not (known.open or known.blocked):
                continue
            door = _sides(h, number, way)
            asked |= door
            p = open_probability(h, number, way)
            if min(p, 1.0 - p) >= MISREAD:
                yield min(p, 1.0 - p), door


def _around(h: Hypothesis) -> Sequence[int]:
    """The places nearest to the agent's, itself included."""
    found = [h.here]
    for number in found:
        record = h.places[number]
        beyond = (h.neighbour(record, way) for way in h.awake)
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
