"""How much more probable a union makes what was found: sights, doors, links, and how many places there are."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from math import lgamma, log
from operator import itemgetter
from typing import NamedTuple

from .evidence import before_reading, both_sides
from .hypothesis import Hypothesis
from .rates import ELSEWHERE, MEETING, NEW, RATE_PRIORS, SQUARE, UNDONE, crp_evidence
from .records import NOWHERE, Place
from .squares import around, tally
from .uniting import Union

FACTOR = 0.6  # Share of the places, on average, among which a loop that closes had to choose while the map grew


class Links(NamedTuple):
    """Ways between places: how many, how many of them off the chart, that do not lead back, that meet.

    Those off the chart of which a way back says no more are `astray`. Without poses, how many squares close, and do
    not.
    """

    ways: int
    off: int
    crooked: int
    meeting: int
    astray: int = 0
    square: float = 0.0
    open_square: float = 0.0

    def less(self, other: Links) -> Links:
        """The difference."""
        a, b = self, other
        counts = a.ways - b.ways, a.off - b.off, a.crooked - b.crooked, a.meeting - b.meeting, a.astray - b.astray
        return Links(*counts, a.square - b.square, a.open_square - b.open_square)


def scored(united: Union) -> tuple[float, Links]:
    """log P(united) - log P(apart), readings and structure; and the difference in links."""
    h = united.h
    more = _links(united, apart=False).less(_links(united, apart=True))
    gain = united.sights - united.cost + _seating_gain(united)
    gain += _united_doors(united, apart=False) - _united_doors(united, apart=True)
    gain += _structure_gain(united, more)
    gain += rate_gain(h, UNDONE, 0, more.crooked)
    if h.scheme.inverse is None:
        gain += rate_gain(h, MEETING, more.meeting, more.ways - more.meeting)
    if united.charts.joined > 1:
        gain -= log(h.size + 1.0)
    return gain, more


def _structure_gain(united: Union, more: Links) -> float:
    h = united.h
    fewer = len(set(united.gone()))
    if h.scheme.displacements is not None:
        off = more.off + (united.charts.periods is not None)
        gain = rate_gain(h, ELSEWHERE, off - more.astray, more.ways - more.off)
        return gain - off * log(h.size - fewer + 1.0)
    squares = max(h.counts.yes[SQUARE], 0.0)
    closed = max(h.links - h.size + 1 - squares, 0.0)
    closed_after = max(h.links + more.ways - h.size + fewer + 1 - squares - more.square, 0.0)
    gain = rate_gain(h, NEW, -fewer, closed_after - max(h.counts.no[NEW], 0.0))
    gain += rate_gain(h, SQUARE, more.square, more.open_square)
    return gain - closed_after * log(max(FACTOR * (h.size - fewer), 1.0)) + closed * log(max(FACTOR * h.size, 1.0))


def rate_gain(h: Hypothesis, rate: int, yes: float, no: float) -> float:
    """What more counts of a rate do to its evidence."""
    prior, n_yes, n_no = RATE_PRIORS[rate], max(h.counts.yes[rate], 0.0), max(h.counts.no[rate], 0.0)
    return prior.log_evidence(max(n_yes + yes, 0.0), max(n_no + no, 0.0)) - prior.log_evidence(n_yes, n_no)


def _seating_gain(united: Union) -> float:
    labels = [[p.label(sensor) for p in united.classes.values()] for sensor in range(united.h.scheme.sensors)]
    return seating(united.h, removed=united.members(), added=labels)


def seating(h: Hypothesis, *, removed: Collection[int], added: Sequence[Sequence[int]] | None = None) -> float:
    """What it does to the Chinese restaurant processes that some places do not show what they show, and others do.

    Args:
        h: the hypothesis.
        removed: places.
        added: labels of places that are there instead, a sensor each.
    """
    gain = 0.0
    for sensor in range(h.scheme.sensors):
        new = added[sensor] if added else ()
        tables: dict[int, int] = {}
        for label, more in [*((h.places[k].label(sensor), -1) for k in removed), *((label, 1) for label in new)]:
            tables[label] = tables.get(label, 0) + more
        kinds = h.kinds[sensor]
        after = kinds
        for label, more in tables.items():
            before = len(h.shown.get((sensor, label)) or ())
            gain += lgamma(max(before + more, 1)) - lgamma(max(before, 1))
            after += (before + more > 0) - (before > 0)
        gain += crp_evidence(after, h.size - len(removed) + len(new)) - crp_evidence(kinds, h.size)
    return gain


def _links(united: Union, *, apart: bool) -> Links:
    """The links of the places concerned, each once, before and after."""
    h = united.h
    find = _itself if apart else united.find
    view = h.places.__getitem__ if apart else united.view
    inverse = h.scheme.inverse
    keys: dict[tuple[int, int], int] = {}
    meeting = 0
    for number in united.members() if apart else united.classes:
        place = view(number)
        for index in h.awake:
            way = place.ways[index]
            if way.to != NOWHERE:
                keys[number, index] = find(way.to)
        sources = {(find(source), index) for source, index in place.into}
        for source, index in sources:
            keys[source, index] = number
        meeting += len(sources) - len({index for _, index in sources})
    count = off = crooked = astray = 0
    for (number, index), to in keys.items():
        back = NOWHERE if inverse is None else view(to).ways[inverse[index]].to
        mutual = back != NOWHERE and find(back) == number
        if mutual and inverse is not None and (to, inverse[index]) in keys and (to, inverse[index]) < (number, index):
            continue
        count += 1
        crooked += back != NOWHERE and not mutual
        if _off(united, number, index, to, apart=apart):
            off += 1
            astray += _denied(united, number, index, to, apart=apart)
    squares = _squares(united, apart=apart) if h.scheme.displacements is None else (0.0, 0.0)
    return Links(count, off, crooked, meeting if inverse is None else 0, astray, *squares)


def _squares(united: Union, *, apart: bool) -> tuple[float, float]:
    """Squares around the places concerned that close, and that do not, before and after."""
    h, find = united.h, united.find
    near = around(h, united.members())
    if apart:
        return tally(h, near)

    def to(number: int, way: int) -> int:
        there = united.view(number).ways[way].to
        return there if there == NOWHERE else find(there)

    return tally(h, {find(number) for number in near}, to)


def _off(united: Union, number: int, index: int, to: int, *, apart: bool) -> bool:
    """Whether a link leads where the chart does not say."""
    h = united.h
    if h.scheme.displacements is None:
        return False
    if apart:
        place, there = h.places[number], h.places[to]
        return h.beyond(place, index) != (there.frame, there.position)
    return united.charts.ahead(united.find(number), index) != united.key(to)


def _denied(united: Union, number: int, index: int, to: int, *, apart: bool) -> bool:
    """Whether a link is known not to lead back to where a walk came from: that it is off the chart says no more."""
    h, find = united.h, _itself if apart else united.find
    if h.scheme.inverse is None:
        return False
    into = h.places[number].into if apart else united.view(number).into
    return any(by == h.scheme.inverse[index] and find(source) != to for source, by in into)


def _united_doors(united: Union, *, apart: bool) -> float:
    h = united.h
    if apart:
        return doors(h, united.members())
    return doors(h, united.classes, view=united.view, find=united.find, beside=united.beside)


def _itself(number: int) -> int:
    return number


def doors(
    h: Hypothesis,
    numbers: Iterable[int],
    *,
    view: Callable[[int], Place] | None = None,
    find: Callable[[int], int] = _itself,
    beside: Callable[[int, int], int] | None = None,
) -> float:
    """log P(readings of the ways of some places), those of both sides of a door together.

    Before anything was read a door is as open as it was expected to be when the first of its two places was found.

    Args:
        h: the hypothesis.
        numbers: the places.
        view, find, beside: the record of a place, the one it is taken for, and the one that poses say is beyond a way,
            if not as the hypothesis has them.
    """
    inverse, view = h.scheme.inverse, view or h.places.__getitem__
    done: set[tuple[int, int]] = set()
    total = 0.0
    for number in numbers:
        place = view(number)
        for index in h.awake:
            if (number, index) in done:
                continue
            way, its, first = place.ways[index], 0.0, (number, place, index)
            if inverse is not None:
                known = way.to != NOWHERE
                other = find(way.to) if known else beside(number, index) if beside else h.beside(place, index)
                if other != NOWHERE:
                    there, back = view(other), inverse[index]
                    if there.ways[back].to == NOWHERE or find(there.ways[back].to) == number:
                        its = there.ways[back].net
                        done.add((other, back))
                        first = min(first, (other, there, back), key=itemgetter(0))
            if way.net or its:
                total += log(sum(both_sides(h.chances, way.net, its, open_=before_reading(h, *first, view, find))))
    return total
