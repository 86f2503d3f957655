"""How few steps would do: the exact oracle, or nearest-frontier search where it is out of reach."""

from __future__ import annotations

from functools import lru_cache

from ..baselines import FrontierAgent
from ..worlds import Maze, MazeEnv, Position, covering_steps

EFFORT = 4_000_000  # search states times rooms squared: some seconds


@lru_cache(maxsize=4096)
def oracle_steps(maze: Maze, start: Position) -> int | None:
    """Steps of the shortest walk from `start` that visits every room; None where it is out of reach."""
    return covering_steps(maze, start, limit=max(1, EFFORT // len(maze.rooms) ** 2))


@lru_cache(maxsize=4096)
def frontier_steps(maze: Maze, start: Position) -> int:
    """Steps in which nearest-frontier search visits every room, its draws settled by seed 0."""
    world = MazeEnv(maze)
    observation, info = world.reset(options={"start": start})
    agent = FrontierAgent(world.motions, seed=0)
    left, steps = set(maze.rooms) - {start}, 0
    while left:
        observation, _, _, _, info = world.step(agent.step(observation))
        left.discard(info["position"])
        steps += 1
    return steps
