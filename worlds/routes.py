"""Shortest ways among the places of a chart."""

import heapq
from collections.abc import Callable, Collection, Sequence
from itertools import pairwise
from typing import Any

from .errors import WorldError
from .protocol import Chart, Place

BY = ("steps", "length")
"""What ways are measured in: one each, or their lengths."""


class Routes:
    """The neighbours of each place, looked up on demand.

    Args:
        chart: the true map.
        by: one of `BY`.

    Raises:
        WorldError: `by` is none of them.
    """

    def __init__(self, chart: Chart, by: str = "steps") -> None:
        if by not in BY:
            raise WorldError(f"ways cannot be measured by {by!r}; use one of {', '.join(BY)}")
        self.chart = chart
        self._whole = by == "steps"
        self._rows: dict[Place, dict[Place, float]] = {}

    def ahead(self, place: Place) -> dict[Place, float]:
        """The cost of going to each place next to `place`, by its cheapest way.

        Raises:
            WorldError: no such place, or the lengths of ways are not known.
        """
        if place not in self._rows:
            row: dict[Place, float] = {}
            for way, other in self.chart.exits(place).items():
                if other is not None and other != place:
                    cost = 1.0 if self._whole else self._length(place, way)
                    row[other] = min(cost, row.get(other, cost))
            self._rows[place] = row
        return self._rows[place]

    def nearest(
        self, start: Place, sought: Callable[[Place], bool], through: Callable[[Place], bool]
    ) -> tuple[list[Place], dict[Place, Place]]:
        """The nearest places that are sought, all at one distance, by ways through some places only.

        Returns:
            these places, none where none can be reached; and the place before each on a shortest way.
        """
        far, before = {start: 0.0}, {start: start}
        done: set[Place] = set()
        found: list[Place] = []
        queue, count, best = [(0.0, 0, start)], 0, float("inf")  # first in, first out among equals
        while queue and queue[0][0] <= best + 1e-9:
            distance, _, place = heapq.heappop(queue)
            if place in done:
                continue
            done.add(place)
            if place != start and sought(place):
                found.append(place)
                best = min(best, distance)
            elif place == start or through(place):
                for other, cost in self.ahead(place).items():
                    if distance + cost < far.get(other, float("inf")):
                        far[other], before[other], count = distance + cost, place, count + 1
                        heapq.heappush(queue, (far[other], count, other))
        return found, before

    def path(
        self, start: Place, end: Place, through: Callable[[Place], bool] = lambda place: True
    ) -> list[Place] | None:
        """A shortest way from `start` to `end`, both included; None if there is none."""
        if start == end:
            return [start]
        found, before = self.nearest(start, lambda place: place == end, through)
        return trail(before, end) if found else None

    def _length(self, place: Place, way: Any) -> float:
        length = self.chart.length(place, way)
        if length is None:
            raise WorldError(f"{self.chart.name!r} tells no lengths of ways; measure by steps")
        return length


def trail(before: dict[Place, Place], end: Place) -> list[Place]:
    """The way that ends in `end`, from the place before each."""
    way = [end]
    while before[way[-1]] != way[-1]:
        way.append(before[way[-1]])
    return way[::-1]


def shortest_path(chart: Chart, a: Place, b: Place, *, closed: Collection[Place] = (), by: str = "steps") -> list[Any]:
    """A shortest list of places from `a` to `b`, both included, that enters no place of `closed`.

    Args:
        chart: a maze, or the chart of another world.
        a: the first place.
        b: the last place.
        closed: places not to enter.
        by: one of `BY`.

    Raises:
        WorldError: no such place, no way, or no lengths.
    """
    start, end = chart.find(a), chart.find(b)
    shut = {chart.find(place) for place in closed}
    way = None if end in shut and start != end else Routes(chart, by).path(start, end, lambda place: place not in shut)
    if way is None:
        named = ", ".join(sorted(map(str, closed))) or "nothing"
        raise WorldError(f"no way from {a} to {b} with {named} closed; open one")
    return way


def walk_length(chart: Chart, walk: Sequence[Place]) -> float:
    """The summed lengths of the ways of a walk, the shortest one at each step; staying costs nothing.

    Raises:
        WorldError: lengths are not known, or two places in a row have no way between them.
    """
    routes = Routes(chart, "length")
    total = 0.0
    for a, b in pairwise(walk):
        if a != b and b not in routes.ahead(a):
            raise WorldError(f"no way leads from {a} to {b}")
        total += 0.0 if a == b else routes.ahead(a)[b]
    return total
