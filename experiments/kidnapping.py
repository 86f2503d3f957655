"""Kidnapping: moved without a word in a known maze, how soon does an agent know where it is?"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any

from ..agent import Settings
from ..model.errors import CogmapError
from ..worlds import Maze, Position
from .exploring import checked_steps
from .knowledge import Truth
from .pool import map_seeds
from .session import Session, explored, mean, std
from .walkers import fitted

AFTER = 20
"""Steps that a run goes on after recovery, before the map is checked."""


@dataclass(frozen=True, slots=True)
class KidnapRun:
    """One kidnapping. Where the maze was not explored within the steps allowed, nobody was moved.

    Attributes:
        seed: of the start room, of the agent, and of where it was moved to.
        start: the first room.
        steps_to_explore: before it was moved; None where it gave up, and all below is None but `recovered`.
        moved_to: the room in which it found itself; another one than its own.
        recovered: whether it was certain (by its own threshold) of the true place in time.
        steps_to_recover: steps until then, 0 at the first observation after the move; None if never.
        steps_certain_but_wrong: observations after the move, to the end of the run, at which it was certain of
            another place.
        map_intact: whether at the end no place was added and every true transition was still believed at 0.6 or more.
    """

    seed: int
    start: Position
    steps_to_explore: int | None
    moved_to: Position | None
    recovered: bool
    steps_to_recover: int | None
    steps_certain_but_wrong: int | None
    map_intact: bool | None

    def to_dict(self) -> dict[str, Any]:
        """The run as plain JSON values."""
        moved_to = None if self.moved_to is None else list(self.moved_to)
        return {**asdict(self), "start": list(self.start), "moved_to": moved_to}


def kidnap(maze: Maze, *, settings: Settings | None = None, seed: int = 0, max_steps: int | None = None) -> KidnapRun:
    """Let an agent explore, move it to another random room without a word, reset nothing, and let it go on.

    Args:
        maze: the layout, everything open.
        settings: of the agent; static growth gets the number of rooms.
        seed: of everything random; exploring goes as in `explore` with the same seed.
        max_steps: moves after which to give up exploring, and again recovering; `default_steps(maze)` unless given.

    Raises:
        CogmapError: the maze has one room only, a negative seed, or `max_steps` below 1.
    """
    check_kidnap(maze)
    most = checked_steps("kidnap", maze, max_steps)
    session = explored("kidnap", maze, settings=settings, seed=seed, most=most)
    if session.steps is None:
        return KidnapRun(seed, session.start, None, None, False, None, None, None)
    places = len(session.agent.map.places)
    moved_to = session.displace(elsewhere=True)
    steps, wrong = _recover(session, most)
    intact = len(session.agent.map.places) == places and Truth(maze, session.start).learned(session.agent.map)
    return KidnapRun(seed, session.start, session.steps, moved_to, steps is not None, steps, wrong, intact)


def check_kidnap(maze: Maze) -> None:
    """Refuse a maze in which nobody can be moved.

    Raises:
        CogmapError: the maze has one room only.
    """
    if len(maze.rooms) < 2:
        raise CogmapError(f"kidnap: maze {maze.name!r} has one room, so there is no other to move to; use a larger one")


def kidnap_many(
    maze: Maze,
    *,
    runs: int,
    settings: Settings | None = None,
    seed: int = 0,
    max_steps: int | None = None,
    executor: Executor | None = None,
    on_done: Callable[[], None] | None = None,
) -> list[KidnapRun]:
    """Runs with the seeds `seed`, `seed + 1`, ...; the result does not depend on `executor`.

    Raises:
        CogmapError: `runs` is below 1, or what `kidnap` and `map_tasks` raise.
    """
    one = partial(_one, maze, settings, max_steps)
    return map_seeds(one, runs=runs, seed=seed, executor=executor, on_done=on_done)


def kidnap_result(
    maze: Maze, runs: Sequence[KidnapRun], *, settings: Settings, max_steps: int | None = None
) -> dict[str, Any]:
    """World, agent, settings, runs and summary, as plain JSON values; means are over the runs that got there."""
    steps = [run.steps_to_recover for run in runs if run.steps_to_recover is not None]
    wrong = [run.steps_certain_but_wrong for run in runs if run.steps_certain_but_wrong is not None]
    summary = {
        "runs": len(runs),
        "explored": sum(run.steps_to_explore is not None for run in runs),
        "recovered": sum(run.recovered for run in runs),
        "map_intact": sum(run.map_intact is True for run in runs),
        "max_steps": checked_steps("kidnap", maze, max_steps),
        "mean_steps_to_recover": mean(steps),
        "std_steps_to_recover": std(steps),
        "most_steps_to_recover": max(steps, default=None),
        "mean_steps_certain_but_wrong": mean(wrong),
    }
    return {
        "world": maze.name,
        "agent": "cogmap",
        "settings": fitted(settings, maze).to_dict(),
        "runs": [run.to_dict() for run in runs],
        "summary": summary,
    }


def _one(maze: Maze, settings: Settings | None, max_steps: int | None, seed: int) -> KidnapRun:
    return kidnap(maze, settings=settings, seed=seed, max_steps=max_steps)


def _recover(session: Session, most: int) -> tuple[int | None, int]:
    """Steps until certain and right, and how often certain but wrong, `AFTER` steps longer."""
    agent, world = session.agent, session.world
    recovered, wrong = None, 0
    for step in range(most + AFTER + 1):
        action = agent.step(world.observe())
        right = agent.belief.place == session.true_place
        wrong += agent.certain and not right
        if recovered is None and agent.certain and right:
            recovered = step
        if step == (most if recovered is None else recovered + AFTER):
            break
        world.step(action)
    return recovered, wrong
