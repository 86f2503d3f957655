"""An agent that knows its maze: where the experiments after exploring begin."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from ..agent import Agent, Settings
from ..worlds import GRID, Maze, MazeEnv, Position
from .exploring import draw_start, go
from .walkers import fitted


@dataclass(frozen=True, slots=True)
class Session:
    """An agent in a world, and what is true of it.

    Attributes:
        agent: after its last observation; the action it then chose has been carried out.
        world: where it is.
        start: the room that it takes as its origin.
        steps: in which it explored the maze; None where it gave up.
        rng: draws what happens next.
    """

    agent: Agent
    world: MazeEnv
    start: Position
    steps: int | None
    rng: np.random.Generator

    @property
    def true_place(self) -> int | None:
        """The place of its map that stands for the room it is in."""
        row, column = self.world.position
        return self.agent.map.place_at((row - self.start[0], column - self.start[1]))

    def displace(self, *, elsewhere: bool, but: Collection[Position] = ()) -> Position:
        """Move it to a random room without a word, `elsewhere` to another one than it is in; answers with the room.

        The rooms of `but` are left out.
        """
        here = self.world.position
        rooms = [room for room in self.world.maze.rooms if room not in but and (not elsewhere or room != here)]
        room = rooms[int(self.rng.integers(len(rooms)))]
        self.world.displace(room)
        return room


def explored(experiment: str, maze: Maze, *, settings: Settings | None, seed: int, most: int) -> Session:
    """An agent that has explored the maze, exactly as `explore` with the same seed would have.

    Raises:
        CogmapError: a negative seed.
    """
    session = unexplored(experiment, maze, settings=settings, seed=seed)
    path, (_, _, steps) = go(maze, session.start, session.agent, most)
    session.world.displace(path[-1])
    session.world.step(session.agent.plan.action)
    return Session(session.agent, session.world, session.start, steps, session.rng)


def unexplored(experiment: str, maze: Maze, *, settings: Settings | None, seed: int) -> Session:
    """An agent that has seen nothing yet, in the room where `explore` with the same seed would start.

    Raises:
        CogmapError: a negative seed.
    """
    start, for_agent, rng = draw_start(experiment, maze, seed)
    agent = Agent(GRID, settings=fitted(settings or Settings(), maze), seed=int(for_agent.generate_state(1)[0]))
    world = MazeEnv(maze)
    world.reset(options={"start": start})
    return Session(agent, world, start, None, rng)


def mean(values: Sequence[int]) -> float | None:
    """The mean; None of nothing."""
    return float(np.mean(values)) if values else None


def std(values: Sequence[int]) -> float | None:
    """The standard deviation (population); None of nothing."""
    return float(np.std(values)) if values else None
