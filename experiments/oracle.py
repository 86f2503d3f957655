"""How few steps would do: the exact oracle, or nearest-frontier search where it is out of reach."""

from __future__ import annotations

from functools import lru_cache
from typing import Any, cast

import numpy as np

from ..baselines import FrontierAgent
from ..worlds import Chart, Maze, MazeEnv, Place, covering_steps, place_of
from .running import Moment, Watch, run

EFFORT = 4_000_000  # search states times rooms squared: some seconds


@lru_cache(maxsize=4096)
def oracle_steps(chart: Chart, start: Place) -> int | None:
    """Steps of the shortest walk from `start` that visits every place; None where it is out of reach."""
    return covering_steps(cast(Any, chart), start, limit=max(1, EFFORT // len(chart.places) ** 2))


@lru_cache(maxsize=4096)
def frontier_steps(chart: Chart, start: Place) -> int | None:
    """Steps in which nearest-frontier search visits every room of a maze, its draws settled by seed 0."""
    left = set(chart.places)

    def all_entered(moment: Moment) -> bool:
        left.discard(place_of(moment.info))
        return not left

    return frontier_search(chart, start, all_entered, seed=0)


def frontier_search(chart: Chart, start: Place, until: Watch, *, seed: int | np.random.SeedSequence) -> int | None:
    """Steps of nearest-frontier search from `start` before `until` answers True; None where the world is no maze."""
    if not isinstance(chart, Maze):
        return None
    world, most = MazeEnv(chart), len(chart.places) ** 2 + 1  # a new room takes no more steps than there are rooms
    agent = FrontierAgent(world.motions, seed=seed)
    return run(world, agent, steps=most, options={"start": start}, watch=until).observations - 1
