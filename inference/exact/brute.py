"""The oracle: every assignment enumerated, in log space. For small graphs and for tests."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...model import CogmapError, FactorGraph, FloatArray, IntArray
from ..errors import impossible
from ..evidence import Given
from .solution import Solution

MOST_ASSIGNMENTS = 2_000_000


@dataclass(frozen=True, slots=True)
class BruteSolution(Solution):
    """All assignments with their posterior."""

    graph: FactorGraph  # the graph
    log_evidence: float  # log Z
    assignments: IntArray  # `[n, variables]` label indices, n assignments that fit the evidence
    probabilities: FloatArray  # `[n]` posterior of each

    def joint(self, names: Sequence[str]) -> FloatArray:
        column = self.graph.wiring.number
        result = np.zeros([self.graph.variable_named(name).cardinality for name in names])
        np.add.at(result, tuple(self.assignments[:, column[name]] for name in names), self.probabilities)
        return result

    def entropy(self) -> float:
        positive = self.probabilities[self.probabilities > 0]
        return -float(positive @ np.log(positive))

    def sample(self, count: int, rng: np.random.Generator) -> IntArray:
        return self.assignments[rng.choice(len(self.probabilities), size=count, p=self.probabilities)].T


def solve(graph: FactorGraph, given: Given) -> BruteSolution:
    """log Z = log Σ_x Π_f f(x).

    Raises:
        ImpossibleEvidence: Z = 0.
        CogmapError: more than `MOST_ASSIGNMENTS` assignments.
    """
    assignments, logs = enumerated(graph, given)
    top = float(logs.max())
    weights = np.exp(logs - top)
    return BruteSolution(graph, top + math.log(weights.sum()), assignments, weights / weights.sum())


def enumerated(graph: FactorGraph, given: Given) -> tuple[IntArray, FloatArray]:
    """All assignments that fit the evidence, `[n, variables]`, and the log of the product of each.

    Raises: as `solve`.
    """
    fixed = given.fixed
    cards = [1 if i in fixed else v.cardinality for i, v in enumerate(graph.variables)]
    count = math.prod(cards)
    if count > MOST_ASSIGNMENTS:
        raise CogmapError(f"engine 'brute': {count:.3g} assignments, above {MOST_ASSIGNMENTS:.3g}; use engine='numpy'")
    columns: list[IntArray] = []
    repeat = count
    for i, card in enumerate(cards):
        repeat //= card
        columns.append(np.arange(count) // repeat % card + fixed.get(i, 0))
    logs = np.zeros(count)
    with np.errstate(divide="ignore"):
        for factor, scope in zip(graph.factors, graph.wiring.scopes, strict=True):
            logs += np.log(factor.at([columns[i] for i in scope]))
        for i, likelihoods in given.soft.items():
            logs += np.log(likelihoods[columns[i]])
    if not np.isfinite(logs.max()):
        raise impossible(graph, given.labels, graph.wiring.number)
    stacked = np.stack(columns, axis=1) if columns else np.zeros((1, 0), dtype=np.int64)
    return stacked, logs
