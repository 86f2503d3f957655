"""The training of Tolman and Honzik (1930) as Martinet et al. ran it: forced runs, free runs, A closed, then B closed.

L.-E. Martinet, D. Sheynikhovich, K. Benchenane, A. Arleo, Spatial learning and action planning in a prefrontal cortical
network model, PLoS Comput. Biol. 7(5): e1002045, 2011, section "Tolman & Honzik's detour task".
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from functools import partial

import numpy as np

from ...agent import Agent, Settings
from ...worlds import Door, MazeEnv, Position
from ..pool import map_tasks
from .intervals import Interval
from .martinet_rows import BLOCKED, CONDITIONS, FREE, MOST, PROBES, MartinetResult, MartinetRow, MartinetRun
from .tolman_maze import (
    BEFORE,
    BRANCHES,
    GATES,
    GOAL,
    ROUTES,
    START,
    STAY,
    A,
    B,
    check_counts,
    new_agent,
    new_world,
    set_closed,
)
from .tolman_maze import SETTINGS as MAZE_SETTINGS

SETTINGS = replace(MAZE_SETTINGS, information_weight=3.0)
"""Enough curiosity to go and look whether a door that was shut still is."""
DAYS = 7
"""Of training, 12 runs a day; half of the original's, since nothing changes any more after the second."""
_FIRST: dict[int, Position] = {route: room for room, route in BRANCHES.items()}


def martinet_study(
    *,
    agents: int,
    seed: int = 0,
    settings: Settings | None = None,
    executor: Executor | None = None,
    on_done: Callable[[], None] | None = None,
    days: int = DAYS,
) -> MartinetResult:
    """Train each agent for some days, then close B.

    On the first day it is forced through routes 1, 2 and 3 once each (the other two are shut), then it runs freely.
    From the second day on A is closed, but for two runs among them, and routes 2 and 3 are shut until it has been
    there. On the last day B is closed instead of A. What it knows it keeps; between runs it is put back without a word.

    Args:
        agents: how many; agent i has the seed `seed` + i.
        seed: of the first.
        settings: of the agents; `SETTINGS` unless given.
        executor: where the agents run, in this process if None; the result does not depend on it.
        on_done: called after each agent.
        days: of training.

    Raises:
        CogmapError: `agents` or `days` below 1, or a negative seed.
    """
    check_counts("martinet", agents=agents, days=days)
    one = partial(_agent, settings or SETTINGS, days)
    rows = map_tasks(one, range(seed, seed + agents), executor=executor, on_done=on_done)
    return MartinetResult(tuple(rows), days)


def martinet_lines(result: MartinetResult) -> list[str]:
    """What the terminal shows."""
    runs = [run for row in result.rows for run in row.runs]
    reached = sum(run.steps is not None for run in runs)
    lines = [
        f"{len(result.rows)} agents, {result.days} days of training; the goal reached in {reached}/{len(runs)} runs"
    ]
    for name, routes in CONDITIONS.items():
        parts = [f"route {route} {_text(result.share(name, route))}" for route in routes]
        lines.append(f"{name}: {', '.join(parts)} (95 % intervals)")
    for part in result.preferences():
        p = "-" if part.p_value is None else f"{part.p_value:.2g}"
        lines.append(f"{part.condition}: route {part.more} over {part.less} by {_text(part.difference)}, p = {p}")
    lines.append("Martinet et al. 2011, 40 simulated animals: the same order in all four, each p < 0.0001")
    return lines


def _agent(settings: Settings, days: int, seed: int) -> MartinetRow:
    agent, world = new_agent(settings, seed), new_world()
    rng = np.random.default_rng([seed, days])
    runs = [_forced(agent, world, route) for route in ROUTES]
    runs += [_free(agent, world, 1) for _ in range(FREE)]
    for day in range(2, days + 1):
        free = _apart(rng)
        for number in range(BLOCKED + 2):
            runs.append(_free(agent, world, day) if number in free else _blocked(agent, world, day, A))
    runs += [_blocked(agent, world, days + 1, B) for _ in range(PROBES)]
    return MartinetRow(seed, tuple(runs))


def _apart(rng: np.random.Generator) -> tuple[int, int]:
    """The numbers of a day's two free runs, not one right after the other."""
    while True:
        first, second = sorted(rng.choice(BLOCKED + 2, size=2, replace=False).tolist())
        if second - first > 1:
            return first, second


def _entrances(routes: Sequence[int]) -> list[Door]:
    return [(START, _FIRST[route]) for route in routes]


def _forced(agent: Agent, world: MazeEnv, route: int) -> MartinetRun:
    set_closed(world, doors=_entrances([other for other in ROUTES if other != route]))
    _, steps = _to_goal(agent, world)
    return MartinetRun(1, "forced", route if steps is not None else None, steps)


def _free(agent: Agent, world: MazeEnv, day: int) -> MartinetRun:
    set_closed(world)
    path, steps = _to_goal(agent, world)
    return MartinetRun(day, "free", None if steps is None else _last_route(path), steps)


def _blocked(agent: Agent, world: MazeEnv, day: int, room: Position) -> MartinetRun:
    shut = _entrances((2, 3))
    set_closed(world, room=room, doors=shut)
    path, steps = _to_goal(agent, world, until=BEFORE[room], shut=shut)
    met = path.index(BEFORE[room]) if BEFORE[room] in path else len(path)
    later = zip(path[met:], path[met + 1 :], strict=False)
    chosen = [BRANCHES[to] for at, to in later if at == START and to in BRANCHES]
    name = "A closed" if room == A else "B closed"
    return MartinetRun(day, name, next((route for route in chosen if route != 1), None), steps)


def _to_goal(
    agent: Agent, world: MazeEnv, *, until: Position | None = None, shut: Sequence[Door] = ()
) -> tuple[list[Position], int | None]:
    """The rooms of a run that ends at the goal, and its steps; the doors `shut` open once `until` was reached."""
    world.displace(START)
    path: list[Position] = []
    for step in range(MOST):
        path.append(world.position)
        if world.position == until:
            for door in shut:
                world.open_door(*door)
        action = agent.step(world.observe())
        if world.position == GOAL and action == STAY:
            return path, step
        world.step(action)
    return path, None


def _last_route(path: Sequence[Position]) -> int | None:
    """The route on which the goal was reached."""
    return next((GATES[room] for room in reversed(path) if room in GATES), None)


def _text(interval: Interval | None) -> str:
    return "-" if interval is None else f"{interval.value:.0%} ({interval.low:.0%} to {interval.high:.0%})"
