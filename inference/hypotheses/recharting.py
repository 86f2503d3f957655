"""A loop that does not close on the chart: one of its links leads where no chart says, or was a silent move."""

from collections.abc import Iterator, Mapping
from math import log
from typing import NamedTuple

from .branches import unseen
from .extending import shared, unlink, with_way
from .hypothesis import Hypothesis
from .rates import ELSEWHERE, MOVED, UNDONE
from .records import NOWHERE, Place, Position, Way
from .weighing import doors, rate_gain

LARGEST = 256  # Places that are laid out anew at most

DOORS = 8.0
"""Nats that doors gain at most, where places come to lie beside others."""


BETTER = 0.5
"""Nats by which another link of a loop explains more, or else there are as many such hypotheses as it has links."""


class Link(NamedTuple):
    """A way, and where it leads."""

    number: int
    way: int
    to: int


class Part(NamedTuple):
    """Places that only one link joins to the others on their chart, and how far they are laid from where they were."""

    numbers: frozenset[int] = frozenset()
    shift: Position = ()


WHOLE = Part()


def recharted(h: Hypothesis, number: int, *, floor: float) -> Iterator[Hypothesis]:
    """Hypotheses in which the ways of a place lead where the chart says; those below `floor` are left out.

    Either a walk along the way was a silent move; or the loop that it closes has another link that was, or that leads
    off the chart, and the places beyond that lie elsewhere.
    """
    inverse = h.scheme.inverse
    if h.scheme.displacements is None or inverse is None:
        return
    for way in h.awake:
        to = h.places[number].ways[way].to
        if to == NOWHERE or not _off(h, Link(number, way, to)):
            continue
        odd = Link(number, way, to)
        for link, part in ((odd, Part()), *_loop(h, odd)):
            for cut in (True, False) if part.numbers else (True,):
                other = _otherwise(h, link, part, cut=cut, floor=floor if cut else max(floor, h.weight + BETTER))
                if other is not None:
                    yield other


def _off(h: Hypothesis, link: Link, part: Part = WHOLE) -> bool:
    """Whether a link leads where the chart does not say, with a part of it laid elsewhere."""
    place, there = h.places[link.number], h.places[link.to]
    assert h.scheme.displacements is not None
    if place.frame != there.frame:
        return True
    ahead = [x + d for x, d in zip(_at(place, link.number, part), h.scheme.displacements[link.way], strict=True)]
    return h.canonical(place.frame, ahead) != h.canonical(there.frame, _at(there, link.to, part))


def _at(place: Place, number: int, part: Part) -> Position:
    if number not in part.numbers:
        return place.position
    return tuple(x + d for x, d in zip(place.position, part.shift, strict=True))


# -- the loop ------------------------------------------------------------------------------------------------


def _loop(h: Hypothesis, odd: Link) -> Iterator[tuple[Link, Part]]:
    """The links of the loop that `odd` closes without which its two ends would hang together no more."""
    frame = h.places[odd.number].frame
    if h.places[odd.to].frame != frame or h.periods.get(frame):
        return
    ends = {(odd.number, odd.to), (odd.to, odd.number)}
    path = _path(h, odd.number, odd.to, ends)
    index = {number: k for k, number in enumerate(path)}
    along = {pair for k in range(len(path) - 1) for pair in ((path[k], path[k + 1]), (path[k + 1], path[k]))}
    near, farthest = set[int](), 0
    for k in range(len(path) - 1):
        for number in _reached(h, path[k], near, ends | along):
            farthest = max(farthest, index.get(number, 0))
        if farthest <= k and (link := _walked_once(h, path[k], path[k + 1])) is not None:
            yield from _parted(h, odd, link, frozenset(near))
        farthest = max(farthest, k + 1)


def _path(h: Hypothesis, start: int, end: int, without: set[tuple[int, int]]) -> list[int]:
    before, queue = {start: NOWHERE}, [start]
    for number in queue:
        for other in _linked(h, number):
            if other not in before and (number, other) not in without:
                before[other] = number
                queue.append(other)
        if end in before:
            break
    path = [end] if end in before else []
    while path and path[-1] != start:
        path.append(before[path[-1]])
    return path[::-1]


def _reached(h: Hypothesis, start: int, seen: set[int], without: set[tuple[int, int]]) -> Iterator[int]:
    """The places that hang together with one, which are added to those that were seen."""
    queue = [start] if start not in seen else []
    seen.update(queue)
    for number in queue:
        yield number
        for other in _linked(h, number):
            if other not in seen and (number, other) not in without:
                seen.add(other)
                queue.append(other)


def _linked(h: Hypothesis, number: int) -> Iterator[int]:
    """The places of the same chart that links join to one."""
    place = h.places[number]
    for other in (*(place.ways[way].to for way in h.awake), *(source for source, _ in sorted(place.into))):
        if other != NOWHERE and h.places[other].frame == place.frame:
            yield other


def _walked_once(h: Hypothesis, one: int, other: int) -> Link | None:
    """The link between two places, if it was walked once, on the chart, and its way back is no other."""
    assert h.scheme.inverse is not None
    found: list[Link] = []
    for number, to in ((one, other), (other, one)):
        for index in h.awake:
            way = h.places[number].ways[index]
            if way.to == to and way.walks:
                if way.walks > 1 or h.places[to].ways[h.scheme.inverse[index]].to != number:
                    return None
                found.append(Link(number, index, to))
    return found[0] if len(found) == 1 else None


def _parted(h: Hypothesis, odd: Link, link: Link, near: frozenset[int]) -> Iterator[tuple[Link, Part]]:
    """The part of the chart beyond a link, laid so that `odd` leads where the chart says."""
    frame = h.places[odd.number].frame
    far = frozenset(k for k in h.places if h.places[k].frame == frame) - near
    moved, sign = (far, 1) if min(near) < min(far) else (near, -1)
    assert h.scheme.displacements is not None
    place, there, step = h.places[odd.number], h.places[odd.to], h.scheme.displacements[odd.way]
    # the near side holds the place that `odd` leads from
    shift = tuple(sign * (x + d - y) for x, d, y in zip(place.position, step, there.position, strict=True))
    part = Part(moved, shift)
    free = all(h.at.get((frame, _at(h.places[k], k, part))) in {None, *moved} for k in moved)
    if free and len(moved) <= LARGEST:
        yield link, part


# -- the map as it would be ----------------------------------------------------------------------------------


def _otherwise(h: Hypothesis, link: Link, part: Part, *, cut: bool, floor: float) -> Hypothesis | None:
    """The hypothesis in which a part lies elsewhere, and a link was a silent move if it is cut, or else is odd."""
    counts, gain = _counts(h, link, part, cut=cut)
    if counts is None:
        return None
    gain += sum(rate_gain(h, rate, *more) for rate, more in counts.items())
    if h.weight + gain + DOORS < floor:
        return None
    other = h.fork()
    _lay(other, part)
    if cut:
        _cut(other, link)
    beside = {k for k in part.numbers | {link.number, link.to} for k in _beside(h, k) | _beside(other, k)}
    touched = sorted(beside | part.numbers | {link.number, link.to})
    other.weight = h.weight + gain + doors(other, touched) - doors(h, touched)
    if other.weight < floor:
        return None
    for number in touched:
        other.put(number, shared(other, number, other.places[number]))
    for rate, (yes, no) in counts.items():
        other.counts.yes[rate] = max(other.counts.yes[rate] + yes, 0.0)
        other.counts.no[rate] = max(other.counts.no[rate] + no, 0.0)
    return other


Counts = Mapping[int, tuple[float, float]]  # Of each rate, how much oftener it was found true, and false


def _counts(h: Hypothesis, link: Link, part: Part, *, cut: bool) -> tuple[Counts | None, float]:
    """The counts that change, and nats besides; none where a link that is to be cut cannot be."""
    off = 0
    for one in _across(h, part):
        off += (not (cut and one == link) and _off(h, one, part)) - _off(h, one)
    if not part.numbers:
        off = -1
    gain = -off * log(h.size + 1.0)
    if not cut:
        return {ELSEWHERE: (off, -off)}, gain
    assert h.scheme.inverse is not None
    way, back = h.places[link.number].ways[link.way], h.places[link.to].ways[h.scheme.inverse[link.way]]
    if way.walks != 1 or (back.walks and back.to == link.number):
        return None, 0.0
    beside = NOWHERE if part.numbers else h.beside(h.places[link.number], link.way)
    side = Way() if beside == NOWHERE else h.places[beside].ways[h.scheme.inverse[link.way]]
    if side.to not in (NOWHERE, link.number):
        return None, 0.0
    undone = float(side.walks > 0)
    crooked = undone + (back.walks > 0)
    elsewhere = (off, -1.0 - off) if part.numbers or not undone else (0.0, 0.0)
    return {MOVED: (1.0, -1.0), ELSEWHERE: elsewhere, UNDONE: (undone, -crooked)}, gain - log(h.size + unseen(h))


def _across(h: Hypothesis, part: Part) -> Iterator[Link]:
    """The links between a part and the other places of its chart, each once."""
    found: dict[tuple[int, int], Link] = {}
    for number in sorted(part.numbers):
        place = h.places[number]
        ways = ((index, place.ways[index]) for index in h.awake)
        links = [Link(number, index, way.to) for index, way in ways if way.to != NOWHERE and way.walks]
        links += [Link(source, index, number) for source, index in sorted(place.into)]
        for link in links:
            inside = (link.number in part.numbers) + (link.to in part.numbers)
            if inside == 1 and h.places[link.number].frame == h.places[link.to].frame:
                found.setdefault((min(link.number, link.to), max(link.number, link.to)), link)
    yield from found.values()


def _lay(h: Hypothesis, part: Part) -> None:
    for number in part.numbers:
        place = h.places[number]
        del h.at[place.frame, place.position]
    for number in sorted(part.numbers):
        place = h.places[number]
        position = _at(place, number, part)
        h.at[place.frame, position] = number
        h.put(number, place._replace(position=position))


def _cut(h: Hypothesis, link: Link) -> None:
    """Nothing is known any more of where a way leads, but what the chart and ways back say."""
    assert h.scheme.inverse is not None
    way = h.places[link.number].ways[link.way]
    unlink(h, link.number, link.way, way)
    place = h.places[link.number]
    beside = h.beside(place, link.way)
    back = Way() if beside == NOWHERE else h.places[beside].ways[h.scheme.inverse[link.way]]
    to = beside if back.walks and back.to == link.number else NOWHERE
    h.put(link.number, with_way(place, link.way, way._replace(walks=0, to=to)))
    h.links -= 1


def _beside(h: Hypothesis, number: int) -> set[int]:
    place = h.places[number]
    return {to for way in h.awake if (to := h.neighbour(place, way)) != NOWHERE}
