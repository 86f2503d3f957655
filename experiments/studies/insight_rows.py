"""What the study of insight notes down, and what it comes to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ..records import mean
from .shares import Share, wilson
from .tolman_maze import MAZE, ROUTES, RUNS, START, STEPS, B, Choice, TolmanRun, choice_after

WANDER = 5000
"""Steps that the control walks at random before its training, so that it knows what every way pays."""
RATS = wilson(9, 10)
"""Rats that tried route 3 first: Tolman and Honzik, "Insight" in rats, Univ. Calif. Publ. Psychol. 4:215, 1930, after
secondary sources."""


@dataclass(frozen=True, slots=True)
class InsightRow:
    """One agent, or one control.

    Attributes:
        seed: of the agent.
        training: the runs without obstacle.
        probe: the runs with B closed, until the goal was reached again.
    """

    seed: int
    training: tuple[TolmanRun, ...]
    probe: tuple[TolmanRun, ...]

    @property
    def choice(self) -> Choice | None:
        """What was tried after B was first met; None if it never was."""
        return choice_after(self.probe)

    @property
    def steps_to_goal(self) -> int | None:
        """Steps with B closed until the goal was reached again; None if never."""
        last = self.probe[-1]
        return None if last.reached_at is None else STEPS * (len(self.probe) - 1) + last.reached_at

    def to_dict(self) -> dict[str, Any]:
        """The row as plain JSON values."""
        return {
            "seed": self.seed,
            "trained_by_route": _routes(self.training),
            "choice": None if self.choice is None else self.choice.to_dict(),
            "steps_to_goal": self.steps_to_goal,
            "training": [run.to_dict() for run in self.training],
            "probe": [run.to_dict() for run in self.probe],
        }


@dataclass(frozen=True, slots=True)
class InsightResult:
    """Agents and controls with the same seeds."""

    agents: tuple[InsightRow, ...]
    controls: tuple[InsightRow, ...]

    @property
    def p_value(self) -> float:
        """Fisher's exact test, one-sided: the agents try route 3 first no more often than the controls."""
        from scipy.stats import fisher_exact

        table = [[s.count, s.of - s.count] for s in (route_3_first(self.agents), route_3_first(self.controls))]
        test: Any = fisher_exact(table, alternative="greater")
        return float(test.pvalue)

    def to_dict(self) -> dict[str, Any]:
        """World, protocol, rows and summary as plain JSON values."""
        return {
            "world": MAZE.name,
            "protocol": {
                "start": list(START),
                "closed": list(B),
                "training_runs": RUNS,
                "steps_a_run": STEPS,
                "control": f"tabular Q-learning, {WANDER} random steps before its training",
            },
            "rows": [row.to_dict() for row in self.agents],
            "controls": [row.to_dict() for row in self.controls],
            "summary": {
                "agents": summary(self.agents),
                "controls": summary(self.controls),
                "rats": {"route_3_first": RATS.to_dict()},
                "p_value": self.p_value,
            },
        }


def route_3_first(rows: Sequence[InsightRow]) -> Share:
    """Who tried route 3 before route 2, of all: those that never met the block count against it."""
    return wilson(sum(row.choice is not None and row.choice.route == 3 for row in rows), len(rows))


def summary(rows: Sequence[InsightRow]) -> dict[str, Any]:
    """Counts and means over the rows; None where there are none."""
    choices = [row.choice for row in rows if row.choice is not None]
    training = [run for row in rows for run in row.training]
    goals = [row.steps_to_goal for row in rows if row.steps_to_goal is not None]
    return {
        "agents": len(rows),
        "training_runs": len(training),
        "trained_by_route": _routes(training),
        "met_block": len(choices),
        "met_by_route": {str(route): sum(choice.met_by == route for choice in choices) for route in ROUTES},
        "route_3_first": route_3_first(rows).to_dict(),
        "route_2_first": wilson(sum(choice.route == 2 for choice in choices), len(rows)).to_dict(),
        "route_2_from_the_fork": sum(choice.at_fork for choice in choices),
        "mean_again": mean([choice.again for choice in choices]),
        "mean_steps_to_choice": mean([choice.steps for choice in choices]),
        "reached_again": len(goals),
        "mean_steps_to_goal": mean(goals),
    }


def _routes(runs: Sequence[TolmanRun]) -> dict[str, int]:
    return {str(route): sum(run.route == route for run in runs) for route in ROUTES}
