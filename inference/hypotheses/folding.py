"""Folding: a hypothesis in which look-alikes are one place, at its weight plus what that explains better."""

from __future__ import annotations

from collections.abc import Iterator
from math import log

from .extending import shared
from .hypothesis import Hypothesis
from .rates import ASTRAY, ELSEWHERE, MEETING, MOVED, NEW, SQUARE, UNDONE
from .records import NOWHERE, Place
from .uniting import ContradictionError, Union
from .weighing import Links, rate_gain, scored

MORE = 12.0
"""Nats that what is scored last may gain at most: fewer places, fewer ways."""

OUT_OF_THE_QUESTION = -1000.0
"""Nats that a folding gains which says in other words what is held already."""


def pairs(h: Hypothesis, *, most: int = 12) -> Iterator[tuple[int, int, bool]]:
    """The place where the agent is with each that looks like it: (one, other, whether their chart closes on itself).

    At most the `most` look-alikes that were seen last are named.
    """
    here = h.places[h.here]
    for other in _alike(h, here)[-most:]:
        yield h.here, other, False
        if _may_close(h, here, h.places[other]):
            yield h.here, other, True


def _alike(h: Hypothesis, here: Place) -> list[int]:
    """Places that look the same to some sensor; those that do to more sensors, and were seen last, at the end."""
    votes: dict[int, int] = {}
    for sensor in range(h.scheme.sensors):
        label = here.label(sensor)
        for number in (h.shown.get((sensor, label)) or ()) if label >= 0 else ():
            votes[number] = votes.get(number, 0) + 1
    votes.pop(h.here, None)
    return sorted(votes, key=votes.__getitem__) if h.scheme.sensors > 1 else list(votes)


def _may_close(h: Hypothesis, one: Place, other: Place) -> bool:
    return h.scheme.displacements is not None and one.frame == other.frame


def union(h: Hypothesis, one: int, other: int, *, period: bool, floor: float) -> Hypothesis | float:
    """The hypothesis in which two places are one; where its log weight is below `floor`, what it gains at most."""
    most = MORE + _off_the_chart(h, h.places[one], h.places[other])
    united = Union(h, floor=floor - h.weight - most)
    try:
        united.unite(one, other, period=period)
    except ContradictionError:
        return united.gain + most
    if _leads_nowhere(united):
        return OUT_OF_THE_QUESTION
    gain, links = scored(united)
    if h.weight + gain < floor:
        return gain
    return _built(united, h.weight + gain, links)


def _off_the_chart(h: Hypothesis, one: Place, other: Place) -> float:
    """What it gains at most, and that is less than nothing, that some way leads where the chart does not say."""
    if h.scheme.displacements is None or one.frame != other.frame or one.position == other.position:
        return 0.0
    return rate_gain(h, ELSEWHERE, 1.0, 0.0) - log(h.size)


def _leads_nowhere(united: Union) -> bool:
    """Whether a way that was never looked at would lead back to where it began: that it is shut says the same."""
    return any(
        (way := place.ways[index]).to != NOWHERE and not (way.open or way.blocked) and united.find(way.to) == number
        for number, place in united.classes.items()
        for index in united.h.awake
    )


def _built(united: Union, weight: float, more: Links) -> Hypothesis:
    h = united.h.fork()
    h.chances = united.h.chances
    h.weight, h.here = weight, united.find(h.here)
    h.links += more.ways
    touched = _neighbours(united)
    records = {number: _resolved(united, number) for number in sorted(touched) if united.find(number) == number}
    for number in sorted(set(united.gone())):
        h.remove(number)
    _chart(united, h)
    for number, place in records.items():
        frame, position = united.charts.charted.get(number, (place.frame, place.position))
        h.put(number, Place(place.sights, place.ways, frame, position, place.recent, place.into, place.share))
    for number in records:
        h.put(number, shared(h, number, h.places[number]))
    _count(united, h, more)
    return h


def _count(united: Union, h: Hypothesis, more: Links) -> None:
    counts, fewer = h.counts, len(set(united.gone()))
    counts.yes[MOVED] += united.moved
    counts.yes[ASTRAY] += united.astray
    counts.no[ASTRAY] = max(counts.no[ASTRAY] - united.astray, 0.0)
    counts.no[UNDONE] = max(counts.no[UNDONE] + more.crooked, 0.0)
    if h.scheme.inverse is None:
        counts.yes[MEETING] = max(counts.yes[MEETING] + more.meeting, 0.0)
        counts.no[MEETING] = max(counts.no[MEETING] + more.ways - more.meeting, 0.0)
    if h.scheme.displacements is None:
        counts.yes[NEW] = max(counts.yes[NEW] - fewer, 0.0)
        counts.yes[SQUARE] = max(counts.yes[SQUARE] + more.square, 0.0)
        counts.no[SQUARE] = max(counts.no[SQUARE] + more.open_square, 0.0)
        counts.no[NEW] = max(h.links - h.size + 1 - counts.yes[SQUARE], 0.0)
        return
    off = more.off - more.astray + (united.charts.periods is not None)
    counts.yes[ELSEWHERE] = max(counts.yes[ELSEWHERE] + off, 0.0)
    counts.no[ELSEWHERE] = max(counts.no[ELSEWHERE] + more.ways - more.off, 0.0)


def _chart(united: Union, h: Hypothesis) -> None:
    """Lay places out anew whose chart has changed."""
    if united.charts.periods is not None:
        h.periods[united.charts.periods[0]] = united.charts.periods[1]
    moved = [number for number in united.charts.charted if h.places.get(number) is not None]
    for number in moved:
        place = h.places[number]
        if h.at.get((place.frame, place.position)) == number:
            del h.at[place.frame, place.position]
    for number in moved:
        place = h.places[number]
        frame, position = united.charts.charted[number]
        h.at[frame, position] = number
        h.put(number, Place(place.sights, place.ways, frame, position, place.recent, place.into, place.share))


def _neighbours(united: Union) -> set[int]:
    """The places that are united, and those that are linked with them."""
    touched = united.members()
    for number in list(touched):
        place = united.h.places[number]
        touched |= {to for way in united.h.awake if (to := place.ways[way].to) != NOWHERE}
        touched |= {source for source, _ in place.into}
    return touched


def _resolved(united: Union, number: int) -> Place:
    """The record of a place with every number of a united place replaced by the first one's."""
    place, find = united.view(number), united.find
    most = united.h.chances.most
    ways = list(place.ways)
    for index in united.h.awake:
        way = ways[index]
        ways[index] = way._replace(
            net=min(max(way.net, -most), most), to=find(way.to) if way.to != NOWHERE else NOWHERE
        )
    into = frozenset((find(source), index) for source, index in place.into)
    inverse = united.h.scheme.inverse
    if inverse is not None:
        for source, index in into:
            back = inverse[index]
            if ways[back].to == NOWHERE:
                ways[back] = ways[back]._replace(to=source)
    return Place(place.sights, tuple(ways), place.frame, place.position, place.recent, into, place.share)
