"""A frame that may turn: the turn is inferred with the place, and the map is left as it was."""

from __future__ import annotations

import copy
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent, Settings, TurningAgent
from cogmap.agent.storage import write
from cogmap.body import embodied, load_embodied
from cogmap.experiments import kidnap, navigate
from cogmap.model import UNSEEN, CogmapError, Features, Ways
from cogmap.worlds import GRID, load_world
from interrupts import content, lines_of, was_interrupted

TURNED = ("up", "right", "down", "left")


class Turned:
    """A plain maze whose directions are called by a body that was turned by quarters."""

    def __init__(self, name: str, seed: int) -> None:
        self.world, self.turn = load_world(name), 0
        self.seen, _ = self.world.reset(seed=seed)

    def called(self, name: str) -> str:
        return name if name == "stay" else TURNED[(TURNED.index(name) + self.turn) % 4]

    def observe(self) -> dict[str, Any]:
        told = dict(zip(GRID.names, self.seen["open"], strict=True))
        return {"sight": self.seen["sight"], "open": [told[self.called(name)] for name in GRID.names]}

    def step(self, action: int) -> None:
        self.seen, *_ = self.world.step(GRID.names.index(self.called(GRID.names[action])))


@pytest.mark.parametrize("turn", [0, 1, 2, 3])
@pytest.mark.parametrize("name", ["3x3", "4x4_alias"])
def test_the_turn_is_inferred_and_the_map_is_left_alone(name: str, turn: int) -> None:
    world = Turned(name, 1)
    start, agent = world.world.unwrapped.position, TurningAgent(GRID, seed=1)
    for _ in range(30):
        world.step(agent.step(world.observe()))
    places = len(agent.map.places)
    assert places == len(world.world.maze.rooms)
    world.turn, world.seen = turn, world.world.displace((1, 1))
    for _ in range(8):
        world.step(agent.step(world.observe()))
    agent.step(world.observe())
    row, column = world.world.unwrapped.position
    assert (agent.turn, agent.searching, len(agent.map.places)) == (turn, False, places)
    assert agent.belief.place == agent.map.place_at((row - start[0], column - start[1]))


def test_undisturbed_it_is_an_agent() -> None:
    worlds, agents = [Turned("3x3_alias", 0) for _ in range(2)], [TurningAgent(GRID, seed=0), Agent(GRID, seed=0)]
    for _ in range(15):
        actions = [agent.step(world.observe()) for agent, world in zip(agents, worlds, strict=True)]
        assert actions[0] == actions[1]
        for world, action in zip(worlds, actions, strict=True):
            world.step(action)


def test_vectors_are_learned_from_once() -> None:
    rng, kinds = np.random.default_rng(0), np.random.default_rng(1).normal(size=(9, 8))
    world, seen = Turned("3x3", 0), dict[str, Any]()
    views = [Features("view", size=8), Features("view", size=8)]
    turning = TurningAgent(GRID, sensors=[views[0], Ways()], seed=0)
    plain = Agent(GRID, sensors=[views[1], Ways()], seed=0)
    for _ in range(20):
        told = world.observe()
        seen = {"open": told["open"], "view": kinds[told["sight"]] + 0.2 * rng.normal(size=8)}
        assert turning.step(seen) == plain.step(seen)
        world.step(turning._state.action)
    np.testing.assert_array_equal([*views[0].prototypes.values()], [*views[1].prototypes.values()])
    assert len(views[0].prototypes) == 9


def test_nothing_seen_and_nowhere_known_are_no_reasons_to_turn() -> None:
    world, agent = Turned("3x3", 0), TurningAgent(GRID, seed=0)
    for _ in range(20):
        world.step(agent.step(world.observe()))
    world.step(agent.step({"sight": UNSEEN, "open": [None] * 5}))
    assert agent.turn == 0
    agent.step({"sight": "never seen", "open": [True, False, False, False, True]})
    assert (agent.turn, agent.searching) == (0, False)


def test_it_needs_a_plane() -> None:
    with pytest.raises(CogmapError, match="needs actions in a plane"):
        TurningAgent({"left": (-1,), "right": (1,), "stay": (0,)})


def test_bodies_put_elsewhere_with_another_heading() -> None:
    world = load_embodied("3x4", white=True, seed=1, turned=True)
    found = navigate(world, 1, goal="white")
    assert found.reached
    assert found.low_level_oracle is not None
    assert found.low_level_steps is not None
    assert found.low_level_steps <= 4 * found.low_level_oracle
    moved = kidnap(embodied("4x4_alias", turned=True), 3)
    assert (moved.recovered, moved.map_intact, moved.steps_certain_but_wrong) == (True, True, 0)
    assert np.isfinite(moved.steps_to_recover or 0)


@cache
def _walked() -> tuple[Turned, TurningAgent]:
    world, agent = Turned("3x3_alias", 1), TurningAgent(GRID, settings=Settings(look_ahead=2), seed=1)
    for step in range(26):
        if step == 18:
            world.turn, world.seen = 1, world.world.displace((1, 1))
        world.step(agent.step(world.observe()))
    assert agent.turn == 1
    return world, agent


def walked() -> tuple[Turned, TurningAgent]:
    """One whose frame has turned."""
    return copy.deepcopy(_walked())


def test_a_turn_that_was_measured_turns_the_frame() -> None:
    world, agent = Turned("4x4_alias", 1), TurningAgent(GRID, seed=1)
    for _ in range(30):
        world.step(agent.step(world.observe()))
    for degrees in (90, -10, 185, 80.5):
        world.turn = (world.turn + round(degrees / 90)) % 4
        world.step(agent.step({**world.observe(), "turn": degrees}))
        assert (agent.turn, agent.searching, agent.belief.moved < 0.1) == (world.turn, False, True)
    assert len(agent.map.places) == 16


def test_an_agent_whose_frame_does_not_turn_says_so() -> None:
    agent, seen = Agent(GRID, seed=0), {"sight": 0, "open": [True] * 5}
    agent.step({**seen, "turn": 0.0})
    with pytest.raises(CogmapError, match=r"'turn' is 90\.0, and the frame of this agent does not turn; leave it out"):
        agent.step({**seen, "turn": 90})
    assert agent.steps == 1


def test_a_turned_agent_is_saved_and_walks_on_as_it_would_have(tmp_path: Path) -> None:
    world, agent = walked()
    for room in world.world.maze.rooms:
        world.turn, world.seen = 3, world.world.displace(room)
        world.step(agent.step(world.observe()))
        if agent.searching:
            break
    assert agent.searching
    agent.save(tmp_path / "map.npz")
    other = TurningAgent.load(tmp_path / "map.npz")
    assert (other.turn, other.searching) == (agent.turn, True)
    for _ in range(6):
        action = agent.step(world.observe())
        assert other.step(world.observe()) == action
        world.step(action)
    with pytest.raises(CogmapError, match=r"use TurningAgent\.load"):
        Agent.load(tmp_path / "map.npz")


@pytest.mark.parametrize("told", [{"turn": 4}, {"turn": True}, {"done": 9}, {"sought": [[1.0]]}, {"sought": "x"}])
def test_turns_that_are_none_are_refused(told: dict[str, Any], tmp_path: Path) -> None:
    header, arrays = walked()[1].state()
    header["turning"] |= told
    write(tmp_path / "map.npz", header, arrays)
    with pytest.raises(CogmapError, match="is damaged"):
        TurningAgent.load(tmp_path / "map.npz")


def test_a_step_of_it_is_whole() -> None:
    world, agent = walked()
    world.turn = 3
    seen = {**world.observe(), "turn": 90}
    before = content(agent), agent.state()[0]["turning"]
    lines, undone = lines_of(lambda: copy.deepcopy(agent).step(seen)), 0
    for line in range(3, lines, lines // 5):
        torn = copy.deepcopy(agent)
        if was_interrupted(lambda torn=torn: torn.step(seen), line):
            assert (content(torn), torn.state()[0]["turning"]) == before, line
            undone += 1
    assert undone > 2
