"""Kidnapping: moved without a word in a known world, how soon does an agent know where it is?"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Unpack

from ..agent import Agent
from ..model import CogmapError
from ..worlds import CanDisplace, Place, offered, place_of
from .records import Record, mean, std
from .running import Moment
from .session import Many, Options, Session, World, chart_of, described, head_of, many, set_out

AFTER = 20  # steps that a run goes on after recovery, before the map is checked


@dataclass(frozen=True, slots=True)
class KidnapRun(Record):
    """One kidnapping. If the world was not explored within the allowed steps, the agent was not moved."""

    seed: int  # of the start room, of the agent, and of where it was moved to
    start: Place  # the first room
    # before it was moved; None where it gave up, and all below is None but `recovered`
    steps_to_explore: int | None = None
    moved_to: Place | None = None  # the room in which it found itself; another one than its own
    recovered: bool = False  # whether it was certain (by its own threshold) of the true place in time
    steps_to_recover: int | None = None  # steps until then, 0 at the first observation after the move; None if never
    # observations after the move, to the end of the run, at which it was certain of another place
    steps_certain_but_wrong: int | None = None
    # whether at the end no place was added and every true transition was still believed at 0.6 or more
    map_intact: bool | None = None


def kidnap(world: World, seed: int = 0, **options: Unpack[Options]) -> KidnapRun:
    """Let an agent explore, move it silently to another random room, and let it continue. Nothing is reset.

    Args:
        world: a maze, or an environment with a chart in which agents can be moved.
        seed: of everything random; exploring goes as in `explore` with the same seed.
        options: see `Options`.

    Raises:
        CogmapError: an agent without beliefs, the world has one place only, a negative seed, or `max_steps` below 1.
        WorldError: a world that lacks what this needs.
    """
    check_kidnap(world)
    session = set_out("kidnap", world, seed, **options)
    agent = session.agent
    if not isinstance(agent, Agent):
        raise CogmapError(f"kidnap: agent {options.get('agent')} believes nothing; use --agent cogmap")
    session.explore()
    if session.steps is None:
        return KidnapRun(seed, session.start)
    places, moved_to = len(agent.map.places), session.displace(elsewhere=True)
    steps, wrong = _recover(session, agent)
    known = session.truth.learned(agent.map) or session.trail.verdict(agent, chart_of(world)).map_right
    intact = len(agent.map.places) == places and known
    return KidnapRun(seed, session.start, session.steps, moved_to, steps is not None, steps, wrong, intact)


def check_kidnap(world: World) -> None:
    """Refuse a world in which the agent cannot be moved, or which has only one place.

    Raises:
        CogmapError: one place only.
        WorldError: nobody can be moved there.
    """
    chart = chart_of(world)
    if chart is not world:
        offered(world, CanDisplace, "kidnap")
    if len(chart.places) < 2:
        raise CogmapError(
            f"kidnap: maze {chart.name!r} has one room, so there is no other to move to; use a larger one"
        )


def kidnap_many(world: World, **options: Unpack[Many]) -> list[KidnapRun]:
    """`kidnap` with the seeds `seed`, `seed + 1`, ..., each of which can be made again alone; see `Many`."""
    return many(kidnap, world, options)


def kidnap_result(world: World, runs: Sequence[KidnapRun], **options: Unpack[Options]) -> dict[str, Any]:
    """World, agent, settings, runs and summary, as plain JSON values; means are over the runs that got there."""
    head, settings = head_of("kidnap", world, **options)
    steps = [run.steps_to_recover for run in runs]
    summary = {
        "runs": len(runs),
        "explored": sum(run.steps_to_explore is not None for run in runs),
        "recovered": sum(run.recovered for run in runs),
        "map_intact": sum(run.map_intact is True for run in runs),
        "max_steps": described("kidnap", world, **options)[2],
        "mean_steps_to_recover": mean(steps),
        "std_steps_to_recover": std(steps),
        "most_steps_to_recover": max((step for step in steps if step is not None), default=None),
        "mean_steps_certain_but_wrong": mean(run.steps_certain_but_wrong for run in runs),
    }
    return {**head, **settings, "runs": [run.to_dict() for run in runs], "summary": summary}


def _recover(session: Session, agent: Agent) -> tuple[int | None, int]:
    """Steps until certain and right, and how often certain but wrong, `AFTER` steps longer."""
    recovered, wrong = None, 0

    def watch(moment: Moment) -> bool:
        nonlocal recovered, wrong
        session.trail(moment)
        right = session.truth.right(agent, place_of(moment.info), session.trail)
        wrong += agent.certain and not right
        recovered = moment.step if recovered is None and agent.certain and right else recovered
        return moment.step == (session.most if recovered is None else recovered + AFTER)

    session.run(session.most + AFTER + 1, watch)
    return recovered, wrong
