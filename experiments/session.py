"""An agent that knows its maze: where the experiments after exploring begin."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from ..agent import Agent, Settings
from ..baselines import CscgSettings
from ..worlds import GRID, Maze, MazeEnv, Position
from .exploring import Watch, draw_start, go
from .walkers import Seeker, fitted, make_walker


@dataclass(frozen=True, slots=True)
class Outing:
    """An agent of any kind in a world.

    Attributes:
        agent: before its first step, or after its last observation; the action it then chose has been carried out.
        world: where it is.
        start: the room that it takes as its origin.
        steps: in which it explored the maze; None where it gave up.
        rng: draws what happens next.
    """

    agent: Seeker
    world: MazeEnv
    start: Position
    steps: int | None
    rng: np.random.Generator

    def displace(self, *, elsewhere: bool, but: Collection[Position] = ()) -> Position:
        """Move it to a random room without a word, `elsewhere` to another one than it is in; answers with the room.

        The rooms of `but` are left out.
        """
        here = self.world.position
        rooms = [room for room in self.world.maze.rooms if room not in but and (not elsewhere or room != here)]
        room = rooms[int(self.rng.integers(len(rooms)))]
        self.world.displace(room)
        return room


@dataclass(frozen=True, slots=True)
class Session(Outing):
    """An agent with a map in a world, and what is true of it."""

    agent: Agent

    @property
    def true_place(self) -> int | None:
        """The place of its map that stands for the room it is in."""
        row, column = self.world.position
        return self.agent.map.place_at((row - self.start[0], column - self.start[1]))


AnyOuting = TypeVar("AnyOuting", bound=Outing)


def explored(experiment: str, maze: Maze, *, settings: Settings | None, seed: int, most: int) -> Session:
    """An agent that has explored the maze, exactly as `explore` with the same seed would have.

    Raises:
        CogmapError: a negative seed.
    """
    return walked(unexplored(experiment, maze, settings=settings, seed=seed), most)


def unexplored(experiment: str, maze: Maze, *, settings: Settings | None, seed: int) -> Session:
    """An agent that has seen nothing yet, in the room where `explore` with the same seed would start.

    Raises:
        CogmapError: a negative seed.
    """
    start, for_agent, rng = draw_start(experiment, maze, seed)
    agent = Agent(GRID, settings=fitted(settings or Settings(), maze), seed=int(for_agent.generate_state(1)[0]))
    return Session(agent, _world(maze, start), start, None, rng)


def outing(
    experiment: str, maze: Maze, *, agent: str, settings: Settings | None, cscg: CscgSettings | None, seed: int
) -> Outing:
    """The same with any agent of `AGENTS`.

    Raises:
        CogmapError: a negative seed, or no agent has this name.
    """
    start, for_agent, rng = draw_start(experiment, maze, seed)
    walker = make_walker(agent, maze, settings=settings, cscg=cscg, seed=for_agent)
    return Outing(walker, _world(maze, start), start, None, rng)


def walked(outing: AnyOuting, most: int, watch: Watch | None = None) -> AnyOuting:
    """The same after exploring, for `most` steps if it does not complete before."""
    path, action, (_, _, steps) = go(outing.world.maze, outing.start, outing.agent, most, watch)
    outing.world.displace(path[-1])
    outing.world.step(action)
    return replace(outing, steps=steps)


def mean(values: Sequence[int]) -> float | None:
    """The mean; None of nothing."""
    return float(np.mean(values)) if values else None


def std(values: Sequence[int]) -> float | None:
    """The standard deviation (population); None of nothing."""
    return float(np.std(values)) if values else None


def _world(maze: Maze, start: Position) -> MazeEnv:
    world = MazeEnv(maze)
    world.reset(options={"start": start})
    return world
