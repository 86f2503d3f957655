"""Links that never were: a way that was walked once led elsewhere than was thought, and the agent was moved besides."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import log

from .extending import shared, unlink, with_way
from .hypothesis import Hypothesis
from .rates import ELSEWHERE, MOVED, UNDONE
from .records import NOWHERE, Place
from .weighing import rate_gain

Counts = Mapping[int, tuple[float, float]]
"""Of each rate, how much oftener it was found true, and false."""


def straightened(h: Hypothesis, number: int, *, floor: float) -> Hypothesis | None:
    """The hypothesis in which a way of a place that was walked once leads elsewhere; None where that is below `floor`.

    It leads where the chart says, if the way back from there was walked; or to where a walk came from whose way back it
    is. On the one walk the agent was moved.
    """
    place = h.places[number]
    for index, way in enumerate(place.ways):
        if way.walks != 1 or h.scheme.inverse is None:
            continue
        for to, counts, cost in _others(h, number, place, index):
            gain = sum(rate_gain(h, rate, *more) for rate, more in counts.items()) - cost
            if h.weight + gain >= floor:
                return _cut(h, number, index, to, gain, counts)
    return None


def _others(h: Hypothesis, number: int, place: Place, index: int) -> Iterator[tuple[int, Counts, float]]:
    """(place, counts, nats besides) of where else a way may lead."""
    way, beside = place.ways[index], _beside(h, number, place, index)
    if beside not in (NOWHERE, way.to):
        yield (
            beside,
            {MOVED: (1.0, -1.0), ELSEWHERE: (-1.0, 1.0), UNDONE: (1.0, -1.0)},
            log(h.size / (h.size + 1.0)),
        )
        return
    assert h.scheme.inverse is not None
    back = h.places[way.to].ways[h.scheme.inverse[index]]
    sources = sorted(source for source, by in place.into if h.scheme.inverse[by] == index and source != way.to)
    crooked = len(sources) + (back.walks > 0 and back.to != number)
    for source in sources:
        yield source, {MOVED: (1.0, -1.0), UNDONE: (0.0, -float(crooked))}, log(2.0)


def _beside(h: Hypothesis, number: int, place: Place, index: int) -> int:
    """The place beyond a way on the chart, if its way back was found to lead here."""
    beside = h.beside(place, index)
    if beside == NOWHERE or h.scheme.inverse is None:
        return NOWHERE
    back = h.places[beside].ways[h.scheme.inverse[index]]
    return beside if back.walks and back.to == number else NOWHERE


def _cut(h: Hypothesis, number: int, index: int, to: int, gain: float, counts: Counts) -> Hypothesis:
    other = h.fork()
    other.weight = h.weight + gain
    way = other.places[number].ways[index]
    unlink(other, number, index, way)
    place = with_way(other.places[number], index, way._replace(walks=0, to=to))
    other.put(number, shared(other, number, place))
    other.links -= 1
    for rate, (yes, no) in counts.items():
        other.counts.yes[rate] = max(other.counts.yes[rate] + yes, 0.0)
        other.counts.no[rate] = max(other.counts.no[rate] + no, 0.0)
    return other
