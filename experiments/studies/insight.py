"""Insight, after Tolman and Honzik (1930): trained in the open maze, then B is closed; is route 3 tried before 2?"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import replace
from functools import partial

from ...agent import Settings
from ...baselines.habit import HabitAgent
from ...worlds import GRID, MazeEnv
from ..pool import map_tasks
from .insight_rows import RATS, WANDER, InsightResult, InsightRow, route_3_first, summary
from .shares import Share
from .tolman_maze import (
    ROUTES,
    RUNS,
    SIGHT,
    B,
    TolmanRun,
    agent_run,
    check_counts,
    choice_after,
    new_agent,
    new_world,
    set_closed,
    walk,
)
from .tolman_maze import SETTINGS as MAZE_SETTINGS

SETTINGS = replace(MAZE_SETTINGS, forgetting=0.0)
"""Nothing fades, so that what was learned about every way is as sure at the test as it was on the way."""
MOST = 60
"""Runs with B closed after which nobody is waited for any longer."""


def insight_study(
    *,
    agents: int,
    seed: int = 0,
    settings: Settings | None = None,
    executor: Executor | None = None,
    on_done: Callable[[], None] | None = None,
    runs: int = RUNS,
) -> InsightResult:
    """Let each agent run in the open maze, close B, and see which way it tries once it has met the block.

    As many controls, which learn by reward and have no map, do the same.

    Args:
        agents: how many; agent i has the seed `seed` + i.
        seed: of the first.
        settings: of the agents; `SETTINGS` unless given.
        executor: where the agents run, in this process if None; the result does not depend on it.
        on_done: called after each agent.
        runs: without obstacle.

    Raises:
        CogmapError: `agents` or `runs` below 1, or a negative seed.
    """
    check_counts("insight", agents=agents, runs=runs)
    one = partial(_pair, settings or SETTINGS, runs)
    pairs = map_tasks(one, range(seed, seed + agents), executor=executor, on_done=on_done)
    return InsightResult(tuple(pair[0] for pair in pairs), tuple(pair[1] for pair in pairs))


def insight_lines(result: InsightResult) -> list[str]:
    """What the terminal shows."""
    from ..text import number

    lines: list[str] = []
    for name, rows in (("agents", result.agents), ("controls without a map", result.controls)):
        part, first = summary(rows), route_3_first(rows)
        trained = ", ".join(str(part["trained_by_route"][str(route)]) for route in ROUTES)
        lines += [
            f"{name}: {_text(first)} tried route 3 first after meeting B",
            f"  trained by route 1, 2, 3 in {trained} runs of {part['training_runs']}; means: route 1 set out on again "
            f"{number(part['mean_again'])} times, {number(part['mean_steps_to_choice'])} steps from the block to the "
            f"choice, {number(part['mean_steps_to_goal'])} steps to the goal again",
        ]
    lines.append(f"rats (Tolman and Honzik 1930): {_text(RATS)}")
    lines.append(f"agents over controls, Fisher's exact test: p = {result.p_value:.2g}")
    return lines


def _pair(settings: Settings, runs: int, seed: int) -> tuple[InsightRow, InsightRow]:
    agent = new_agent(settings, seed)
    row = _row(seed, runs, lambda world: agent_run(agent, world))
    return row, _control(runs, seed)


def _control(runs: int, seed: int) -> InsightRow:
    habit = HabitAgent(GRID, goal=SIGHT, explore=1.0, seed=seed)
    walk(habit, new_world(), steps=WANDER)
    habit.explore = 0.1

    def one_run(world: MazeEnv) -> TolmanRun:
        """From the start; with B closed it does what it is used to."""
        if world.closed_rooms:
            habit.explore = 0.0
        habit.restart()
        path, reached_at = walk(habit, world)
        return TolmanRun(next(iter(world.closed_rooms), None), path, reached_at)

    return _row(seed, runs, one_run)


def _row(seed: int, runs: int, one_run: Callable[[MazeEnv], TolmanRun]) -> InsightRow:
    world = new_world()
    training = tuple(one_run(world) for _ in range(runs))
    set_closed(world, room=B)
    probe: list[TolmanRun] = []
    while len(probe) < MOST and not (choice_after(probe) and probe[-1].reached_at is not None):
        probe.append(one_run(world))
    return InsightRow(seed, training, tuple(probe))


def _text(share: Share) -> str:
    return f"{share.count} of {share.of} ({share.share:.0%}, 95 % interval {share.low:.0%} to {share.high:.0%})"
