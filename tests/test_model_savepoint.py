"""A model goes back to how it was, wherever a change was broken off."""

from __future__ import annotations

import copy
import random
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent
from cogmap.model import CognitiveMap, Lattice, Motions, Sensor, Sight, Ways, map_state
from cogmap.model.savepoint import go_back, release, savepoint
from cogmap.worlds import load_world
from interrupts import lines_of, was_interrupted
from parts import agent_with
from walks import GRID, assert_map_is_sound


def walked(name: str, seed: int, **options: Any) -> tuple[Agent, dict[str, Any]]:
    """An agent that was moved now and then, and met what it never saw; and its next observation."""
    world, rng = load_world(name), np.random.default_rng(seed)
    agent = agent_with(world.motions, seed=seed, look_ahead=1, **options)
    observation, _ = world.reset(seed=seed)
    for step in range(5 + 3 * seed):
        action = agent.step(observation)
        world.step(action)
        if rng.random() < 0.2:
            world.displace(world.maze.rooms[int(rng.integers(len(world.maze.rooms)))])
        observation = world.observe()
        if rng.random() < 0.2:
            observation = {**observation, "sight": step + 100}
    return agent, observation


def assert_same(one: tuple[Any, Any], other: tuple[Any, Any]) -> None:
    assert one[0] == other[0]
    assert one[1].keys() == other[1].keys()
    for name, values in one[1].items():
        np.testing.assert_array_equal(values, other[1][name], err_msg=name)


@pytest.mark.parametrize("seed", range(6))
def test_a_step_that_is_broken_off_leaves_no_trace_in_the_map(seed: int) -> None:
    growth, rng = ("predicted", "observed", "static")[seed % 3], random.Random(seed)
    agent, observation = walked("4x4_alias", seed, growth=growth, forgetting=0.05 * (seed % 2))
    lines = lines_of(lambda: copy.deepcopy(agent).perceive(observation))
    trials = 0
    for _ in range(12):
        torn = copy.deepcopy(agent)
        before, point = map_state(torn.map), savepoint(torn.map)
        if not was_interrupted(lambda torn=torn: torn.perceive(observation), rng.randrange(1, lines + 1)):
            continue
        trials += 1
        go_back(torn.map, point)
        assert_same(map_state(torn.map), before)
        assert_map_is_sound(torn.map)
    assert trials >= 6


def test_a_whole_step_can_be_taken_back_and_done_again() -> None:
    agent, observation = walked("3x3_alias", 3)
    torn, twin = copy.deepcopy(agent), copy.deepcopy(agent)
    point = savepoint(torn.map)
    torn.perceive(observation)
    go_back(torn.map, point)
    again, point = copy.deepcopy(agent), None
    again.map = torn.map
    twin.perceive(observation)
    release(twin.map)
    assert_same(map_state(again.map), map_state(agent.map))


class Counting(Sensor):
    """Remembers on its own."""

    def __init__(self) -> None:
        super().__init__("smell")
        self.seen: list[Any] = []

    def log_likelihood(self, places: Any, reading: Any) -> Any:
        return np.zeros(len(places))

    def learn(self, place: int, reading: Any, weight: float) -> None:
        self.seen.append(reading)


class Closed(Counting):
    """Lets nobody copy what it has."""

    def __init__(self) -> None:
        super().__init__()
        self.stream = (x for x in "abc")


def test_what_a_sensor_of_ones_own_remembers_goes_back_too() -> None:
    map_ = CognitiveMap(Motions.of(GRID), sensors=[Sight(), Ways(), Counting()], pose=Lattice())
    place = map_.new_place((0, 0), step=0)
    map_.learn(place, {"smell": 1}, 1.0)
    point = savepoint(map_)
    map_.learn(place, {"smell": 2}, 1.0)
    map_.sensors["smell"].more = 3  # type: ignore[attr-defined]
    go_back(map_, point)
    assert map_.sensors["smell"].seen == [1]  # type: ignore[attr-defined]
    assert not hasattr(map_.sensors["smell"], "more")


def test_what_cannot_be_copied_is_said() -> None:
    map_ = CognitiveMap(Motions.of(GRID), sensors=[Sight(), Ways(), Closed()], pose=Lattice())
    point = savepoint(map_)
    with pytest.raises(ValueError, match="smell: a Closed has attributes that cannot be copied"):
        go_back(map_, point)
