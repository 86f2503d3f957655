"""Two actions that lead to the same place in either order: what lies beyond a way, where no pose says it.

How often they do is a rate that is learned (`SQUARE`): in a grid of rooms they always do, in a ring or for an action
that turns the agent hardly ever. Three known sides of a square then say where its fourth side leads.
"""

from collections.abc import Callable, Collection, Iterable, Iterator
from typing import Protocol

from .layered import Layered
from .records import NOWHERE, Place
from .scheme import WayScheme

DEEP = 3  # sides that are themselves only known from squares, one by another, at most
CORNERS = 4.0  # corners from which one square is met where it is known which action undoes which


class Map(Protocol):
    """What is read of a hypothesis."""

    scheme: WayScheme
    places: Layered[int, Place]


To = Callable[[int, int], int]  # Where a way of a place is known to lead, or `NOWHERE`


def across(h: Map, place: Place, way: int, deep: int = DEEP) -> int:
    """The place that closes a square beyond a way of a place; `NOWHERE` where no three sides are known."""
    inverse = h.scheme.inverse
    for source, by in _sources(h, place):
        if by == way or (inverse is not None and inverse[by] == way):
            continue
        aside = _ahead(h, source, way, deep)
        if aside in (NOWHERE, source):
            continue
        number, corner = h.places[source].ways[by].to, _ahead(h, aside, by, deep)
        if corner not in (NOWHERE, number, source, aside) and _free(h, corner, way, number):
            return corner
    return NOWHERE


def _ahead(h: Map, number: int, way: int, deep: int) -> int:
    place = h.places[number]
    to = place.ways[way].to
    return to if to != NOWHERE or not deep else across(h, place, way, deep - 1)


def _sources(h: Map, place: Place) -> Iterator[tuple[int, int]]:
    """The places from which an action leads here."""
    inverse = h.scheme.inverse
    if inverse is None:
        yield from sorted(place.into)
        return
    for back, way in enumerate(place.ways):
        if way.to != NOWHERE and h.places[way.to].ways[inverse[back]].to != NOWHERE:
            yield way.to, inverse[back]


def _free(h: Map, corner: int, way: int, number: int) -> bool:
    """Whether nothing is known that contradicts that a way of `number` leads to `corner`."""
    place, inverse = h.places[corner], h.scheme.inverse
    if inverse is None:
        return all(by != way or source == number for source, by in place.into)
    return place.ways[inverse[way]].to in (NOWHERE, number)


def around(h: Map, numbers: Iterable[int]) -> set[int]:
    """Places from which a square may be met that has one of these places as a corner, or a way of one as a side."""
    found = set(numbers)
    for _ in range(2):
        for number in list(found):
            place = h.places[number]
            found |= {way.to for way in place.ways if way.to != NOWHERE} | {source for source, _ in place.into}
    return found


def tally(h: Map, centres: Collection[int], to: To | None = None) -> tuple[float, float]:
    """How many pairs of actions lead from some places to the same place in either order, and how many do not.

    Args:
        h: the hypothesis.
        centres: the places.
        to: where ways lead, if not as the hypothesis has it.
    """
    inverse, count, places = h.scheme.inverse, h.scheme.count, h.places

    def known(number: int, way: int) -> int:
        return places[number].ways[way].to

    ahead = to or known
    yes = no = 0
    for number in centres:
        sides = [(way, end) for way in range(count) if (end := ahead(number, way)) not in (NOWHERE, number)]
        for k, (one, first) in enumerate(sides):
            for other, second in sides[k + 1 :]:
                if first == second or (inverse is not None and inverse[one] == other):
                    continue
                a, b = ahead(first, other), ahead(second, one)
                if NOWHERE not in (a, b) and number not in (a, b) and a != first and b != second:
                    yes += a == b
                    no += a != b
    return (yes, no) if inverse is None else (yes / CORNERS, no / 2.0)
