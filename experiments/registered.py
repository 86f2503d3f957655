"""Any environment of MiniGrid by its id: rooms to explore, or what its mission asks for."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..agent import Agent, Settings
from ..model import Carried, CogmapError
from .records import Record, mean
from .running import Moment, run
from .session import many

_ID = re.compile(r"[\w./-]+-v\d+")
MOVES = 200
"""Steps of the upper level after which it gives up, unless told otherwise; the environment has a limit of its own."""


@dataclass(frozen=True, slots=True)
class IdRun(Record):
    """One episode in an environment of MiniGrid."""

    seed: int  # of the environment and of the agent
    reached: bool  # whether the environment gave a reward: the mission is fulfilled
    steps: int  # of the upper level
    low_level_steps: int  # of the body
    rooms: int  # places of the map that were visited
    explored: bool  # whether at the end no way was left that was seen open and not walked
    barred: tuple[str, ...] = ()  # what the body could not get past, in words


def is_registered(world: str) -> bool:
    """Whether a world is called as environments of Gymnasium are that are no mazes, such as `MiniGrid-FourRooms-v0`."""
    return _ID.fullmatch(world) is not None and not world.startswith("cogmap/")


def run_id(
    name: str,
    seed: int = 0,
    *,
    errand: bool,
    view: str | None = None,
    settings: Settings | None = None,
    max_steps: int | None = None,
) -> IdRun:
    """Let an agent with a body live through one episode.

    Args:
        name: of the environment.
        seed: of the environment and of the agent.
        errand: whether it is after what the mission asks for; otherwise it explores, until nothing is left to explore.
        view: what the body sees, `"symbolic"` unless given, or `"rgb"`.
        settings: of the agent.
        max_steps: of the upper level; `MOVES` unless given.

    Raises:
        CogmapError: a seed below 0.
        WorldError: no such environment, none of MiniGrid, or a mission that is not understood.
    """
    from ..body import RegisteredWorld

    if seed < 0:
        raise CogmapError(f"seed is {seed}; use 0 or more")
    world = RegisteredWorld(name, view=view, errand=errand)
    agent = Agent(world.motions, settings=settings, seed=seed)
    begin = world.reset(seed=seed)

    def watch(moment: Moment) -> bool:
        return world.body.ended or (not errand and _nothing_left(agent))

    steps = 0
    if not world.body.ended:
        steps = run(world, agent, steps=max_steps or MOVES, begin=begin, watch=watch).observations
    low, reached = world.low_level_steps, world.body.reward > 0.0
    return IdRun(seed, reached, steps, low, _rooms(agent), _nothing_left(agent), world.body.bars)


def run_ids(name: str, *, runs: int, seed: int = 0, **options: Any) -> list[IdRun]:
    """`run_id` with the seeds `seed`, `seed + 1`, ...; `executor` and `on_done` as for `map_tasks`."""
    return many(run_id, name, {"runs": runs, "seed": seed, **options})


def ids_result(name: str, runs: Sequence[IdRun], *, errand: bool, view: str | None = None) -> dict[str, Any]:
    """World, runs and summary, as plain JSON values; means of steps are over the runs that fulfilled their mission."""
    there = [run for run in runs if run.reached or not errand]
    summary = {
        "runs": len(runs),
        "reached": sum(run.reached for run in runs),
        "explored": sum(run.explored for run in runs),
        "mean_steps": mean(run.steps for run in there),
        "mean_low_level_steps": mean(run.low_level_steps for run in there),
        "mean_rooms": mean(run.rooms for run in runs),
    }
    head = {"world": name, "agent": "cogmap", "view": view or "symbolic", "errand": errand}
    return {**head, "runs": [run.to_dict() for run in runs], "summary": summary}


def _rooms(agent: Agent) -> int:
    """Rooms that were visited, whatever was carried then."""
    places = agent.map.visited_places
    for sensor in agent.map.sensors.values():
        places = sensor.rooms(places) if isinstance(sensor, Carried) else places
    return len(np.unique(places))


def _nothing_left(agent: Agent) -> bool:
    """Whether every place that the map knows of, behind ways believed open, was visited."""
    if not agent.steps:
        return False
    map_, places = agent.map, agent.map.visited_places
    keys, p, _ = map_.B_s.mean(map_.rows_of(places))
    ahead = keys[(keys >= 0) & (p >= 0.5)]
    return bool(map_.visited[np.unique(ahead)].all())
