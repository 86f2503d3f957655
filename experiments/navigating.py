"""Navigating: how far does an agent walk to a sight that it prefers, in a maze it knows or not?"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass
from functools import partial
from math import inf
from typing import Any, Required, TypedDict, Unpack

from ..agent import Settings
from ..baselines import CscgSettings, FrontierAgent
from ..model.errors import CogmapError
from ..worlds import GRID, Label, Maze, MazeEnv, Position
from .closing import check_closed, shortest
from .exploring import Watch, checked_steps, draw_start
from .pool import map_seeds
from .session import Outing, outing, walked
from .walkers import sensed

WEIGHT = 8.0
"""Log preference of the goal over all other sights, in nats a step: more than a step into a room never seen can teach,
log of the number of sights and log 2 for each of its three other doors, up to 370 sights."""

STAY = GRID.names.index("stay")

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
    agent: str = "cogmap",
    settings: Settings | None = None,
    cscg: CscgSettings | None = None,
    seed: int = 0,
    max_steps: int | None = None,
    closed: Sequence[Position] = (),
    watch: Watch | None = None,
) -> NavigateRun:
    """Let an agent go to a sight.

    Args:
        maze: the layout, everything open.
        goal: the label of the sight.
        known: whether it explores first and is then silently moved to a random room, with nothing reset; otherwise
            it prefers the goal from its first step in an unknown maze.
        weight: log preference of the goal, in nats.
        agent: a name in `AGENTS`.
        settings: of the agent `cogmap`; static growth gets the number of rooms.
        cscg: settings of the clone-structured graphs.
        seed: of everything random; start and exploring are those of `explore` with the same seed.
        max_steps: moves after which to give up exploring, and again navigating; `default_steps(maze)` unless given.
        closed: rooms that are closed while it is moved, after exploring with everything open.
        watch: looks on, from the first step to the last.

    Raises:
        CogmapError: no room has the label, a weight that is not above 0, no agent has the name, a negative seed,
            `max_steps` below 1, or rooms that cannot be closed (see `check_closed`).
    """
    check_goal(maze, goal, weight)
    check_closed(maze, goal, closed, known=known)
    most = checked_steps("navigate", maze, max_steps)
    out = outing("navigate", maze, agent=agent, settings=settings, cscg=cscg, seed=seed)
    if not known:
        steps, stood = _reach(out, goal, weight, most, watch)
        least, frontier = shortest(maze, out.start, goal), frontier_to(maze, goal, seed=seed)
        return NavigateRun(seed, out.start, steps is not None, steps, least, None, None, frontier, stood)
    out = walked(out, most, watch)
    if out.steps is None:
        return NavigateRun(seed, None, False, None, None, out.start)
    room = out.displace(elsewhere=False, but=closed)
    for shut in closed:
        out.world.close_room(shut)
    steps, stood = _reach(out, goal, weight, most, watch)
    least = shortest(maze, room, goal, closed)
    return NavigateRun(seed, room, steps is not None, steps, least, out.start, out.steps, steps_to_stand=stood)


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


class Options(TypedDict, total=False):
    """What `navigate` can be told besides maze and seed."""

    goal: Required[Label]
    known: bool
    weight: float
    agent: str
    settings: Settings | None
    cscg: CscgSettings | None
    max_steps: int | None
    closed: Sequence[Position]


def navigate_many(
    maze: Maze,
    *,
    runs: int,
    seed: int = 0,
    executor: Executor | None = None,
    on_done: Callable[[], None] | None = None,
    **options: Unpack[Options],
) -> list[NavigateRun]:
    """Runs with the seeds `seed`, `seed + 1`, ..., and the options of `navigate`; the same whatever `executor`.

    Raises:
        CogmapError: `runs` is below 1, or what `navigate` and `map_tasks` raise.
    """
    return map_seeds(partial(_one, maze, options), runs=runs, seed=seed, executor=executor, on_done=on_done)


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


def _one(maze: Maze, options: Options, seed: int) -> NavigateRun:
    return navigate(maze, seed=seed, **options)


def _reach(
    out: Outing, goal: Label, weight: float, most: int, watch: Watch | None = None
) -> tuple[int | None, int | None]:
    """Steps before it chooses to stay in a room with the sight, and before it first stands in one."""
    out.agent.prefer({goal: weight})
    stood: int | None = None
    for step in range(most + 1):
        observation = out.world.observe()
        action = out.agent.step(sensed(out.agent, observation, out.world.position))
        if watch is not None:
            watch(out.agent, out.world, len(out.world.maze.rooms))
        there = observation["sight"] == goal
        stood = step if there and stood is None else stood
        if there and action == STAY:
            return step, stood
        out.world.step(action)
    return None, stood
