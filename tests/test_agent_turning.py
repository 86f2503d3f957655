"""A frame that may turn: the turn is inferred with the place, and the map is left as it was."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent, TurningAgent
from cogmap.body import embodied, load_embodied
from cogmap.experiments import kidnap, navigate
from cogmap.model import UNSEEN, CogmapError
from cogmap.worlds import GRID, load_world

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
