"""Navigating: how far does an agent walk to a sight that it prefers, in a world it knows or not?"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Required, Unpack, cast

from ..worlds import CanClose, Label, Place, offered
from .exploring import frontier_search
from .goals import WEIGHT, check_goal, shortest
from .low_level import Meter, low_level
from .records import OPTIONAL, Record, mean, ratio
from .running import Moment, Watch
from .session import Many, Options, Session, World, chart_of, described, draw_start, head_of, many, set_out


@dataclass(frozen=True, slots=True)
class NavigateRun(Record):
    """One walk to a goal: a room with the preferred sight in which the agent chooses to stay."""

    seed: int  # of everything random
    start: Place | None  # the room from which it sets out for the goal; None where it did not explore the maze in time
    reached: bool  # whether it chose to stay in a room with the sight
    steps: int | None  # until then, that last one not counted; None if never
    shortest: int | None  # steps of the shortest path from `start` to the nearest room with the sight
    # the room where it began to explore; None if it set out unexplored
    explored_from: Place | None = field(default=None, metadata=OPTIONAL)
    steps_to_explore: int | None = None  # None where it gave up, or set out unexplored
    # of nearest-frontier search from `start` until it first stands in a room with the sight; only if the agent
    # set out unexplored
    frontier_steps: int | None = field(default=None, metadata=OPTIONAL)
    # until the agent first stands in a room with the sight, whatever it chooses; None if never
    steps_to_stand: int | None = None
    # of a body, from setting out until it was there; None if never. `low_level_oracle`: the fewest
    low_level_steps: int | None = field(default=None, metadata=OPTIONAL)
    low_level_oracle: int | None = field(default=None, metadata=OPTIONAL)

    def to_dict(self) -> dict[str, Any]:
        """The run as plain JSON values, without the fields of the other kind of run."""
        row = Record.to_dict(self)
        if self.explored_from is None:
            del row["steps_to_explore"]
        return row


class NavigateOptions(Options, total=False):
    """Who goes where.

    Attributes:
        goal: the label of the sight.
        known: whether the agent explores first and is then silently moved to a random room, with nothing reset;
            otherwise it prefers the goal from its first step in an unknown maze. True unless given.
        weight: log preference of the goal, in nats; `WEIGHT` unless given.
        closed: rooms that are closed while it is moved, after exploring with everything open.
    """

    goal: Required[Label]
    known: bool
    weight: float
    closed: Sequence[Place]


class NavigateMany(NavigateOptions, Many, total=False):
    """The options of `navigate_many`."""


def navigate(
    world: World, seed: int = 0, *, watch: Watch | None = None, **options: Unpack[NavigateOptions]
) -> NavigateRun:
    """Let an agent go to a sight.

    Args:
        world: a maze, or an environment with a chart.
        seed: of everything random; start and exploring are those of `explore` with the same seed.
        watch: looks on, from the first step to the last.
        options: see `NavigateOptions`.

    Raises:
        CogmapError: what `check_goal` raises, no agent has the name, a negative seed, or `max_steps` below 1.
        WorldError: a world that lacks what this needs.
    """
    goal, known, weight, closed, others = _task(options)
    check_goal(world, goal, weight=weight, closed=closed, known=known)
    session, chart = set_out("navigate", world, seed, **others), chart_of(world)
    if not known:
        start, for_agent, _ = draw_start("navigate", world, seed)
        steps, stood, low = _reach(session, goal, weight, watch)
        least, frontier = shortest(chart, start, goal), frontier_search(chart, start, for_agent, goal=goal)
        return NavigateRun(seed, start, steps is not None, steps, least, None, None, frontier, stood, *low)
    session.explore(watch)
    if session.steps is None:
        return NavigateRun(seed, None, False, None, None, session.start)
    room = session.displace(elsewhere=False, but=closed)
    for shut in closed:
        offered(session.world, CanClose, "close").close_room(shut)
    steps, stood, low = _reach(session, goal, weight, watch)
    least, explored = shortest(chart, room, goal, closed), (session.start, session.steps)
    return NavigateRun(seed, room, steps is not None, steps, least, *explored, None, stood, *low)


def navigate_many(world: World, **options: Unpack[NavigateMany]) -> list[NavigateRun]:
    """`navigate` with the seeds `seed`, `seed + 1`, ..., each of which can be made again alone; see `Many`."""
    return many(navigate, world, options)


def navigate_result(world: World, runs: Sequence[NavigateRun], **options: Unpack[NavigateOptions]) -> dict[str, Any]:
    """World, agent, goal, settings, runs and summary, as plain JSON values; the options are those of `navigate`.

    Totals, means and the ratio of the totals are over the runs that reached the goal; `failed` counts the others.
    The ratio is None where none reached it, and where every one of them started there but walked all the same.
    """
    goal, known, weight, closed, others = _task(options)
    head, settings = head_of("navigate", world, **others)
    most = described("navigate", world, **others)[2]
    there = [run for run in runs if run.reached]
    steps, least = [run.steps or 0 for run in there], [run.shortest or 0 for run in there]
    summary: dict[str, Any] = {"runs": len(runs), "reached": len(there), "failed": len(runs) - len(there)}
    if known:
        summary["explored"] = sum(run.steps_to_explore is not None for run in runs)
    summary |= {"max_steps": most, "total_steps": sum(steps), "total_shortest": sum(least)}
    summary |= {"ratio": ratio(steps, least), "mean_steps": mean(steps), "mean_shortest": mean(least)}
    if not known:
        frontier = [run.frontier_steps or 0 for run in there]
        summary |= {"total_frontier_steps": sum(frontier), "mean_frontier_steps": mean(frontier)}
    summary |= low_level(there, "low_level_steps", "low_level_oracle")
    head |= {"goal": goal, "weight": weight, "unexplored": not known}
    shut = {"closed": [list(room) for room in closed]} if closed else {}
    rows = [run.to_dict() for run in runs]
    return {**head, **shut, **settings, "runs": rows, "summary": summary}


def _task(options: NavigateOptions) -> tuple[Label, bool, float, Sequence[Place], Options]:
    """Goal, whether the world is known, weight, closed rooms, and the other options."""
    others = {name: value for name, value in options.items() if name in Options.__annotations__}
    known, weight, closed = options.get("known", True), options.get("weight", WEIGHT), options.get("closed", ())
    return options["goal"], known, weight, closed, cast(Options, others)


def _reach(
    session: Session, goal: Label, weight: float, watch: Watch | None
) -> tuple[int | None, int | None, tuple[int | None, int | None]]:
    """Steps before it chooses to stay in a room with the sight, before it first stands in one, and of the low level."""
    reached = stood = None
    stay = chart_of(session.world).motions.names.index("stay")

    def look(moment: Moment) -> bool:
        nonlocal reached, stood
        if moment.observation["sight"] == goal:
            stood = moment.step if stood is None else stood
            reached = moment.step if moment.action == stay else None
        stop = watch is not None and watch(moment) is True
        return stop or reached is not None

    meter = Meter.of(session.world, goal)
    session.agent.prefer({goal: weight})
    session.run(session.most + 1, look)
    took, least = meter.towards()
    return reached, stood, (None if reached is None else took, least)
