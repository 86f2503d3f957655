"""What some ways to a goal come to."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Any

from ..navigating import NavigateRun
from .intervals import Interval, bootstrap


@dataclass(frozen=True, slots=True)
class Summary:
    """What some runs come to. Steps and ratio are of the runs that reached the goal, `failed` counts all others.

    Attributes:
        runs: all of them.
        failed: never chose to stay on the goal, or never knew the maze.
        steps: until the agent chose to stay on the goal.
        to_stand: until it first stood there.
        shortest: of the shortest path.
        frontier: of nearest-frontier search until it first stood there; None with a map.
        ratio: total of `steps` over the total of `shortest`; None where that is 0.
    """

    runs: int
    failed: int
    steps: Interval | None
    to_stand: Interval | None
    shortest: Interval | None
    frontier: Interval | None
    ratio: Interval | None

    def to_dict(self) -> dict[str, Any]:
        """The fields as plain JSON values."""
        return asdict(self)


def summarise_goals(runs: Iterable[NavigateRun]) -> Summary:
    """What these runs come to."""
    rows = list(runs)
    there = [run for run in rows if run.reached]
    steps, shortest = [run.steps or 0 for run in there], [run.shortest or 0 for run in there]
    frontier = [run.frontier_steps for run in there if run.frontier_steps is not None]
    return Summary(
        runs=len(rows),
        failed=len(rows) - len(there),
        steps=bootstrap(steps),
        to_stand=bootstrap([run.steps_to_stand or 0 for run in there]),
        shortest=bootstrap(shortest),
        frontier=bootstrap(frontier),
        ratio=bootstrap(steps, shortest),
    )
