"""Many explorations of one maze, and what they come to."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from functools import partial
from typing import Any

import numpy as np

from ..agent import Settings
from ..baselines import CscgSettings
from ..worlds import Maze
from .cells import Cell, run_cell
from .exploring import ExploreRun, default_steps
from .pool import map_seeds
from .walkers import settings_of


def explore_many(
    maze: Maze,
    *,
    runs: int,
    agent: str = "cogmap",
    settings: Settings | None = None,
    cscg: CscgSettings | None = None,
    seed: int = 0,
    max_steps: int | None = None,
    executor: Executor | None = None,
    on_done: Callable[[], None] | None = None,
) -> list[ExploreRun]:
    """Runs with the seeds `seed`, `seed + 1`, ...; each can be walked again alone with its seed.

    But for `seconds` the result does not depend on `executor`. The other arguments are those of `explore` and
    `map_tasks`.

    Raises:
        CogmapError: `runs` is below 1, or what those raise.
    """
    growth = (settings or Settings()).growth
    one = partial(_one, maze, agent, growth, {"settings": settings, "cscg": cscg, "max_steps": max_steps})
    return map_seeds(one, runs=runs, seed=seed, executor=executor, on_done=on_done)


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
        values = [value for run in runs if (value := getattr(run, name)) is not None]
        summary[f"mean_{name}"] = float(np.mean(values)) if values else None
        summary[f"std_{name}"] = float(np.std(values)) if values else None
    oracles = [run.oracle_steps for run in runs if run.oracle_steps is not None]
    exact = len(oracles) == len(runs)
    summary["mean_oracle_steps"] = float(np.mean(oracles)) if exact else None
    summary["ratio"] = _ratio(done) if exact and done else None
    if not exact:
        instead = [run.frontier_steps for run in runs if run.frontier_steps is not None]
        summary["mean_frontier_steps"] = float(np.mean(instead))
    return summary


def exploration(
    maze: Maze,
    runs: Sequence[ExploreRun],
    *,
    agent: str,
    settings: Settings | None = None,
    cscg: CscgSettings | None = None,
    max_steps: int | None = None,
) -> dict[str, Any]:
    """World, agent, settings (none for a baseline that has none), runs and summary, as plain JSON values."""
    most = default_steps(maze) if max_steps is None else max_steps
    return {
        "world": maze.name,
        "agent": agent,
        "settings": settings_of(agent, maze, settings, cscg),
        "runs": [run.to_dict() for run in runs],
        "summary": summarise(runs, max_steps=most),
    }


def _one(maze: Maze, agent: str, growth: str, options: dict[str, Any], seed: int) -> ExploreRun:
    return run_cell(Cell(maze, agent, seed, growth), **options).run


def _ratio(done: Sequence[ExploreRun]) -> float:
    steps = sum(run.steps_to_complete or 0 for run in done)
    oracle = sum(run.oracle_steps or 0 for run in done)
    return steps / oracle if oracle else 1.0
