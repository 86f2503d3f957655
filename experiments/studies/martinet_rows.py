"""What the training after Martinet et al. notes down, and what it comes to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from .intervals import Interval, bootstrap
from .tolman_maze import MAZE, ROUTES, START

FREE = 9
"""Free runs on the first day, after a forced one by each route."""
BLOCKED = 10
"""Runs with A closed on each day from the second, and two free runs among them."""
PROBES = 7
"""Runs with B closed on the last day."""
MOST = 60
"""Steps after which a run is given up; it ends at the goal (the original has no limit)."""

CONDITIONS = {"free": (1, 2, 3), "A closed": (2, 3), "B closed": (2, 3)}
"""Conditions, and the routes that count in each: route 1 is left out where it is closed, as in the original."""
EXPECTED = {"free": ((1, 2), (1, 3)), "A closed": ((2, 3),), "B closed": ((3, 2),)}
"""Which route was taken more often than which by the animals of Martinet et al., each with p < 0.0001 (ANOVA)."""


@dataclass(frozen=True, slots=True)
class MartinetRun:
    """One run.

    Attributes:
        day: from 1.
        condition: `forced`, `free`, `A closed` or `B closed`.
        route: the one that counts: by which the goal was reached, or, where the agent was led to the block first,
            the one that it then chose; None if neither came about.
        steps: until the goal, None if it was not reached.
    """

    day: int
    condition: str
    route: int | None
    steps: int | None

    def to_dict(self) -> dict[str, Any]:
        """The run as plain JSON values."""
        return {"day": self.day, "condition": self.condition, "route": self.route, "steps": self.steps}


@dataclass(frozen=True, slots=True)
class MartinetRow:
    """One agent.

    Attributes:
        seed: of the agent.
        runs: all of them, in their order.
    """

    seed: int
    runs: tuple[MartinetRun, ...]

    def counts(self, condition: str) -> dict[int, int]:
        """Runs by route, of the first day's free runs, or of all with the room closed."""
        runs = [run for run in self.runs if run.condition == condition and (condition != "free" or run.day == 1)]
        return {route: sum(run.route == route for run in runs) for route in ROUTES}

    def to_dict(self) -> dict[str, Any]:
        """The row as plain JSON values."""
        counts = {name: {str(k): n for k, n in self.counts(name).items()} for name in CONDITIONS}
        return {"seed": self.seed, "counts": counts, "runs": [run.to_dict() for run in self.runs]}


@dataclass(frozen=True, slots=True)
class Preference:
    """Whether one route is taken more often than another.

    Attributes:
        condition: under which.
        more: the route that is expected more often.
        less: the other.
        difference: of their shares, mean of the agents, with its interval; None if neither was ever taken.
        p_value: one-sided Wilcoxon signed-rank test over the agents; None with fewer than two.
    """

    condition: str
    more: int
    less: int
    difference: Interval | None
    p_value: float | None

    def to_dict(self) -> dict[str, Any]:
        """The preference as plain JSON values."""
        difference = None if self.difference is None else self.difference.to_dict()
        return {
            "condition": self.condition,
            "more": self.more,
            "less": self.less,
            "difference": difference,
            "p_value": self.p_value,
        }


@dataclass(frozen=True, slots=True)
class MartinetResult:
    """All agents in the order of their seeds.

    Attributes:
        rows: the agents.
        days: of training.
    """

    rows: tuple[MartinetRow, ...]
    days: int

    def share(self, condition: str, route: int) -> Interval | None:
        """The share of a route among those that count, with its interval over the agents."""
        counts = [row.counts(condition) for row in self.rows]
        totals = [sum(count[r] for r in CONDITIONS[condition]) for count in counts]
        return bootstrap([count[route] for count in counts], totals)

    def preferences(self) -> list[Preference]:
        """The comparisons of the original."""
        return [_preference(self.rows, name, *pair) for name, pairs in EXPECTED.items() for pair in pairs]

    def to_dict(self) -> dict[str, Any]:
        """World, protocol, rows and summary as plain JSON values."""
        shares = {
            name: {str(r): None if (s := self.share(name, r)) is None else s.to_dict() for r in routes}
            for name, routes in CONDITIONS.items()
        }
        runs = [run for row in self.rows for run in row.runs]
        return {
            "world": MAZE.name,
            "protocol": {
                "start": list(START),
                "days": self.days,
                "forced_runs": len(ROUTES),
                "free_runs_first_day": FREE,
                "runs_with_A_closed_a_day": BLOCKED,
                "runs_with_B_closed": PROBES,
                "most_steps_a_run": MOST,
            },
            "rows": [row.to_dict() for row in self.rows],
            "summary": {
                "agents": len(self.rows),
                "runs": len(runs),
                "reached": sum(run.steps is not None for run in runs),
                "shares": shares,
                "preferences": [preference.to_dict() for preference in self.preferences()],
            },
        }


def _preference(rows: Sequence[MartinetRow], condition: str, more: int, less: int) -> Preference:
    from scipy.stats import wilcoxon

    counts = [row.counts(condition) for row in rows]
    totals = [sum(count[route] for route in CONDITIONS[condition]) for count in counts]
    differences = [count[more] - count[less] for count in counts]
    p_value = None
    if len(rows) > 1:
        test: Any = wilcoxon(differences, alternative="greater") if any(differences) else None
        p_value = 1.0 if test is None else float(test.pvalue)
    return Preference(condition, more, less, bootstrap(differences, totals), p_value)
