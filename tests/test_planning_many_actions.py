"""Long lists of actions of which few are ever open: plans are those of the short list."""

from __future__ import annotations

import numpy as np
import pytest
from cogmap.agent import Agent
from cogmap.inference import open_probability
from cogmap.model import Motions, Whereabouts
from cogmap.planning import Plan, Planner
from cogmap.worlds import GRID, MAZES, MazeEnv, hall

MAZE = hall(4, 5, sights=None)
WALK = ["right", "right", "down", "left", "left", "down", "right"]


def with_more(actions: int) -> Motions:
    """The grid, and further actions in pairs that undo each other."""
    more = [(3 + i // 2, 1) if i % 2 else (-3 - i // 2, -1) for i in range(actions)]
    names = *GRID.names, *(f"never {i}" for i in range(actions))
    return Motions(names, (*GRID.displacements, *more))


def planned(actions: int, *, walked: int, opened: int | None = None) -> Plan:
    """The plan after a walk, with so many further actions, one of which may have been open at the start."""
    world = MazeEnv(MAZE)
    seen, _ = world.reset(options={"start": (0, 0)})
    agent = Agent(with_more(actions), planner=Planner(explorer=None), seed=0)
    map_, room, place = agent.map, (0, 0), 0
    for step, name in enumerate(["stay", *WALK[:walked]]):
        action = GRID.names.index(name)
        down, right = GRID.displacements[action]
        before, room = place, (room[0] + down, room[1] + right)
        place = map_.place_at(room) or 0
        map_.transitions.learn(before, action, place, 1.0)
        seen = world.displace(room)
        open_ = (*seen["open"], *(i == opened and step == 0 for i in range(actions)))
        map_.mark_visited(place)
        map_.recall(agent.growth.look(map_, Whereabouts({place: 1.0}), open_, step=step))
        readings = {"sight": seen["sight"], "open": open_}
        read = {n: sensor.read(sensor.check(readings[n]), step=step) for n, sensor in map_.sensors.items()}
        map_.learn(place, read, 1.0)
    return agent.planner.plan(
        map_, np.array([place]), np.ones(1), open_=open_, look_ahead=4, rng=np.random.default_rng(0), discount=0.95
    )


@pytest.mark.parametrize(("actions", "walked"), [(12, 5), (12, 7), (40, 2), (40, 7), (100, 1), (100, 6)])
def test_actions_that_are_never_open_change_no_plan(actions: int, walked: int) -> None:
    short, long = planned(0, walked=walked), planned(actions, walked=walked)
    assert {tuple(policy) for policy in long.policies} == {tuple(policy) for policy in short.policies}
    assert long.names == short.names
    order = np.lexsort(long.policies.T), np.lexsort(short.policies.T)
    G = long.expected_free_energy.G[order[0]], short.expected_free_energy.G[order[1]]
    np.testing.assert_allclose(G[0], G[1], rtol=1e-3, atol=1e-5)
    long.model.check()


def test_an_action_that_was_open_once_may_be_open_again() -> None:
    plan = planned(12, walked=7, opened=3)
    used = {plan.model.motions.names[action] for policy in plan.policies.tolist() for action in policy}
    assert used & {f"never {i}" for i in range(12)} == {"never 2", "never 3"}  # and what undoes it


def walked(actions: int, steps: int, *, hatch: bool = False) -> Agent:
    """An agent after a walk in 4x4_alias; with a hatch further action 0 is open from step 20 on, and kept from."""
    world, agent = MazeEnv(MAZES["4x4_alias"]), Agent(with_more(actions), seed=0)
    seen, _ = world.reset(seed=0)
    said: dict[str, str] = {}
    for step in range(steps):
        open_ = [*map(bool, seen["open"]), *[False] * actions]
        if hatch and step >= 20:
            open_[5] = True
        action = agent.step({**seen, "open": open_, **said})
        said = {"taken": "stay"} if action > 4 else {}
        if not said:
            seen, *_ = world.step(action)
    return agent


@pytest.mark.parametrize("actions", [12, 40])
def test_an_agent_is_not_lost_among_actions_that_are_never_open(actions: int) -> None:
    agent = walked(actions, 24)
    assert len(agent.map.places) == len(agent.map.visited_places) == 16
    assert agent.belief.certainty > 0.9
    assert agent._recognition.tracker.awake == (0, 1, 2, 3)
    assert not any(record.revised for record in agent.trace)  # filter and hypotheses agree at every step
    known = [agent.map.transitions.blocked(np.array([place])) for place in agent.map.places]
    assert min(p[0, 5:].min() for p in known) > 0.9


def test_an_action_is_thought_of_once_it_was_open() -> None:
    agent = walked(12, 30, hatch=True)
    tracker = agent._recognition.tracker
    assert tracker.awake == (0, 1, 2, 3, 4, 5)  # it, and what undoes it; ways are without `stay`
    assert open_probability(tracker.best, tracker.best.here, 4) > 0.5
    loaded = Agent.from_state(*agent.state())._recognition.tracker
    assert (loaded.awake, loaded.best.awake) == (tracker.awake, tracker.awake)
