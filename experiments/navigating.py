"""Navigating: how far does an agent walk to a sight that it prefers, in a maze it knows or not?"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from math import inf
from typing import Any

from ..agent import Settings, StepRecord
from ..baselines import FrontierAgent
from ..model.errors import CogmapError
from ..worlds import GRID, Label, Maze, MazeEnv, Position
from .closing import check_closed, shortest
from .exploring import checked_steps, draw_start
from .pool import map_seeds
from .session import Session, explored, unexplored

WEIGHT = 8.0
"""Log preference of the goal over all other sights, in nats a step: more than a step into a room never seen can teach,
log of the number of sights and log 2 for each of its three other doors, up to 370 sights."""

MOST_LABELS = 40  # listed in an error


@dataclass(frozen=True, slots=True)
class NavigateRun:
    """One way to a goal: a room with the preferred sight in which the agent chooses to stay.

    Attributes:
        seed: of everything random.
        start: the room from which it sets out for the goal; None where it did not explore the maze in time.
        reached: whether it chose to stay in a room with the sight.
        steps: until then, that last one not counted; None if never.
        shortest: steps of the shortest path from `start` to the nearest room with the sight.
        explored_from: the room where it began to explore; None if it set out unexplored.
        steps_to_explore: None where it gave up, or set out unexplored.
        frontier_steps: of nearest-frontier search from `start` until it first stands in a room with the sight; only
            if the agent set out unexplored.
        steps_to_stand: steps until the agent first stands in a room with the sight, whatever it chooses there; None
            if never.
    """

    seed: int
    start: Position | None
    reached: bool
    steps: int | None
    shortest: int | None
    explored_from: Position | None = None
    steps_to_explore: int | None = None
    frontier_steps: int | None = None
    steps_to_stand: int | None = None

    def to_dict(self) -> dict[str, Any]:
        """The run as plain JSON values, without the fields of the other kind of run."""
        row = asdict(self)
        row["start"] = None if self.start is None else list(self.start)
        if self.explored_from is None:
            del row["explored_from"], row["steps_to_explore"]
        else:
            row["explored_from"] = list(self.explored_from)
            del row["frontier_steps"]
        return row


def navigate(
    maze: Maze,
    *,
    goal: Label,
    known: bool = True,
    weight: float = WEIGHT,
    settings: Settings | None = None,
    seed: int = 0,
    max_steps: int | None = None,
    closed: Sequence[Position] = (),
) -> NavigateRun:
    """Let an agent go to a sight.

    Args:
        maze: the layout, everything open.
        goal: the label of the sight.
        known: whether it explores first and is then silently moved to a random room, with nothing reset; otherwise
            it prefers the goal from its first step in an unknown maze.
        weight: log preference of the goal, in nats.
        settings: of the agent; static growth gets the number of rooms.
        seed: of everything random; start and exploring are those of `explore` with the same seed.
        max_steps: moves after which to give up exploring, and again navigating; `default_steps(maze)` unless given.
        closed: rooms that are closed while it is moved, after exploring with everything open.

    Raises:
        CogmapError: no room has the label, a weight that is not above 0, a negative seed, `max_steps` below 1, or
            rooms that cannot be closed (see `check_closed`).
    """
    check_goal(maze, goal, weight)
    check_closed(maze, goal, closed, known=known)
    most = checked_steps("navigate", maze, max_steps)
    if not known:
        session = unexplored("navigate", maze, settings=settings, seed=seed)
        steps, least = _reach(session, goal, weight, most), shortest(maze, session.start, goal)
        stood, frontier = _first(goal, session.agent.trace), frontier_to(maze, goal, seed=seed)
        return NavigateRun(seed, session.start, steps is not None, steps, least, None, None, frontier, stood)
    session = explored("navigate", maze, settings=settings, seed=seed, most=most)
    if session.steps is None:
        return NavigateRun(seed, None, False, None, None, session.start)
    room, before = session.displace(elsewhere=False, but=closed), session.agent.steps
    for shut in closed:
        session.world.close_room(shut)
    steps, least = _reach(session, goal, weight, most), shortest(maze, room, goal, closed)
    stood = _first(goal, session.agent.trace[before:])
    return NavigateRun(seed, room, steps is not None, steps, least, session.start, session.steps, steps_to_stand=stood)


def check_goal(maze: Maze, goal: Label, weight: float = WEIGHT) -> None:
    """Refuse a goal that cannot be reached or is not preferred.

    Raises:
        CogmapError: no room has the label, or the weight is not above 0 or not finite.
    """
    labels = sorted(set(maze.sights.values()), key=lambda label: (str(type(label)), label))
    if goal not in labels:
        named = ", ".join(map(str, labels[:MOST_LABELS]))
        more = f" and {len(labels) - MOST_LABELS} more" if len(labels) > MOST_LABELS else ""
        raise CogmapError(f"navigate: no room of maze {maze.name!r} has label {goal!r}; use one of {named}{more}")
    if not 0.0 < weight < inf:
        raise CogmapError(f"navigate: weight is {weight}; use a log preference above 0, in nats")


def parse_goal(maze: Maze, text: str) -> Label:
    """The label that `text` names in this maze: a whole number where its labels are numbers, else a word.

    Raises:
        CogmapError: no room has that label.
    """
    words = any(isinstance(label, str) for label in maze.sights.values())
    goal = text if words or not (text.isascii() and text.isdecimal()) else int(text)
    check_goal(maze, goal)
    return goal


def navigate_many(
    maze: Maze,
    *,
    runs: int,
    goal: Label,
    known: bool = True,
    weight: float = WEIGHT,
    settings: Settings | None = None,
    seed: int = 0,
    max_steps: int | None = None,
    closed: Sequence[Position] = (),
    jobs: int = 1,
    on_done: Callable[[], None] | None = None,
) -> list[NavigateRun]:
    """Runs with the seeds `seed`, `seed + 1`, ...; the result does not depend on `jobs`.

    Raises:
        CogmapError: `runs` is below 1, or what `navigate` and `map_tasks` raise.
    """
    one = partial(_one, maze, goal, known, weight, settings, max_steps, tuple(closed))
    return map_seeds(one, runs=runs, seed=seed, jobs=jobs, on_done=on_done)


def frontier_to(maze: Maze, goal: Label, *, seed: int) -> int:
    """Steps until nearest-frontier search first stands in a room with the sight, from the start room of `seed`."""
    start, for_agent, _ = draw_start("navigate", maze, seed)
    world, agent = MazeEnv(maze), FrontierAgent(GRID, seed=for_agent)
    observation, _ = world.reset(options={"start": start})
    steps = 0
    while observation["sight"] != goal:
        observation, *_ = world.step(agent.step(observation))
        steps += 1
    return steps


def _one(
    maze: Maze,
    goal: Label,
    known: bool,
    weight: float,
    settings: Settings | None,
    max_steps: int | None,
    closed: tuple[Position, ...],
    seed: int,
) -> NavigateRun:
    return navigate(
        maze, goal=goal, known=known, weight=weight, settings=settings, seed=seed, max_steps=max_steps, closed=closed
    )


def _reach(session: Session, goal: Label, weight: float, most: int) -> int | None:
    """Steps before it chooses to stay in a room with the sight."""
    agent, world = session.agent, session.world
    agent.prefer({goal: weight})
    for step in range(most + 1):
        observation = world.observe()
        action = agent.step(observation)
        if action == agent.map.motions.stay and observation["sight"] == goal:
            return step
        world.step(action)
    return None


def _first(goal: Label, trace: Sequence[StepRecord]) -> int | None:
    """Steps before the sight was first seen."""
    return next((step for step, record in enumerate(trace) if record.sight == goal), None)
