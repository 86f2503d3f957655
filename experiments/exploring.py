"""Exploring a maze from a random room: how many steps until all of it is known?"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from time import perf_counter
from typing import Any

import numpy as np

from ..agent import Settings
from ..baselines import CscgSettings
from ..model.errors import CogmapError
from ..worlds import Maze, MazeEnv, Position
from .knowledge import Truth
from .oracle import frontier_steps, oracle_steps
from .walkers import Seeker, Walker, check_agent, make_walker, sensed

Watch = Callable[[Walker, MazeEnv, int], None]
"""Called after every choice, before it is carried out, with the agent, the world, and the number of rooms entered."""


@dataclass(frozen=True, slots=True)
class ExploreRun:
    """One exploration. Steps are moves made when the condition first held; None where it never did.

    Attributes:
        seed: of the start room and of the agent.
        start: the first room.
        steps_to_visit_all: until every room had been entered, and the agent's map had it as visited.
        steps_to_learn: until every true transition was believed at 0.6 or more.
        steps_to_complete: until both held at once.
        oracle_steps: of the shortest walk through all rooms; None where it is out of reach.
        seconds: of the walk, the oracle left out.
        frontier_steps: of nearest-frontier search, only where the oracle is out of reach.
    """

    seed: int
    start: Position
    steps_to_visit_all: int | None
    steps_to_learn: int | None
    steps_to_complete: int | None
    oracle_steps: int | None
    seconds: float = field(compare=False)
    frontier_steps: int | None = None

    def to_dict(self) -> dict[str, Any]:
        """The run as plain JSON values."""
        row = {**asdict(self), "start": list(self.start), "seconds": round(self.seconds, 4)}
        if self.frontier_steps is None:
            del row["frontier_steps"]
        return row


@dataclass(frozen=True, slots=True)
class Walk:
    """One exploration with all that it leaves behind.

    Attributes:
        run: its figures.
        path: the true rooms, the start first.
        walker: the agent, after its last observation.
    """

    run: ExploreRun
    path: tuple[Position, ...]
    walker: Seeker

    @property
    def finished(self) -> bool:
        """Whether it completed."""
        return self.run.steps_to_complete is not None


def explore(
    maze: Maze,
    *,
    agent: str = "cogmap",
    settings: Settings | None = None,
    cscg: CscgSettings | None = None,
    seed: int = 0,
    max_steps: int | None = None,
) -> ExploreRun:
    """The figures of `walk`."""
    return walk(maze, agent=agent, settings=settings, cscg=cscg, seed=seed, max_steps=max_steps).run


def walk(
    maze: Maze,
    *,
    agent: str = "cogmap",
    settings: Settings | None = None,
    cscg: CscgSettings | None = None,
    seed: int = 0,
    max_steps: int | None = None,
    watch: Watch | None = None,
) -> Walk:
    """Let an agent explore until it is done or out of steps.

    Args:
        maze: the layout, everything open.
        agent: a name in `AGENTS`.
        settings: of the agent `cogmap`; static growth gets the number of rooms.
        cscg: settings of the clone-structured graphs.
        seed: of the start room and of the agent, which get streams of their own.
        max_steps: moves after which to give up, `default_steps(maze)` unless given.
        watch: looks on.

    Raises:
        CogmapError: unknown agent, a negative seed, or `max_steps` below 1.
    """
    check_agent(agent)
    most = checked_steps("explore", maze, max_steps)
    start, for_agent, _ = draw_start("explore", maze, seed)
    walker = make_walker(agent, maze, settings=settings, cscg=cscg, seed=for_agent)
    begin = perf_counter()
    path, _, firsts = go(maze, start, walker, most, watch)
    seconds = perf_counter() - begin
    oracle = oracle_steps(maze, start)
    instead = frontier_steps(maze, start) if oracle is None else None
    return Walk(ExploreRun(seed, start, *firsts, oracle, seconds, instead), tuple(path), walker)


def default_steps(maze: Maze) -> int:
    """Moves after which an exploration counts as failed, unless told otherwise."""
    return 50 * len(maze.rooms) + 50


def checked_steps(experiment: str, maze: Maze, max_steps: int | None) -> int:
    """`max_steps`, or `default_steps(maze)` where it is None.

    Raises:
        CogmapError: it is below 1.
    """
    most = default_steps(maze) if max_steps is None else max_steps
    if most < 1:
        raise CogmapError(f"{experiment}: max_steps is {most}; use 1 or more")
    return most


def draw_start(experiment: str, maze: Maze, seed: int) -> tuple[Position, np.random.SeedSequence, np.random.Generator]:
    """What a seed settles: the start room, the stream of the agent, and draws of what happens to it later.

    Raises:
        CogmapError: `seed` is below 0.
    """
    if seed < 0:
        raise CogmapError(f"{experiment}: seed is {seed}; use 0 or more")
    for_start, for_agent, later = np.random.SeedSequence(seed).spawn(3)
    start = maze.rooms[int(np.random.default_rng(for_start).integers(len(maze.rooms)))]
    return start, for_agent, np.random.default_rng(later)


Firsts = tuple[int | None, int | None, int | None]


def go(
    maze: Maze, start: Position, walker: Walker, most: int, watch: Watch | None = None
) -> tuple[list[Position], int, Firsts]:
    """The walk: its rooms, the action chosen last, and the steps to visit all, to learn, and to complete."""
    world, truth = MazeEnv(maze), Truth(maze, start)
    number = {room: i for i, room in enumerate(maze.rooms)}
    observation, _ = world.reset(options={"start": start})
    path, rooms, entered, step = [start], [number[start]], {start}, 0
    visit_all = learn = complete = None
    while True:
        action = walker.step(sensed(walker, observation, path[-1]))
        visited, learned = truth.visited_by(walker, len(entered)), truth.learned_by(walker, rooms)
        visit_all = step if visited and visit_all is None else visit_all
        learn = step if learned and learn is None else learn
        complete = step if visited and learned else None
        if watch is not None:
            watch(walker, world, len(entered))
        if step == most or complete is not None:
            return path, action, (visit_all, learn, complete)
        observation, _, _, _, info = world.step(action)
        path.append(info["position"])
        rooms.append(number[info["position"]])
        entered.add(info["position"])
        step += 1
