"""Tolman's second maze: its three routes, its two blocks, and one run through it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from ...agent import Agent, Settings
from ...model import CogmapError, Priors
from ...worlds import GRID, MAZES, Door, Label, MazeEnv, Position, shortest_path
from ..running import Walker

MAZE = MAZES["tolman"]
START: Position = (6, 2)
GOAL: Position = (0, 2)
SIGHT: Label = 0
"""What is seen at the goal, and nowhere else."""
A: Position = (4, 2)
"""Closed, it cuts route 1."""
B: Position = (2, 2)
"""Closed, it cuts the way that routes 1 and 2 share."""
FORK: Position = (3, 2)
"""Where routes 1 and 2 meet, and where B is met."""
BEFORE: dict[Position, Position] = {A: (5, 2), B: FORK}
"""The room from which the closed one bars the way."""
LEFT: Position = (3, 1)
"""Where route 2 comes to the fork."""
ROUTES = (1, 2, 3)
"""From the shortest (6 moves) to the longest (10 and 12)."""
BRANCHES: dict[Position, int] = {(5, 2): 1, (6, 1): 2, (6, 3): 3}
"""The first room of each route."""
GATES: dict[Position, int] = {(4, 2): 1, (3, 1): 2, (1, 3): 3}
"""A room of each route that no other needs."""
STAY = GRID.names.index("stay")
STEPS = 20
"""Of a run; then the agent is back at the start, without a word."""
RUNS = 12
"""In a block."""

SETTINGS = Settings(
    look_ahead=15,
    goal_weight=2.0,
    information_weight=2.0,
    forgetting=0.12,
    priors=Priors(transition=1e-4, door_floor=1e-5),
)
"""Of the studies in this maze: ways not walked for some runs become interesting again, and, since doors do change here,
their priors are less sharp than usual."""

MISSED = ("searching", "lost", "too late", "exploring")
"""Why a run missed the goal: it had never been seen before; the agent took itself to be elsewhere; the block was met
with fewer steps left than the way round needs; there was something else to look at."""


@dataclass(frozen=True, slots=True)
class TolmanRun:
    """One run from the start.

    Attributes:
        closed: the room that was closed, if any.
        path: the room at each observation, the start first.
        reached_at: the step at which the agent chose to stay at the goal, None if never.
        knew: whether it had seen the goal before this run.
        wrong: observations at which the place it held most probable was not the true one.
    """

    closed: Position | None
    path: tuple[Position, ...]
    reached_at: int | None
    knew: bool = True
    wrong: int = 0

    @property
    def attempted(self) -> int | None:
        """The first route that it set out on; None if it never left."""
        moves = zip(self.path, self.path[1:], strict=False)
        return next((BRANCHES[to] for at, to in moves if at == START and to in BRANCHES), None)

    @property
    def route(self) -> int | None:
        """The route on which the goal was reached; None if it was not."""
        if self.reached_at is None:
            return None
        way = [GATES[room] for room in self.path[: self.reached_at + 1] if room in GATES]
        return way[-1]

    @property
    def met_at(self) -> int | None:
        """The step at which it first stood where the closed room bars the way to the goal; None if never."""
        before = BEFORE.get(self.closed) if self.closed is not None else None
        return self.path.index(before) if before in self.path else None

    @property
    def missed(self) -> str | None:
        """Why it missed the goal, one of `MISSED`; None if it did not."""
        if self.reached_at is not None:
            return None
        if not self.knew:
            return "searching"
        if 2 * self.wrong > len(self.path):
            return "lost"
        if self.closed is not None and self.met_at is not None:
            way = shortest_path(MAZE, self.path[self.met_at], GOAL, closed=(self.closed,))
            if self.met_at + len(way) > len(self.path):
                return "too late"
        return "exploring"

    def to_dict(self) -> dict[str, Any]:
        """The run as plain JSON values."""
        return {
            "attempted": self.attempted,
            "route": self.route,
            "reached_at": self.reached_at,
            "met_at": self.met_at,
            "missed": self.missed,
            "wrong": self.wrong,
            "path": [list(room) for room in self.path],
        }


@dataclass(frozen=True, slots=True)
class Choice:
    """What came after the closed room was first met.

    Attributes:
        met_by: the route on which it was met.
        route: 2 or 3, whichever was tried next.
        at_fork: whether route 2 was tried from its far end, to the left of the fork.
        again: how often route 1 was set out on before that.
        steps: from the one to the other, of this run and those that followed.
    """

    met_by: int
    route: int
    at_fork: bool
    again: int
    steps: int

    def to_dict(self) -> dict[str, Any]:
        """The fields as plain JSON values."""
        return asdict(self)


def choice_after(runs: Sequence[TolmanRun]) -> Choice | None:
    """What was tried next after the closed room was first met; None if it never was, or nothing was tried.

    Somebody who came to the fork by route 2 and goes back that way has not tried it again.
    """
    met_by, again, steps = None, 0, 0
    for run in runs:
        by = run.attempted or 0
        for step, (at, to) in enumerate(zip(run.path, run.path[1:], strict=False)):
            if met_by is None and step == run.met_at:
                met_by, steps = by, 0
            steps += 1
            by = BRANCHES.get(to, by) if at == START else by
            if met_by is None:
                continue
            left = (at, to) == (FORK, LEFT) and by == 1
            if left or (at == START and BRANCHES.get(to, 1) != 1):
                return Choice(met_by, 2 if left else by, left, again, steps)
            again += at == START and to in BRANCHES
        steps += 1
    return None


def check_counts(study: str, **counts: int) -> None:
    """Refuse to do something less than once.

    Raises:
        CogmapError: a count below 1.
    """
    for name, number in counts.items():
        if number < 1:
            raise CogmapError(f"{study}: {name} is {number}; use 1 or more")


def new_agent(settings: Settings, seed: int) -> Agent:
    """An agent that knows nothing, and hopes for the goal."""
    agent = Agent(GRID, settings=settings, seed=seed)
    agent.prefer({SIGHT: 1.0})
    return agent


def new_world(*, closed: Position | None = None) -> MazeEnv:
    """The maze, with somebody at the start."""
    world = MazeEnv(MAZE)
    world.reset(options={"start": START})
    if closed is not None:
        world.close_room(closed)
    return world


def agent_run(agent: Agent, world: MazeEnv, *, steps: int = STEPS, ends: bool = False) -> TolmanRun:
    """One run of an agent that was first put at the start, and has been put there again now without a word."""
    knew, wrong = agent.map.sights.find(SIGHT) is not None, 0

    def watch() -> None:
        nonlocal wrong
        row, column = world.position
        wrong += agent.belief.place != agent.map.place_at((row - START[0], column - START[1]))

    path, reached_at = walk(agent, world, steps=steps, ends=ends, watch=watch)
    return TolmanRun(next(iter(world.closed_rooms), None), path, reached_at, knew, wrong)


def walk(
    walker: Walker,
    world: MazeEnv,
    *,
    steps: int = STEPS,
    ends: bool = False,
    watch: Callable[[], None] | None = None,
) -> tuple[tuple[Position, ...], int | None]:
    """The rooms of a run from the start, and the step at which the walker chose to stay at the goal.

    Args:
        walker: whoever is put there, without a word.
        world: where.
        steps: of the run.
        ends: whether the run is over at the goal.
        watch: called after each choice, before it is carried out.
    """
    world.displace(START)
    path: list[Position] = []
    reached_at = None
    for step in range(steps):
        path.append(world.position)
        action = walker.step(world.observe())
        if watch is not None:
            watch()
        if reached_at is None and world.position == GOAL and action == STAY:
            reached_at = step
            if ends:
                break
        world.step(action)
    return tuple(path), reached_at


def set_closed(world: MazeEnv, *, room: Position | None = None, doors: Sequence[Door] = ()) -> None:
    """Close this room and these doors, and open all else."""
    world.displace(START)
    for closed in world.closed_rooms - {room}:
        world.open_room(closed)
    for closed_door in world.closed_doors - set(doors):
        world.open_door(*closed_door)
    if room is not None:
        world.close_room(room)
    for door in doors:
        world.close_door(*door)
