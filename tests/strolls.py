"""Agents to draw: half-way through a maze, done with it, and put elsewhere."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

from cogmap.agent import Agent
from cogmap.views import GrowthFrames
from cogmap.worlds import GRID, MAZES, MazeEnv, Position


@dataclass(frozen=True)
class Stroll:
    """An agent, the rooms it walked through, and its map at every step."""

    agent: Agent
    path: list[Position]
    frames: GrowthFrames


@lru_cache
def stroll(name: str, start: Position, steps: int, moved_to: Position | None = None) -> Stroll:
    """`steps` observations; before the last of them the agent is put into `moved_to` without a word."""
    world, frames = MazeEnv(MAZES[name]), GrowthFrames()
    observation, _ = world.reset(options={"start": start})
    agent, path = Agent(GRID, seed=0), [start]
    for step in range(steps):
        action = agent.step(observation)
        frames.add(agent)
        if step < steps - 1:
            observation, _, _, _, info = world.step(action)
            path.append(info["position"])
        if step == steps - 2 and moved_to is not None:
            world.displace(moved_to)
            observation = world.observe()
            path[-1] = moved_to
    return Stroll(agent, path, frames)


def half_way() -> Stroll:
    """In Tolman's maze, with places imagined and policies that differ."""
    return stroll("tolman", (6, 2), 9)


def split() -> Stroll:
    """Tolman's maze known, and put where two rooms look alike."""
    return stroll("tolman", (6, 2), 36, (3, 1))


def small() -> Stroll:
    """All of 3x3_alias known."""
    return stroll("3x3_alias", (1, 1), 9)


def aliased() -> Stroll:
    """4x4_alias known, and put where two rooms look alike."""
    return stroll("4x4_alias", (0, 0), 21, (1, 2))
