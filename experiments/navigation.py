"""What many ways to a goal come to."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Unpack

from ..worlds import Maze
from .exploring import checked_steps
from .navigating import WEIGHT, NavigateRun, Options
from .session import mean
from .walkers import settings_of


def navigate_result(maze: Maze, runs: Sequence[NavigateRun], **options: Unpack[Options]) -> dict[str, Any]:
    """World, agent, goal, settings, runs and summary, as plain JSON values; `options` are those of `navigate`.

    Totals, means and the ratio of the totals are over the runs that reached the goal; `failed` counts the others.
    The ratio is None where none reached it, and where every one of them started there but walked all the same.
    """
    known, agent, closed = options.get("known", True), options.get("agent", "cogmap"), options.get("closed", ())
    there = [run for run in runs if run.reached]
    steps, shortest = [run.steps or 0 for run in there], [run.shortest or 0 for run in there]
    summary: dict[str, Any] = {"runs": len(runs), "reached": len(there), "failed": len(runs) - len(there)}
    if known:
        summary["explored"] = sum(run.steps_to_explore is not None for run in runs)
    summary |= {
        "max_steps": checked_steps("navigate", maze, options.get("max_steps")),
        "total_steps": sum(steps),
        "total_shortest": sum(shortest),
        "ratio": _ratio(steps, shortest),
        "mean_steps": mean(steps),
        "mean_shortest": mean(shortest),
    }
    if not known:
        frontier = [run.frontier_steps or 0 for run in there]
        summary |= {"total_frontier_steps": sum(frontier), "mean_frontier_steps": mean(frontier)}
    return {
        "world": maze.name,
        "agent": agent,
        "goal": options["goal"],
        "weight": options.get("weight", WEIGHT),
        "unexplored": not known,
        **({"closed": [list(room) for room in closed]} if closed else {}),
        "settings": settings_of(agent, maze, options.get("settings"), options.get("cscg")),
        "runs": [run.to_dict() for run in runs],
        "summary": summary,
    }


def _ratio(steps: Sequence[int], shortest: Sequence[int]) -> float | None:
    if sum(shortest):
        return sum(steps) / sum(shortest)
    return 1.0 if steps and not sum(steps) else None
