"""How few steps would do: exactly where that can be had, else the best tour found, and what nearest frontier takes."""

from typing import Any

import numpy as np

from .covering import search, tree_walk
from .errors import WorldError
from .protocol import Chart, Place
from .routes import Routes, trail
from .tour import shortest_tour

LIMIT = 50_000  # some seconds
MOST_EXACT = 300
"""Places of the largest world whose shortest covering walk is sought, if it is no tree."""
MOST_TOUR = 5_000
"""Places of the largest world for which an offline tour is sought: it takes a table of all distances."""
MOST_WALKED = 20_000
"""Places of the largest world in which walks over all places are worked out at all."""


def covering_walk(chart: Chart, start: Place, *, limit: int = LIMIT) -> tuple[Any, ...] | None:
    """A shortest walk from `start` that visits every place, as the places in order, `start` first.

    Exact. Where the ways make a tree it has 2(n - 1) - eccentricity(start) steps; otherwise A* over
    (place, visited places) finds it, one-way ways as they are.

    Args:
        chart: a maze, or the chart of another world, everything open.
        start: the first place.
        limit: most search states to expand; past it, and above `MOST_EXACT` places (`MOST_WALKED` of a tree), the
            oracle is out of reach and the answer is None.

    Raises:
        WorldError: no such place, or a limit below 1.
    """
    first = chart.find(start)
    if limit < 1:
        raise WorldError(f"the oracle's limit is {limit}; use at least 1")
    ahead = _numbered(chart)
    if ahead is None:
        return None
    number = chart.places.index(first)
    if _is_tree(ahead):
        walk = tree_walk(ahead, number)
    elif len(ahead) <= MOST_EXACT:
        walk = search(ahead, number, limit=limit)
    else:
        return None
    return None if walk is None else tuple(chart.places[i] for i in walk)


def covering_steps(chart: Chart, start: Place, *, limit: int = LIMIT) -> int | None:
    """The number of steps of `covering_walk`; None if that is too costly to compute."""
    walk = covering_walk(chart, start, limit=limit)
    return None if walk is None else len(walk) - 1


def tour(chart: Chart, start: Place, *, by: str = "steps", rounds: int = 500, seed: int = 0) -> tuple[Any, ...] | None:
    """The shortest walk that was found from `start` through all places of a known world.

    An open travelling salesman's path over all shortest distances: nearest neighbours first, then segments turned
    (2-opt) and moved (Or-opt) while that helps, with ways that cost more one way than the other as they are; then
    `rounds` times two neighbouring segments are exchanged at random and mended, and kept unless that is worse.

    Args:
        chart: a maze, or the chart of another world, everything open.
        start: the first place.
        by: `"steps"` or `"length"`.
        rounds: exchanges to try.
        seed: of these.

    Returns:
        the places in order, `start` first; None above `MOST_TOUR` places.

    Raises:
        WorldError: no such place, no lengths, or a place that cannot be reached.
    """
    first = chart.find(start)
    if len(chart.places) > MOST_TOUR:
        return None
    routes = Routes(chart, by)
    number = {place: i for i, place in enumerate(chart.places)}
    ahead = [{number[other]: cost for other, cost in routes.ahead(place).items()} for place in chart.places]
    order = shortest_tour(ahead, number[first], rounds=rounds, rng=np.random.default_rng(seed))
    if order is None:
        raise WorldError(f"{chart.name!r}: not every place can be reached from {first}; no tour visits them all")
    walk = [first]
    for place in (chart.places[i] for i in order[1:]):
        walk.extend((routes.path(walk[-1], place) or [])[1:])
    return _upto_last_new(walk)


def frontier_walk(chart: Chart, start: Place, *, by: str = "steps", rng: np.random.Generator) -> tuple[Any, ...] | None:
    """The walk of nearest-frontier search (Yamauchi 1997) over every place.

    It goes to the nearest place that was seen but not entered, until none is left. The ways of a place are seen when
    it is entered, and so is which place they lead to.

    Args:
        chart: a maze, or the chart of another world, everything open.
        start: the first place.
        by: what is nearest, by `"steps"` or `"length"`.
        rng: settles draws, evenly among the nearest.

    Returns:
        the places in order, `start` first; None above `MOST_WALKED` places.

    Raises:
        WorldError: no such place, or no lengths.
    """
    walk = [chart.find(start)]
    if len(chart.places) > MOST_WALKED:
        return None
    routes, entered = Routes(chart, by), {walk[0]}
    while True:
        found, before = routes.nearest(walk[-1], lambda place: place not in entered, entered.__contains__)
        if not found:
            return tuple(walk)
        nearest = found[int(rng.integers(len(found)))]
        walk.extend(trail(before, nearest)[1:])
        entered.add(nearest)


def _numbered(chart: Chart) -> list[list[int]] | None:
    """The numbers of the places next to each; None of a world too large to walk."""
    if len(chart.places) > MOST_WALKED:
        return None
    routes = Routes(chart)
    number = {place: i for i, place in enumerate(chart.places)}
    return [[number[other] for other in routes.ahead(place)] for place in chart.places]


def _is_tree(ahead: list[list[int]]) -> bool:
    ways = {(at, to) for at, row in enumerate(ahead) for to in row}
    return len(ways) == 2 * (len(ahead) - 1) and all((to, at) in ways for at, to in ways)


def _upto_last_new(walk: list[Place]) -> tuple[Any, ...]:
    last = max({place: i for i, place in reversed(list(enumerate(walk)))}.values())
    return tuple(walk[: last + 1])
