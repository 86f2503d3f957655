"""Any agent in any world."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from cogmap.agent import Agent
from cogmap.baselines import CscgAgent, RandomAgent
from cogmap.experiments import Moment, explore, kidnap, navigate, run
from cogmap.model import CogmapError
from cogmap.worlds import GRID, WorldError, load_world
from gymnasium import spaces


class Corridor(gym.Env[dict[str, Any], Any]):
    """Three cells in a row; the episode ends at the right end if it has one."""

    action_space = spaces.Discrete(3)
    observation_space = spaces.Dict({"sight": spaces.Discrete(3), "open": spaces.MultiBinary(3)})

    def __init__(self, *, tells: bool = True, ends: bool = False) -> None:
        self.tells, self.ends, self.cell, self.taken = tells, ends, 0, list[int]()

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        super().reset(seed=seed)
        self.cell, self.taken = int(self.np_random.integers(3)) if options is None else options["start"], []
        return self._seen()

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        self.taken.append(int(action))
        self.cell = min(max(self.cell + (-1, 1, 0)[int(action)], 0), 2)
        observation, info = self._seen()
        return observation, 0.0, self.ends and self.cell == 2, False, info

    def _seen(self) -> tuple[dict[str, Any], dict[str, Any]]:
        is_open = np.array([self.cell > 0, self.cell < 2, True])
        return {"sight": self.cell, "open": is_open}, {"place": self.cell} if self.tells else {}


WAYS = {"back": (-1,), "forth": (1,), "stay": (0,)}


class Scripted:
    """Answers with given actions, and keeps what it was shown."""

    def __init__(self, *actions: int) -> None:
        self.actions, self.shown = list(actions), list[Mapping[str, Any]]()

    def step(self, observation: Mapping[str, Any]) -> int:
        self.shown.append(observation)
        return self.actions[len(self.shown) - 1]


def test_every_observation_is_answered_and_every_action_is_carried_out() -> None:
    world, agent = Corridor(), Scripted(1, 1, 0)
    done = run(world, agent, steps=3, options={"start": 0})
    assert [seen["sight"] for seen in agent.shown] == [0, 1, 2]
    assert world.taken == [1, 1, 0] == list(done.actions)
    assert (done.observations, done.truth, done.records, done.ended) == (3, (0, 1, 2), (), False)
    assert (done.end[0]["sight"], done.end[1]) == (1, {"place": 1})


def test_a_map_is_drawn_of_any_world_with_motions() -> None:
    world = Corridor()
    done = run(world, Agent(WAYS, seed=0), steps=6, seed=1)
    assert isinstance(done.agent, Agent)
    assert (len(done.agent.map.places), done.agent.map.visited.all()) == (3, True)
    assert [record.action for record in done.records] == list(done.actions)
    world.motions = done.agent.map.motions  # type: ignore[attr-defined]
    again = run(world, steps=6, seed=1)
    assert again.agent.steps == 6
    with pytest.raises(WorldError, match=r"run without an agent needs a world that is a cogmap\.worlds\.World"):
        run(Corridor(), steps=1)


def test_the_seed_settles_world_and_agent() -> None:
    first, second = (run(load_world("4x4"), steps=12, seed=5) for _ in range(2))
    assert (first.actions, first.truth) == (second.actions, second.truth)
    assert len({run(load_world("4x4"), steps=1, seed=seed).truth for seed in range(9)}) > 3


def test_a_run_goes_on_where_another_ended() -> None:
    whole = run(load_world("3x3_alias"), steps=9, seed=2)
    world = load_world("3x3_alias")
    first = run(world, steps=4, seed=2)
    second = run(world, first.agent, steps=5, begin=first.end)
    assert first.actions + second.actions == whole.actions
    assert first.truth + second.truth == whole.truth
    assert [record.step for record in second.records] == [4, 5, 6, 7, 8]


def test_whoever_watches_sees_the_choice_before_it_is_carried_out_and_may_end_the_run() -> None:
    seen: list[Moment] = []

    def watch(moment: Moment) -> bool:
        assert isinstance(moment.world, Corridor)
        assert moment.world.cell == moment.info["place"] == moment.observation["sight"]
        seen.append(moment)
        return moment.observation["sight"] == 2

    done = run(Corridor(), Scripted(1, 1, 0, 0), steps=4, options={"start": 0}, watch=watch)
    assert [(moment.step, moment.action) for moment in seen] == [(0, 1), (1, 1), (2, 0)]
    assert (done.observations, done.end[1]["place"]) == (3, 1)


def test_the_world_ends_the_run() -> None:
    done = run(Corridor(ends=True), Scripted(1, 1, 0), steps=3, options={"start": 0})
    assert (done.ended, done.actions, done.truth) == (True, (1, 1), (0, 1))


def test_a_world_that_tells_no_truth() -> None:
    assert run(Corridor(tells=False), Scripted(1, 1), steps=2).truth == ()


def test_agents_that_are_told_their_position_are_told() -> None:
    for positions in (True, False):
        agent = CscgAgent(GRID, observations=9, positions=positions, seed=0)
        assert run(load_world("3x3"), agent, steps=3, seed=0).observations == 3


def test_wrapped_worlds() -> None:
    world = gym.wrappers.TimeLimit(load_world("3x3"), max_episode_steps=4)
    done = run(world, steps=10, seed=0)
    assert (done.observations, done.ended) == (4, True)
    assert explore(gym.Wrapper(load_world("3x3")), seed=3) == explore(load_world("3x3"), seed=3)


def test_experiments_leave_the_world_as_it_is() -> None:
    world = load_world("t_maze")
    world.reset(seed=0)
    before = world.place
    assert explore(world, seed=1) == explore(world.maze, seed=1)
    assert kidnap(world, seed=1) == kidnap(world.maze, seed=1)
    assert navigate(world, 1, goal=7) == navigate(world.maze, 1, goal=7)
    assert world.place == before


def test_bad_input() -> None:
    with pytest.raises(CogmapError, match="run: steps is 0; use 1 or more"):
        run(load_world("3x3"), steps=0)
    for experiment in (explore, kidnap, lambda world: navigate(world, goal=1)):
        with pytest.raises(WorldError, match=r"HasChart.*there is cogmap\.experiments\.run\(world, agent, steps=…\)"):
            experiment(Corridor())  # type: ignore[arg-type]


def test_baselines_run_too() -> None:
    assert run(load_world("3x3"), RandomAgent(GRID, seed=0), steps=20, seed=0).observations == 20


def test_the_how_to_page_adds_a_world_from_outside() -> None:
    page = (Path(__file__).parent.parent / "docs" / "howto" / "add_a_world.md").read_text("utf-8")
    names: dict[str, Any] = {"__name__": "page"}
    for block in re.findall(r"^```python\n(.*?)^```", page, re.M | re.S):
        exec(compile(block, "add_a_world.md", "exec"), names)
    assert len(names["done"].agent.map.places) == 6
    world = names["KnownHouse"]()
    assert explore(world, 2).steps_to_complete is not None
    assert navigate(world, 2, goal="bath", known=False, agent="frontier").reached
    with pytest.raises(WorldError, match="HasChart"):
        explore(names["House"]())
