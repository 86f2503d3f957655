"""How few steps would do: the exact oracle, or nearest-frontier search where it is out of reach."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from ..baselines import FrontierAgent
from ..worlds import Chart, Maze, Place, covering_steps, frontier_walk, place_of, world_of
from .running import Moment, run

EFFORT = 4_000_000  # search states times rooms squared: some seconds


@lru_cache(maxsize=4096)
def oracle_steps(chart: Chart, start: Place) -> int | None:
    """Steps of the shortest walk from `start` that visits every place; None where it is out of reach."""
    return covering_steps(chart, start, limit=max(1, EFFORT // len(chart.places) ** 2))


@lru_cache(maxsize=4096)
def frontier_steps(chart: Chart, start: Place) -> int | None:
    """Steps in which nearest-frontier search visits every place, its draws settled by seed 0; None of a large graph."""
    return frontier_search(chart, start, seed=0)


def frontier_search(chart: Chart, start: Place, seed: Any, *, goal: Any = None) -> int | None:
    """The same with any seed, until it first stands in a place with the sight `goal` if one is given."""
    if not isinstance(chart, Maze):
        walk = frontier_walk(chart, start, rng=np.random.default_rng(seed))
        there = [step for step, place in enumerate(walk or ()) if goal in (None, chart.sights[place])]
        return None if not there else there[-1] if goal is None else there[0]
    left, most = set(chart.places), len(chart.places) ** 2 + 1  # a new room takes no more steps than there are rooms

    def arrived(moment: Moment) -> bool:
        left.discard(place_of(moment.info))
        return not left if goal is None else moment.observation["sight"] == goal

    world, agent = world_of(chart), FrontierAgent(chart.motions, seed=seed)
    return run(world, agent, steps=most, options={"start": start}, watch=arrived).observations - 1
