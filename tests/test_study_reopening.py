"""A room that opens again is found again by agents that forget."""

from __future__ import annotations

import pytest
from cogmap.agent import Agent, Settings
from cogmap.experiments import Moment, run
from cogmap.experiments.studies import study_named
from cogmap.worlds import GRID, MAZES, MazeEnv

START, GOAL, A = (6, 2), (0, 2), (4, 2)
STEPS = 20


def runs_until_route_1(settings: Settings, seed: int) -> int | None:
    """How many runs after A was opened again the goal is reached through it; None if never in twelve."""
    agent, world = Agent(GRID, settings=settings, seed=seed), MazeEnv(MAZES["tolman"])
    agent.prefer({0: 1.0})
    world.reset(options={"start": START})

    def one_run() -> bool:
        reached: list[int] = []

        def look(moment: Moment) -> None:
            if moment.info["position"] == GOAL and GRID.names[moment.action] == "stay":
                reached.append(moment.step)

        begin = world.displace(START), {"position": START}
        path = run(world, agent, steps=STEPS, begin=begin, watch=look).truth
        gates = [room for room in path[: reached[0] + 1] if room in (A, (3, 1), (1, 3))] if reached else []
        return bool(gates) and gates[-1] == A

    for closed in (None, A):
        if closed is not None:
            world.displace(START)
            world.close_room(closed)
        for _ in range(12):
            one_run()
    world.open_room(A)
    return next((number for number in range(1, 13) if one_run()), None)


@pytest.mark.study
def test_a_room_that_opens_again_is_found_again(study: bool) -> None:
    found = [runs_until_route_1(study_named("tolman").settings, seed) for seed in range(10 if study else 1)]
    assert sum(number is not None for number in found) >= 0.9 * len(found), found
