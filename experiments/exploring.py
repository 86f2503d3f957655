"""Exploring a maze from a random room: how many steps until all of it is known?"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from time import perf_counter
from typing import Any

import numpy as np

from ..agent import Agent, Settings
from ..model.errors import CogmapError
from ..worlds import Maze, MazeEnv, Position
from .knowledge import Truth
from .oracle import frontier_steps, oracle_steps
from .walkers import Walker, check_agent, fitted, make_walker

Watch = Callable[[int, int], None]
"""Called after every observation with the steps made and the rooms visited."""


@dataclass(frozen=True, slots=True)
class ExploreRun:
    """One exploration. Steps are moves made when the condition first held; None where it never did.

    Attributes:
        seed: of the start room and of the agent.
        start: the first room.
        steps_to_visit_all: until every room had been entered, and the agent's map had it as visited.
        steps_to_learn: until every true transition was believed at 0.6 or more; also None for an agent that
            keeps no transitions.
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
    seconds: float
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
        finished: whether it completed, or visited every room if it keeps no transitions.
    """

    run: ExploreRun
    path: tuple[Position, ...]
    walker: Walker
    finished: bool


def explore(
    maze: Maze,
    *,
    agent: str = "cogmap",
    settings: Settings | None = None,
    seed: int = 0,
    max_steps: int | None = None,
) -> ExploreRun:
    """The figures of `walk`."""
    return walk(maze, agent=agent, settings=settings, seed=seed, max_steps=max_steps).run


def walk(
    maze: Maze,
    *,
    agent: str = "cogmap",
    settings: Settings | None = None,
    seed: int = 0,
    max_steps: int | None = None,
    watch: Watch | None = None,
) -> Walk:
    """Let an agent explore until it is done or out of steps.

    Args:
        maze: the layout, everything open.
        agent: a name in `AGENTS`.
        settings: of the agent; static growth gets the number of rooms.
        seed: of the start room and of the agent, which get streams of their own.
        max_steps: moves after which to give up, `default_steps(maze)` unless given.
        watch: is told how far it is.

    Raises:
        CogmapError: unknown agent, a negative seed, or `max_steps` below 1.
    """
    check_agent(agent)
    most = checked_steps("explore", maze, max_steps)
    start, for_agent, _ = draw_start("explore", maze, seed)
    walker = make_walker(agent, settings=fitted(settings or Settings(), maze), seed=for_agent)
    begin = perf_counter()
    path, firsts = go(maze, start, walker, most, watch)
    seconds = perf_counter() - begin
    oracle = oracle_steps(maze, start)
    instead = frontier_steps(maze, start) if oracle is None else None
    run = ExploreRun(seed, start, *firsts, oracle, seconds, instead)
    needed = "steps_to_visit_all" if _learned(Truth(maze, start), walker) is None else "steps_to_complete"
    return Walk(run, tuple(path), walker, finished=getattr(run, needed) is not None)


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
) -> tuple[list[Position], Firsts]:
    """The walk: its rooms, and the steps to visit all, to learn, and to complete."""
    world, truth = MazeEnv(maze), Truth(maze, start)
    observation, _ = world.reset(options={"start": start})
    path, entered = [start], {start}
    visit_all = learn = complete = None
    for step in range(most + 1):
        action = walker.step(observation)
        visited = len(entered) == len(maze.rooms) and _visited(truth, walker)
        learned = _learned(truth, walker)
        visit_all = step if visited and visit_all is None else visit_all
        learn = step if learned and learn is None else learn
        complete = step if visited and learned else None
        if watch is not None:
            watch(step, len(entered))
        if step == most or (visited and learned is not False):
            break
        observation, _, _, _, info = world.step(action)
        path.append(info["position"])
        entered.add(info["position"])
    return path, (visit_all, learn, complete)


def _visited(truth: Truth, walker: Walker) -> bool:
    return truth.visited(walker.map) if isinstance(walker, Agent) else True


def _learned(truth: Truth, walker: Walker) -> bool | None:
    """Whether the agent knows every transition; None if it keeps no transitions."""
    if isinstance(walker, Agent):
        return truth.learned(walker.map)
    edges = getattr(walker, "edges", None)
    return None if edges is None else truth.known(edges)
