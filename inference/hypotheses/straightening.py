"""Links that never were: a way that was walked once led elsewhere than was thought, and the agent was moved besides."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import log

from .extending import shared, unlink, with_way
from .hypothesis import Hypothesis
from .rates import ELSEWHERE, MOVED, UNDONE
from .records import NOWHERE, Place, Way
from .weighing import door_evidence, rate_gain

Counts = Mapping[int, tuple[float, float]]
"""Of each rate, how much oftener it was found true, and false."""


def straightened(h: Hypothesis, number: int, *, floor: float) -> Hypothesis | None:
    """The hypothesis in which a way of a place that was walked once leads elsewhere; None where that is below `floor`.

    It leads where the chart says, or to where a walk came from whose way back it is. On the one walk the agent was
    moved.
    """
    place = h.places[number]
    for index, way in enumerate(place.ways):
        if way.walks != 1 or h.scheme.inverse is None:
            continue
        for to, counts, gain in _others(h, number, place, index):
            gain += sum(rate_gain(h, rate, *more) for rate, more in counts.items())
            if h.weight + gain >= floor:
                return _cut(h, number, index, to, gain, counts)
    return None


def _others(h: Hypothesis, number: int, place: Place, index: int) -> Iterator[tuple[int, Counts, float]]:
    """(place, counts, nats besides) of where else a way may lead."""
    assert h.scheme.inverse is not None
    way, inverse = place.ways[index], h.scheme.inverse
    back = h.places[way.to].ways[inverse[index]]
    crooked = float(back.walks > 0 and back.to != number)
    if h.beyond(place, index) not in (None, (h.places[way.to].frame, h.places[way.to].position)):
        if not back.walks or crooked:
            yield from _on_chart(h, number, place, index, crooked)
        return
    sources = sorted(source for source, by in place.into if inverse[by] == index and source != way.to)
    for source in sources:
        yield source, {MOVED: (1.0, -1.0), UNDONE: (0.0, -crooked - len(sources))}, -log(2.0)


def _on_chart(
    h: Hypothesis, number: int, place: Place, index: int, crooked: float
) -> Iterator[tuple[int, Counts, float]]:
    """Where the chart says, if nothing is known of the way back from there, or it leads here."""
    assert h.scheme.inverse is not None
    way, beside = place.ways[index], h.beside(place, index)
    side = Way() if beside == NOWHERE else h.places[beside].ways[h.scheme.inverse[index]]
    if side.to not in (NOWHERE, number):
        return
    led_back = float(side.walks > 0)
    counts = {MOVED: (1.0, -1.0), ELSEWHERE: (-1.0, 0.0), UNDONE: (led_back, -led_back - crooked)}
    far, open_ = h.places[way.to].ways[h.scheme.inverse[index]].net * (not crooked), h.open(index)
    doors = ((way.net, side.net), (far, 0.0)), ((way.net, far), (side.net, 0.0))
    after, before = (sum(door_evidence(h.chances, *nets, open_=open_) for nets in sides) for sides in doors)
    yield beside if led_back else NOWHERE, counts, after - before + log((h.size + 1.0) / h.size)


def _cut(h: Hypothesis, number: int, index: int, to: int, gain: float, counts: Counts) -> Hypothesis:
    other = h.fork()
    other.weight = h.weight + gain
    way = other.places[number].ways[index]
    unlink(other, number, index, way)
    place = with_way(other.places[number], index, Way(way.net, way.open, way.blocked, 0, to))
    other.put(number, shared(other, number, place))
    other.links -= 1
    for rate, (yes, no) in counts.items():
        other.counts.yes[rate] = max(other.counts.yes[rate] + yes, 0.0)
        other.counts.no[rate] = max(other.counts.no[rate] + no, 0.0)
    return other
