"""What exploring a graph is measured by: nearest-frontier search from the same start, and the best tour found."""

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from ..worlds import Chart, Maze, Place, frontier_walk, tour, walk_length

DRAWS = 20  # walks of nearest-frontier search whose mean is taken, each with draws of its own; fewer in a large world
WORK = 10_000  # places of all these walks together, at most, but for one walk
MOST_TOURED = 2_000  # places of the largest world whose offline tour is sought along with a run

ROUNDS = 100


def measured(chart: Chart, start: Place, path: Sequence[Place], visit_all: int | None) -> tuple[Any, ...]:
    """Of a walk on a graph: metres until every place was entered, and the same of nearest frontier and tour.

    Returns:
        metres; mean steps of nearest frontier; mean metres of nearest frontier by metres; steps of the tour. None of a
        maze, and of what is not known or was not worked out.
    """
    if isinstance(chart, Maze):
        return None, None, None, None
    lengths = _has_lengths(chart)
    metres = walk_length(chart, path[: visit_all + 1]) if lengths and visit_all is not None else None
    by_metres = frontier_mean(chart, start, "length") if lengths else None
    return (
        None if metres is None else round(metres, 6),
        frontier_mean(chart, start, "steps"),
        by_metres,
        tour_steps(chart, start),
    )


@lru_cache(maxsize=4096)
def frontier_mean(chart: Chart, start: Place, by: str) -> float | None:
    """What nearest-frontier search takes to enter every place, mean over draws of its ties; None of a large world."""
    found: list[float] = []
    for draw in range(max(1, min(DRAWS, WORK // len(chart.places)))):
        walk = frontier_walk(chart, start, by=by, rng=np.random.default_rng(draw))
        if walk is None:
            return None
        found.append(len(walk) - 1 if by == "steps" else walk_length(chart, walk))
    return round(float(np.mean(found)), 6)


@lru_cache(maxsize=4096)
def tour_steps(chart: Chart, start: Place) -> int | None:
    """Steps of the best offline tour found; None of a large world."""
    if len(chart.places) > MOST_TOURED:
        return None
    walk = tour(chart, start, rounds=ROUNDS)
    return None if walk is None else len(walk) - 1


def _has_lengths(chart: Chart) -> bool:
    ways = ((place, way) for place in chart.places for way, other in chart.exits(place).items() if other != place)
    first = next(ways, None)
    return first is not None and chart.length(*first) is not None
