"""Exploring a world from a random place: how many steps until all of it is known, and how few would do?"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from time import perf_counter
from typing import Any, Unpack

import numpy as np

from ..agent import Agent
from ..baselines import FrontierAgent
from ..worlds import MOST_WALKED, Chart, Maze, Place, covering_steps, frontier_walk, place_of, world_of
from .judging import Trail
from .knowledge import Truth
from .low_level import Meter, low_level
from .records import OPTIONAL, Record, mean, ratio, std
from .running import Moment, Watch, run
from .session import Many, Options, Session, World, chart_of, described, head_of, many, set_out
from .yardsticks import measured

EFFORT = 4_000_000  # of the oracle, search states times rooms squared: some seconds


@dataclass(frozen=True, slots=True)
class ExploreRun(Record):
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
        not_worked_out: what was left out, and why; None if nothing was.
        places, map_right, known: of an agent with a map, what that map is worth at the end; see `Verdict`.
        certain_but_wrong: share of the steps at which the agent was certain of a place that belongs to another room.
        low_level_steps: of a body, until every room was entered; its exact oracle is `low_level_oracle`.
        low_level_steps_to_see: until nine tenths of the tiles were seen.
        tiles_seen: the share at the end.
        metres: on a graph, until every place had been entered; None where lengths are not known.
        frontier_mean, frontier_metres: what nearest-frontier search takes from there, by steps and by metres, mean over
            draws of its ties.
        tour_steps: of the best offline tour found.
        cost: what the moves have cost in all, where percepts say so.
    """

    seed: int
    start: Place
    steps_to_visit_all: int | None
    steps_to_learn: int | None
    steps_to_complete: int | None
    oracle_steps: int | None
    seconds: float = field(compare=False)
    frontier_steps: int | None = field(default=None, metadata=OPTIONAL)
    not_worked_out: str | None = field(default=None, metadata=OPTIONAL)
    places: int | None = field(default=None, metadata=OPTIONAL)
    map_right: bool | None = field(default=None, metadata=OPTIONAL)
    known: float | None = field(default=None, metadata=OPTIONAL)
    certain_but_wrong: float | None = field(default=None, metadata=OPTIONAL)
    low_level_steps: int | None = field(default=None, metadata=OPTIONAL)
    low_level_oracle: int | None = field(default=None, metadata=OPTIONAL)
    low_level_steps_to_see: int | None = field(default=None, metadata=OPTIONAL)
    tiles_seen: float | None = field(default=None, metadata=OPTIONAL)
    metres: float | None = field(default=None, metadata=OPTIONAL)
    frontier_mean: float | None = field(default=None, metadata=OPTIONAL)
    frontier_metres: float | None = field(default=None, metadata=OPTIONAL)
    tour_steps: int | None = field(default=None, metadata=OPTIONAL)
    cost: float | None = field(default=None, metadata=OPTIONAL)


@dataclass(frozen=True, slots=True)
class Walk:
    """One exploration with all that it leaves behind."""

    run: ExploreRun  # its figures
    path: tuple[Place, ...]  # the true rooms, the start first
    walker: Any  # the agent, after its last observation
    truth: Truth  # to compare its map with

    @property
    def finished(self) -> bool:
        """Whether it completed."""
        return self.run.steps_to_complete is not None


def walk(world: World, seed: int = 0, *, watch: Watch | None = None, **options: Unpack[Options]) -> Walk:
    """Let an agent explore until the maze is complete or the steps are used up.

    Args:
        world: a maze, or an environment with a chart.
        seed: of the start room and of the agent, which get streams of their own.
        watch: looks on.
        options: see `Options`.

    Raises:
        CogmapError: unknown agent, a negative seed, or `max_steps` below 1.
        WorldError: a world without a chart.
    """
    session, begin = set_out("explore", world, seed, **options), perf_counter()
    done, known = session.explore(watch)
    seconds = round(perf_counter() - begin, 4)
    oracle = oracle_steps(chart_of(world), session.start)
    instead = frontier_steps(chart_of(world), session.start) if oracle is None else None
    left_out = f"oracle_steps, frontier_steps: more than {MOST_WALKED} places" if oracle is instead is None else None
    figures = (known.visit_all, known.learn, known.complete, oracle, seconds, instead)
    worth, low = _worth(session, known.trail), Meter.of(session.world).explored()
    beside = measured(chart_of(world), session.start, done.truth, known.visit_all)
    return Walk(
        ExploreRun(seed, session.start, *figures, left_out, *worth, *low, *beside, cost=_cost(session.agent)),
        done.truth,
        session.agent,
        session.truth,
    )


def _worth(session: Session, trail: Trail) -> tuple[Any, ...]:
    """What the map of the agent is worth, and how often it was certain and wrong; nothing of one without a map."""
    if not isinstance(session.agent, Agent):
        return None, None, None, None
    worth = trail.verdict(session.agent, chart_of(session.world))
    return worth.places, worth.map_right, round(worth.known, 6), round(trail.wrong / len(trail.rooms), 6)


def _cost(agent: Any) -> float | None:
    """What its moves have cost; None where nobody said."""
    return round(agent.cost, 6) if isinstance(agent, Agent) and agent.cost else None


def explore(world: World, seed: int = 0, **options: Unpack[Options]) -> ExploreRun:
    """One exploration, in figures; see `walk`."""
    return walk(world, seed, **options).run


def explore_many(world: World, **options: Unpack[Many]) -> list[ExploreRun]:
    """`explore` with the seeds `seed`, `seed + 1`, ..., each of which can be made again alone; see `Many`."""
    return many(explore, world, options)


def summarise(runs: Sequence[ExploreRun], *, max_steps: int) -> dict[str, Any]:
    """Counts, means and standard deviations (population) over the runs that got there; None where none did.

    `ratio` is the mean of `steps_to_complete` over that of `oracle_steps` on the same, completed runs (1 for a
    maze of one room); it and `mean_oracle_steps` are None where a run has no oracle.
    """
    done = [run for run in runs if run.steps_to_complete is not None]
    summary: dict[str, Any] = {
        "runs": len(runs),
        "completed": len(done),
        "visited_all": sum(run.steps_to_visit_all is not None for run in runs),
        "learned": sum(run.steps_to_learn is not None for run in runs),
        "max_steps": max_steps,
    }
    for name in ("steps_to_complete", "steps_to_visit_all", "steps_to_learn"):
        values = [getattr(run, name) for run in runs]
        summary |= {f"mean_{name}": mean(values), f"std_{name}": std(values)}
    exact, oracle = all(run.oracle_steps is not None for run in runs), [run.oracle_steps for run in done]
    summary["mean_oracle_steps"] = mean(run.oracle_steps for run in runs) if exact else None
    summary["ratio"] = ratio([run.steps_to_complete for run in done], oracle) if exact else None
    if not exact:
        summary["mean_frontier_steps"] = mean(run.frontier_steps for run in runs)
    if any(run.map_right is not None for run in runs):
        summary["map_right"] = sum(run.map_right is True for run in runs)
        for name in ("places", "known", "certain_but_wrong"):
            summary[f"mean_{name}"] = mean(getattr(run, name) for run in runs)
    for name in ("metres", "frontier_mean", "frontier_metres", "tour_steps", "cost"):
        if any(getattr(run, name) is not None for run in runs):
            summary[f"mean_{name}"] = mean(getattr(run, name) for run in runs)
    return summary | low_level(runs, "low_level_steps", "low_level_oracle", "low_level_steps_to_see", "tiles_seen")


def exploration(world: World, runs: Sequence[ExploreRun], **options: Unpack[Options]) -> dict[str, Any]:
    """World, agent, settings (none for a baseline that has none), runs and summary, as plain JSON values."""
    head, settings = head_of("explore", world, **options)
    most = options.get("steps") or described("explore", world, **options)[2]
    return {**head, **settings, "runs": [run.to_dict() for run in runs], "summary": summarise(runs, max_steps=most)}


@lru_cache(maxsize=4096)
def oracle_steps(chart: Chart, start: Place) -> int | None:
    """Steps of the shortest walk from `start` that visits every place; None where it is out of reach."""
    return covering_steps(chart, start, limit=max(1, EFFORT // len(chart.places) ** 2))


@lru_cache(maxsize=4096)
def frontier_steps(chart: Chart, start: Place) -> int | None:
    """Steps in which nearest-frontier search visits every place, its draws settled by seed 0; None of a large world."""
    return frontier_search(chart, start, seed=0)


def frontier_search(chart: Chart, start: Place, seed: Any, *, goal: Any = None) -> int | None:
    """The same with any seed, until it first stands in a place with the sight `goal` if one is given."""
    if not isinstance(chart, Maze):
        walk = frontier_walk(chart, start, rng=np.random.default_rng(seed))
        there = [step for step, place in enumerate(walk or ()) if goal in (None, chart.sights[place])]
        return None if not there else there[-1] if goal is None else there[0]
    if len(chart.places) > MOST_WALKED:
        return None
    left, most = set(chart.places), len(chart.places) ** 2 + 1  # a new room takes no more steps than there are rooms

    def arrived(moment: Moment) -> bool:
        left.discard(place_of(moment.info))
        return not left if goal is None else moment.observation["sight"] == goal

    world, agent = world_of(chart), FrontierAgent(chart.motions, seed=seed)
    return run(world, agent, steps=most, options={"start": start}, watch=arrived).observations - 1
