"""Links that never were: a way that was walked once led elsewhere than was thought, and the agent was moved besides."""

from collections.abc import Mapping
from math import log

from .branches import unseen
from .extending import shared, unlink, with_way
from .hypothesis import Hypothesis
from .rates import MOVED, UNDONE
from .weighing import rate_gain

Counts = Mapping[int, tuple[float, float]]  # Of each rate, how much oftener it was found true, and false


def straightened(h: Hypothesis, number: int, *, floor: float) -> Hypothesis | None:
    """The hypothesis in which a way of a place that was walked once leads to where a walk came from whose way back it
    is; None where that is below `floor`. On the one walk the agent was moved.
    """
    place, inverse = h.places[number], h.scheme.inverse
    if inverse is None:
        return None
    for index in h.awake:
        if (way := place.ways[index]).walks != 1:
            continue
        sources = sorted(source for source, by in place.into if inverse[by] == index and source != way.to)
        if not sources:
            continue
        back = h.places[way.to].ways[inverse[index]]
        crooked = len(sources) + (back.walks > 0 and back.to != number)
        counts = {MOVED: (1.0, -1.0), UNDONE: (0.0, -float(crooked))}
        gain = sum(rate_gain(h, rate, *more) for rate, more in counts.items()) - log(h.size + unseen(h))
        if h.weight + gain >= floor:
            return _cut(h, number, index, sources[0], gain, counts)
    return None


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
