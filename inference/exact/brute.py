"""The oracle: every assignment enumerated, in log space. For small graphs and for tests."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...model import CogmapError, FloatArray, IntArray
from ..errors import impossible
from ..evidence import fixed_indices
from .problem import Problem

MOST_ASSIGNMENTS = 2_000_000


@dataclass(frozen=True, slots=True)
class BruteSolution:
    """All assignments with their posterior.

    Attributes:
        problem: only its graph and evidence are used, none of its reductions.
        log_evidence: log Z.
        assignments: `[n, variables]` label indices, n assignments that fit the evidence.
        probabilities: `[n]` posterior of each.
    """

    problem: Problem
    log_evidence: float
    assignments: IntArray
    probabilities: FloatArray

    def joint(self, names: Sequence[str]) -> FloatArray:
        """P(names | evidence), one axis a name."""
        column = {variable.name: i for i, variable in enumerate(self.problem.graph.variables)}
        result = np.zeros([self.problem.graph.variable_named(name).cardinality for name in names])
        np.add.at(result, tuple(self.assignments[:, column[name]] for name in names), self.probabilities)
        return result

    def entropy(self) -> float:
        """H = -Σ_x P(x) log P(x), in nats."""
        positive = self.probabilities[self.probabilities > 0]
        return -float(positive @ np.log(positive))


def solve(problem: Problem, order: Sequence[str] | None = None) -> BruteSolution:
    """log Z = log Σ_x Π_f f(x); `order` is not needed.

    Raises:
        ImpossibleEvidence: Z = 0.
        CogmapError: more than `MOST_ASSIGNMENTS` assignments.
    """
    assignments, logs = _enumerated(problem)
    top = float(logs.max())
    weights = np.exp(logs - top)
    return BruteSolution(problem, top + math.log(weights.sum()), assignments, weights / weights.sum())


def most_probable(problem: Problem) -> dict[str, int]:
    """Index of each variable of the graph in the first assignment with the largest product."""
    assignments, logs = _enumerated(problem)
    best = assignments[int(logs.argmax())]
    return {variable.name: int(i) for variable, i in zip(problem.graph.variables, best, strict=True)}


def _enumerated(problem: Problem) -> tuple[IntArray, FloatArray]:
    graph = problem.graph
    fixed = fixed_indices(graph, problem.given)
    cards = [1 if v.name in fixed else v.cardinality for v in graph.variables]
    count = math.prod(cards)
    if count > MOST_ASSIGNMENTS:
        raise CogmapError(f"engine 'brute': {count:.3g} assignments, above {MOST_ASSIGNMENTS:.3g}; use engine='numpy'")
    columns: dict[str, IntArray] = {}
    repeat = count
    for variable, card in zip(graph.variables, cards, strict=True):
        repeat //= card
        own = np.arange(count) // repeat % card
        columns[variable.name] = own + fixed.get(variable.name, 0)
    logs = np.zeros(count)
    with np.errstate(divide="ignore"):
        for factor in graph.factors:
            logs += np.log(factor.dense()[tuple(columns[v.name] for v in factor.scope)])
    if not np.isfinite(logs.max()):
        raise impossible(graph, problem.given, columns)
    stacked = np.stack(list(columns.values()), axis=1) if columns else np.zeros((1, 0), dtype=np.int64)
    return stacked, logs
