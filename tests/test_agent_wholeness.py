"""A step is taken whole or not at all, whatever breaks it off, and the walk goes on as if nothing had been."""

from __future__ import annotations

import copy
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent, Settings
from cogmap.model import CogmapError, Sensor, Sight, StaticGrowth, Ways
from cogmap.worlds import MazeEnv, load_world
from failing import CLOCK, Failing, Observation, agent_of_somebody
from interrupts import content, lines_of, was_interrupted
from parts import agent_with
from walks import GRID

STARTS = [
    ("4x4_alias", 6, 0, {}),  # an explorer
    ("3x3_alias", 13, 4, {"forgetting": 0.05}),  # moved now and then, and in doubt
    ("t_maze_alias", 3, 2, {"growth": "observed"}),
    ("4x4", 0, 0, {}),  # one that has seen nothing yet
]


def begun(name: str, steps: int, displace_every: int, options: dict[str, Any]) -> tuple[MazeEnv, Agent]:
    world, rng = load_world(name), np.random.default_rng(steps)
    agent = agent_with(world.motions, look_ahead=1, **options)
    world.reset(seed=steps)
    for step in range(steps):
        world.step(agent.step(world.observe()))
        if displace_every and step % displace_every == 1:
            world.displace(world.maze.rooms[int(rng.integers(len(world.maze.rooms)))])
    return world, agent


@pytest.mark.parametrize("start", STARTS, ids=str)
def test_an_interrupt_at_any_line_leaves_the_agent_before_the_step_or_after_it(start: Any) -> None:
    world, agent = begun(*start)
    seen, rng = world.observe(), random.Random(1)
    twin = copy.deepcopy(agent)
    before, action, after = content(agent), twin.step(seen), content(twin)
    lines = lines_of(lambda: copy.deepcopy(agent).step(seen))
    for trial in range(8):
        torn = copy.deepcopy(agent)
        stopped = was_interrupted(lambda torn=torn: torn.step(seen), rng.randrange(1, lines + 1))
        if not stopped or content(torn) == after:
            assert content(torn) == after
        else:
            assert content(torn) == before
            assert torn.step(seen) == action
            assert content(torn) == after
            assert len(torn.trace) == agent.steps + 1
        if trial == 0:
            elsewhere = copy.deepcopy(world)
            for _ in range(5):
                elsewhere.step(action)
                action_of_twin, action = twin.step(elsewhere.observe()), torn.step(elsewhere.observe())
                assert action == action_of_twin
            assert content(torn) == content(twin)
            twin = copy.deepcopy(agent)
            action = twin.step(seen)


def test_an_interrupt_before_the_step_has_changed_anything_undoes_nothing() -> None:
    """What the step before has noted down is not taken back instead."""
    world, agent = begun("4x4_alias", 14, 3, {})
    before, seen = content(agent), {**world.observe(), "sight": 3}
    agent.step(seen)
    assert content(agent) != before
    before = content(agent)
    for line in range(20, 420, 20):
        torn = copy.deepcopy(agent)
        assert was_interrupted(lambda torn=torn: torn.step(seen), line)
        assert content(torn) == before, line


def test_each_part_of_a_step_is_whole() -> None:
    world, agent = begun(*STARTS[0])
    seen = world.observe()
    for part in ("perceive", "plan", "act"):
        works: dict[str, Callable[[Agent], object]] = {
            "perceive": lambda agent: agent.perceive(seen),
            "plan": lambda agent: agent.plan,
            "act": lambda agent: agent.act(),
        }
        work, before = works[part], content(agent)
        lines = lines_of(lambda work=work: work(copy.deepcopy(agent)))
        for line in {1, 5, lines // 3, lines // 2} & set(range(1, lines)):
            torn = copy.deepcopy(agent)
            if was_interrupted(lambda work=work, torn=torn: work(torn), line):
                assert content(torn) == before, (part, line)
        work(agent)
        assert content(agent) != before


class Nose(Sensor):
    """Fails when it learns, after it has remembered."""

    def __init__(self) -> None:
        super().__init__("smell")
        self.seen: list[Any] = []
        self.fails = False

    def log_likelihood(self, places: Any, reading: Any) -> Any:
        return np.zeros(len(places))

    def learn(self, place: int, reading: Any, weight: float) -> None:
        self.seen.append(reading)
        if self.fails:
            raise Failing("smell")


def test_what_a_sensor_of_others_has_remembered_is_forgotten_again() -> None:
    nose = Nose()
    agent = Agent(GRID, sensors=[Sight(), Ways(), nose], settings=Settings(look_ahead=1), seed=0)
    seen = {"sight": 0, "open": [True] * 5, "smell": 1}
    agent.step(seen)
    before, nose.fails = content(agent), True
    with pytest.raises(Failing):
        agent.step({**seen, "sight": 9})
    assert content(agent) == before
    assert nose.seen == [1]
    nose.fails = False
    agent.step({**seen, "sight": 9})
    assert list(agent.map.sights) == [0, 9]
    assert nose.seen == [1, 1]


def test_any_call_of_a_part_or_an_observation_of_others_may_fail() -> None:
    world, agent = load_world("3x3_alias"), agent_of_somebody()

    def see() -> Observation:
        seen = world.observe()
        return Observation({**seen, "view": [float(seen["sight"]), 1.0]})

    world.reset(seed=0)
    for _ in range(5):
        world.step(agent.step(see()))
    CLOCK.set(None)
    twin, before = copy.deepcopy(agent), content(agent)
    action, calls, after, failed = twin.step(see()), CLOCK.calls, content(twin), set[str]()
    for call in range(1, calls + 1, 13):
        torn = copy.deepcopy(agent)
        CLOCK.set(call)
        with pytest.raises(Failing) as raised:
            torn.step(see())
        failed.add(str(raised.value))
        assert content(torn) == before, failed
        assert torn.step(see()) == action
        assert content(torn) == after
    assert len(failed) > 5


def test_an_error_of_ours_stays_the_same_and_ends_when_it_is_mended() -> None:
    agent = Agent(GRID, growth=StaticGrowth(2), settings=Settings(look_ahead=1, certainty=0.5), seed=0)
    seen, messages = [{"sight": at, "open": [True] * 5} for at in range(4)], list[str]()
    agent.perceive(seen[0])
    agent.perceive({**seen[1], "taken": "up"})
    before = content(agent)
    for _ in range(3):
        with pytest.raises(CogmapError) as raised:
            agent.perceive({**seen[2], "taken": "up"})
        messages.append(str(raised.value))
        assert content(agent) == before
    assert set(messages) == {messages[0]}
    assert "larger than its 2 places" in messages[0]
    agent.perceive({**seen[0], "taken": "down"})
    assert agent.steps == 3


class Closed(Nose):
    """Lets nobody copy what it has."""

    def __init__(self) -> None:
        super().__init__()
        self.stream = (x for x in "abc")


def test_an_agent_that_cannot_go_back_says_that_it_is_torn(tmp_path: Path) -> None:
    nose = Closed()
    agent = Agent(GRID, sensors=[Sight(), Ways(), nose], settings=Settings(look_ahead=1), seed=0)
    seen = {"sight": 0, "open": [True] * 5, "smell": 1}
    agent.step(seen)
    nose.fails = True
    with pytest.raises(Failing):
        agent.step(seen)
    message = "it is torn, left in the middle of a step by a Failing, and cannot go back"
    for refused in (lambda: agent.step(seen), lambda: agent.save(tmp_path / "map.npz"), agent.act):
        with pytest.raises(CogmapError, match=message):
            refused()
    assert not list(tmp_path.iterdir())
