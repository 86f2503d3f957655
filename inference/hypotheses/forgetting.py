"""Of parts of a map that were walked through once, and that nothing joins to the rest, the oldest are forgotten."""

from __future__ import annotations

from .hypothesis import Hypothesis
from .records import NOWHERE


def forget_fragments(h: Hypothesis, most: int) -> bool:
    """Have `most` such parts at most; whether any was forgotten. What they said of the rates stays counted.

    The agent was put into each of them without a word, or so it is thought, and never came back to any place of it. The
    part in which the walk began and the one where the agent is now, or may be, are kept.
    """
    if len({h.places[number].frame for number in h.places}) <= most:
        return False
    here = {h.here, *(h.crowd or ())}
    old = [part for part in _parts(h) if here.isdisjoint(part) and all(_once(h, number) for number in part)]
    old.sort(key=lambda part: max(h.places[number].recent[-1] for number in part))
    for part in old[: max(len(old) - most, 0)]:
        h.links = max(h.links - len(_links(h, part)), 0)
        for number in sorted(part):
            h.forget(number)
    return len(old) > most


def _once(h: Hypothesis, number: int) -> bool:
    place = h.places[number]
    return len(place.recent) == 1 and place.frame != 0


def _links(h: Hypothesis, part: set[int]) -> set[tuple[int, int]]:
    ends = ((number, way.to) for number in part for way in h.places[number].ways if way.to != NOWHERE)
    return {(min(pair), max(pair)) for pair in ends}


def _parts(h: Hypothesis) -> list[set[int]]:
    """The places by what hangs together: by walks, or by lying in one chart."""
    charts: dict[int, list[int]] = {}
    for number in h.places:
        charts.setdefault(h.places[number].frame, []).append(number)
    parts, left = list[set[int]](), set(h.places)
    while left:
        part, ahead = set[int](), [left.pop()]
        while ahead:
            number = ahead.pop()
            part.add(number)
            place = h.places[number]
            beside = {way.to for way in place.ways if way.to != NOWHERE} | {source for source, _ in place.into}
            beside.update(charts.pop(place.frame, ()))
            ahead += beside & left
            left -= beside
        parts.append(part)
    return parts
