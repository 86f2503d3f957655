"""Random walks, 200 with --study: small mazes that change, silent moves, lies; what must hold after every step."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent
from cogmap.worlds import MazeEnv
from cogmap.worlds.generate import random_maze
from parts import agent_with
from walks import assert_agent_is_sound

from cogmap import UNSEEN

WALKS, FEW, BATCHES, STEPS = 200, 30, 10, 18


def drawn(rng: np.random.Generator) -> tuple[MazeEnv, Agent]:
    """A maze of 2 to 10 rooms, and an agent whose evidence fades in one walk of three."""
    sights = [None, 2, 3, 5][int(rng.integers(4))]
    world = MazeEnv(random_maze(int(rng.integers(2, 11)), sights=sights, rng=rng))
    settings: dict[str, Any] = {
        "look_ahead": int(rng.integers(2, 4)),
        "growth": str(rng.choice(["predicted", "predicted", "observed"])),
        "choice": str(rng.choice(["outward", "best", "sampled"])),
        "forgetting": float(rng.choice([0.0, 0.0, rng.uniform(0.0, 0.5)])),
    }
    agent = agent_with(world.motions, **settings, seed=int(rng.integers(1 << 30)))
    if rng.random() < 0.3:
        agent.prefer({int(rng.integers(5)): float(rng.uniform(-3.0, 6.0))})
    world.reset(seed=int(rng.integers(1 << 30)))
    return world, agent


def change(world: MazeEnv, rng: np.random.Generator) -> None:
    """Now and then a room is shut or opened, or the agent moved."""
    room = world.maze.rooms[int(rng.integers(len(world.maze.rooms)))]
    chance = rng.random()
    if chance < 0.1 and room != world.position:
        world.close_room(room)
    elif chance < 0.2:
        world.open_room(room)
    elif chance < 0.3 and room not in world.closed_rooms:
        world.displace(room)


def lied(seen: dict[str, Any], rng: np.random.Generator) -> dict[str, Any]:
    """Now and then a sight or the doors are not what they are."""
    chance = rng.random()
    if chance < 0.1:
        return {**seen, "sight": [0, 1, UNSEEN, "never", int(rng.integers(1 << 20))][int(rng.integers(5))]}
    if chance < 0.2:
        return {**seen, "open": [*(rng.random(4) < 0.5).tolist(), True]}
    return seen


@pytest.mark.parametrize("batch", range(BATCHES))
def test_every_step_of_random_walks_is_sound(batch: int, study: bool) -> None:
    for seed in range(batch, WALKS if study else FEW, BATCHES):
        rng = np.random.default_rng(seed)
        world, agent = drawn(rng)
        for _ in range(STEPS):
            action = agent.step(lied(world.observe(), rng))
            assert_agent_is_sound(agent)
            assert 0.0 < agent.belief.certainty <= 1.0 + 1e-12, (seed, agent.steps)
            assert world.action_space.contains(action), (seed, agent.steps)
            world.step(action)
            change(world, rng)
