"""Tolman's second maze: its three routes, its two blocks, and one run through it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from ...agent import Agent, Settings
from ...model import Priors
from ...views import BLUE, GREEN, ORANGE, theme_of
from ...worlds import GRID, MAZES, Door, Label, MazeEnv, Position, shortest_path
from .. import Moment, run
from .figures import Axes, Look, Way, plot_flow

MAZE = MAZES["tolman"]
START: Position = (6, 2)
GOAL: Position = (0, 2)
SIGHT: Label = 0  # what is seen at the goal, and nowhere else
A: Position = (4, 2)  # closed, it cuts route 1
B: Position = (2, 2)  # closed, it cuts the way that routes 1 and 2 share
FORK: Position = (3, 2)  # where routes 1 and 2 meet, and where B is met
BEFORE: dict[Position | None, Position] = {A: (5, 2), B: FORK}  # the room from which the closed one bars the way
LEFT: Position = (3, 1)  # where route 2 comes to the fork
ROUTES = (1, 2, 3)  # from the shortest (6 moves) to the longest (10 and 12)
BRANCHES: dict[Position, int] = {(5, 2): 1, (6, 1): 2, (6, 3): 3}  # the first room of each route
GATES: dict[Position, int] = {(4, 2): 1, (3, 1): 2, (1, 3): 3}  # a room of each route that no other needs
COLOURS = {1: BLUE, 2: ORANGE, 3: GREEN}  # of the routes
STAY = GRID.names.index("stay")
STEPS = 20  # of a run; then the agent is back at the start, without a word
RUNS = 12  # in a block
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
    """One run from the start."""

    attempted: int | None  # the first route that it set out on; None if it never left
    route: int | None  # on which the goal was reached
    reached_at: int | None  # the step at which the agent chose to stay at the goal
    met_at: int | None  # the step at which it first stood where the closed room bars the way to the goal
    missed: str | None  # why it missed the goal, one of `MISSED`
    wrong: int  # observations at which the place it held most probable was not the true one
    path: tuple[Position, ...]  # the room at each observation, the start first

    @classmethod
    def of(
        cls,
        path: Sequence[Position],
        reached_at: int | None,
        closed: Position | None,
        knew: bool = True,
        wrong: int = 0,
    ) -> TolmanRun:
        """What this path comes to; `knew`: whether the agent had seen the goal before this run."""
        attempted = next((BRANCHES[to] for at, to in pairwise(path) if at == START and to in BRANCHES), None)
        route = None if reached_at is None else [GATES[room] for room in path[: reached_at + 1] if room in GATES][-1]
        met_at = path.index(BEFORE[closed]) if closed in BEFORE and BEFORE[closed] in path else None
        missed = None if reached_at is not None else _missed(path, closed, met_at, knew, wrong)
        return cls(attempted, route, reached_at, met_at, missed, wrong, tuple(path))


@dataclass(frozen=True, slots=True)
class Choice:
    """What came after the closed room was first met."""

    met_by: int  # the route on which it was met
    route: int  # 2 or 3, whichever was tried next
    at_fork: bool  # whether route 2 was tried from its far end, to the left of the fork
    again: int  # how often route 1 was set out on before that
    steps: int  # from the one to the other, of this run and those that followed


def choice_after(runs: Sequence[TolmanRun]) -> Choice | None:
    """What was tried next after the closed room was first met; None if it never was, or nothing was tried.

    Somebody who came to the fork by route 2 and goes back that way has not tried it again.
    """
    met_by, again, steps = None, 0, 0
    for one in runs:
        by = one.attempted or 0
        for step, (at, to) in enumerate(pairwise(one.path)):
            if met_by is None and step == one.met_at:
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


def new_agent(settings: Settings, seed: int) -> Agent:
    """An agent that knows nothing, and hopes for the goal."""
    agent = Agent(GRID, settings=settings, seed=seed)
    agent.prefer({SIGHT: 1.0})
    return agent


def new_world(closed: Position | None = None, doors: Sequence[Door] = ()) -> MazeEnv:
    """The maze with this room and these doors closed, and somebody at the start, put there without a word."""
    world = MazeEnv(MAZE)
    world.reset(options={"start": START})
    if closed is not None:
        world.close_room(closed)
    for door in doors:
        world.close_door(*door)
    return world


def agent_run(agent: Agent, closed: Position | None = None) -> TolmanRun:
    """One run of an agent that was first put at the start, and has been put there again now without a word."""
    knew, wrong = agent.map.sights.find(SIGHT) is not None, list[bool]()

    def watch(moment: Moment) -> None:
        row, column = moment.info["position"]
        wrong.append(agent.belief.place != agent.map.place_at((row - START[0], column - START[1])))

    return TolmanRun.of(*walk(agent, new_world(closed), watch=watch), closed, knew, sum(wrong))


def walk(
    walker: Any, world: MazeEnv, *, steps: int = STEPS, ends: bool = False, watch: Callable[[Moment], object] = bool
) -> tuple[Way, int | None]:
    """The rooms of a run from the start, and the step at which it was chosen to stay at the goal, where it may end."""
    reached: list[int] = []

    def look(moment: Moment) -> bool:
        watch(moment)
        if moment.info["position"] == GOAL and moment.action == STAY:
            reached.append(moment.step)
        return ends and bool(reached)

    begin = world.observe(), {"position": START}
    return run(world, walker, steps=steps, begin=begin, watch=look).truth, reached[0] if reached else None


def plot_tolman(ax: Axes, paths: Sequence[Way], *, closed: Position | None) -> None:
    """How often each door was walked through, and what the rooms are called."""
    from matplotlib.patheffects import withStroke

    plot_flow(ax, MAZE, paths, closed=closed)
    look: Look = {"va": "center", "size": 12, "weight": "bold", "zorder": 6}
    rim = [withStroke(linewidth=3, foreground=theme_of(ax).paper)]
    for (row, column), name, down in ((START, "start", 0.72), (GOAL, "goal", -0.72)):
        ax.text(column, row + down, name, ha="center", path_effects=rim, **look)
    for (row, column), name in ((A, "A"), (B, "B")):
        ax.text(column + 0.62, row, name, ha="left", path_effects=rim, **look)
    ax.set_ylim(max(ax.get_ylim()[0], 6.95), min(ax.get_ylim()[1], -0.95))


def _missed(path: Way, closed: Position | None, met_at: int | None, knew: bool, wrong: int) -> str:
    if not knew:
        return "searching"
    if 2 * wrong > len(path):
        return "lost"
    if closed is not None and met_at is not None:
        way = shortest_path(MAZE, path[met_at], GOAL, closed=(closed,))
        if met_at + len(way) > len(path):
            return "too late"
    return "exploring"
