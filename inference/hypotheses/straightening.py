"""Links that never were: a walk off the chart was a silent move, where the other side confirms the chart."""

from __future__ import annotations

from math import log

from .extending import shared, unlink, with_way
from .hypothesis import Hypothesis
from .rates import ELSEWHERE, MOVED, UNDONE
from .records import NOWHERE, Place, Way
from .weighing import rate_gain


def straightened(h: Hypothesis, number: int, *, floor: float) -> Hypothesis | None:
    """The hypothesis in which a way of a place leads where its chart says; None where that is below `floor`.

    Such a way was walked once, to another place than that beside it, from which it was walked back to here.
    """
    place = h.places[number]
    for index, way in enumerate(place.ways):
        beside = _beside(h, number, place, index) if way.walks == 1 else NOWHERE
        if beside in (NOWHERE, way.to):
            continue
        gain = rate_gain(h, MOVED, 1.0, -1.0) + rate_gain(h, ELSEWHERE, -1.0, 1.0) + rate_gain(h, UNDONE, 1.0, -1.0)
        gain += log((h.size + 1.0) / h.size)
        if h.weight + gain >= floor:
            return _cut(h, number, index, beside, gain)
    return None


def _beside(h: Hypothesis, number: int, place: Place, index: int) -> int:
    """The place beyond a way on the chart, if its way back was found to lead here."""
    beside = h.beside(place, index)
    if beside == NOWHERE or h.scheme.inverse is None:
        return NOWHERE
    back = h.places[beside].ways[h.scheme.inverse[index]]
    return beside if back.walks and back.to == number else NOWHERE


def _cut(h: Hypothesis, number: int, index: int, beside: int, gain: float) -> Hypothesis:
    other = h.fork()
    other.weight = h.weight + gain
    way = other.places[number].ways[index]
    unlink(other, number, index, way)
    place = with_way(other.places[number], index, Way(way.net, way.open, way.blocked, 0, beside))
    other.put(number, shared(other, number, place))
    other.links -= 1
    for rate, yes, no in ((MOVED, 1.0, -1.0), (ELSEWHERE, -1.0, 1.0), (UNDONE, 1.0, -1.0)):
        other.counts.yes[rate] = max(other.counts.yes[rate] + yes, 0.0)
        other.counts.no[rate] = max(other.counts.no[rate] + no, 0.0)
    return other
