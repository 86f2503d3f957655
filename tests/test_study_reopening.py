"""A room that opens again is found again by agents that forget."""

from __future__ import annotations

import pytest
from cogmap.experiments.studies.tolman_maze import RUNS, SETTINGS, A, agent_run, new_agent, new_world, set_closed


def runs_until_route_1(seed: int) -> int | None:
    """How many runs after A was opened again the goal is reached through it; None if never in a block."""
    agent, world = new_agent(SETTINGS, seed), new_world()
    for closed in (None, A):
        set_closed(world, room=closed)
        for _ in range(RUNS):
            agent_run(agent, world)
    set_closed(world)
    for run in range(1, RUNS + 1):
        if agent_run(agent, world).route == 1:
            return run
    return None


@pytest.mark.study
def test_a_room_that_opens_again_is_found_again(study: bool) -> None:
    found = [runs_until_route_1(seed) for seed in range(10 if study else 1)]
    assert sum(run is not None for run in found) >= 0.9 * len(found), found
