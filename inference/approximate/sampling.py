"""Importance sampling, with a proposal from mini-bucket elimination.

Buckets are eliminated as in the exact engine, but where a product would have more than `largest` entries its tables are
multiplied in several parts. What comes out of this relaxed elimination is sampled from the last bucket to the first,
and each sample weighed by what was relaxed. With one part in every bucket that is exact sampling, all weights equal.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...model import CogmapError, FloatArray, IntArray
from ..errors import impossible
from ..exact import Problem, Solution, Table, draw, eliminated, in_logs, plan_elimination, product

Part = tuple[tuple[int, ...], Table]


@dataclass(frozen=True, slots=True)
class Sampling:
    """Importance sampling, an approximation with standard errors.

    Raises:
        CogmapError: an option is out of its range.
    """

    name: ClassVar[str] = "sampling"  # of the engine
    samples: int = 10_000  # number of samples
    seed: int = 0  # of the random numbers
    largest: float = 2e4  # entries of the largest product of the proposal; more make better samples

    def __post_init__(self) -> None:
        if self.samples < 2 or self.largest < 1:
            raise CogmapError("sampling: give 2 samples or more, and largest=1 or more")

    def solve(self, problem: Problem) -> SamplingSolution:
        """Weighted samples of all variables. Raises CogmapError: no sample has a weight above 0."""
        rng = np.random.default_rng(self.seed)
        order = plan_elimination(problem, memory=math.inf).order
        parts, log_bound = _parts(problem, order, self.largest)
        nodes, log_q = _proposed(problem, order, parts, self.samples, rng)
        logs = np.full(self.samples, problem.log_scale) - log_q
        for scope, table in zip(problem.scopes, problem.tables, strict=True):
            logs += in_logs(table.values[tuple([nodes[i] for i in scope])])
        logs[~np.isfinite(logs)] = -math.inf  # ways that led nowhere
        top = float(logs.max())
        if top == -math.inf:
            raise CogmapError(
                f"sampling: none of {self.samples} samples has a product above 0; take more samples, a larger "
                "`largest`, or another engine; the evidence may be impossible"
            )
        weights = np.exp(logs - top)
        total = float(weights.sum())
        weights /= total
        effective = 1.0 / float(weights @ weights)
        log_evidence = top + math.log(total / self.samples)
        error = math.sqrt(max(1.0 / effective - 1.0 / self.samples, 0.0))
        report = SamplingReport(self.samples, effective, error, log_bound)
        return SamplingSolution(problem, report, problem.columns(nodes), weights, log_evidence)


@dataclass(frozen=True, slots=True)
class SamplingReport:
    """How good the weighted samples are."""

    samples: int  # number of samples
    # number of equally weighted samples that are worth as much; below some hundred the standard errors cannot
    # be relied on
    effective_samples: float
    log_evidence_error: float  # standard error of log Z
    # log Z is at most this; far above the estimate, the samples may have missed what matters, and the standard
    # errors with them
    log_evidence_bound: float

    def __str__(self) -> str:
        return f"approximate: {self.samples} weighted samples, worth {self.effective_samples:.0f}"


@dataclass(frozen=True, slots=True)
class SamplingSolution(Solution):
    """Weighted samples."""

    problem: Problem  # what was asked
    report: SamplingReport  # how good the samples are
    drawn: IntArray  # `[variables, samples]` indices of labels
    weights: FloatArray  # `[samples]`, summing to 1
    log_evidence: float  # log of the mean weight; Z itself is estimated without bias

    def joint(self, names: Sequence[str]) -> FloatArray:
        return self._counted(names, self.weights)

    def standard_error(self, names: Sequence[str]) -> FloatArray:
        """Standard error of each entry of `joint`: sqrt(Σ_n w_n² (1[x_n] - P)²)."""
        p = self.joint(names)
        squares = self.weights**2
        variance = self._counted(names, squares) * (1.0 - 2.0 * p) + squares.sum() * p**2
        return np.sqrt(np.maximum(variance, 0.0))  # rounding may leave less than 0

    def sample(self, count: int, rng: np.random.Generator) -> IntArray:
        """`[variables, count]` indices of labels, drawn among the samples by weight."""
        return self.drawn[:, rng.choice(len(self.weights), size=count, p=self.weights)]

    def _counted(self, names: Sequence[str], weights: FloatArray) -> FloatArray:
        number = self.problem.graph.wiring.number
        result = np.zeros([self.problem.graph.variable_named(name).cardinality for name in names])
        np.add.at(result, tuple(self.drawn[number[name]] for name in names), weights)
        return result


def _parts(problem: Problem, order: Sequence[int], largest: float) -> tuple[list[list[Part]], float]:
    """For each node in order the parts of its bucket, the node's own axis first; and an upper bound on log Z.

    Messages go on to later buckets. The first part of a bucket is summed over the node, the others are maximised.
    """
    log_bound = problem.log_scale
    place = {i: at for at, i in enumerate(order)}
    waiting: list[list[Part]] = [[] for _ in order]
    for scope, table in zip(problem.scopes, problem.tables, strict=True):
        axes = sorted(range(len(scope)), key=lambda axis: place[scope[axis]])
        into = tuple([scope[axis] for axis in axes])
        waiting[place[into[0]]].append((into, table.holding(table.values.transpose(axes))))
    result: list[list[Part]] = []
    for at, i in enumerate(order):
        parts = [_multiplied(problem, i, part, place) for part in _split(problem, i, waiting[at], largest)]
        result.append(parts)
        log_bound += 0.0 if parts else math.log(problem.cards[i])
        for number, (scope, table) in enumerate(parts):
            message = eliminated(table, maximum=number > 0)[2]
            if len(scope) > 1:
                waiting[place[scope[1]]].append((scope[1:], message))
            else:
                log_bound += float(message.log_values()) + message.offset
        if log_bound == -math.inf:
            raise impossible(problem.graph, problem.given.labels, [problem.names[i]])
    return result, log_bound


def _split(problem: Problem, i: int, tables: Sequence[Part], largest: float) -> list[list[Part]]:
    """Tables put together as long as their product has no more than `largest` entries."""
    groups: list[tuple[set[int], list[Part]]] = []
    for part in sorted(tables, key=lambda part: -part[1].values.size):
        for members, group in groups:
            together = members.union(part[0])
            if math.prod([float(problem.cards[j]) for j in together]) <= largest:
                members.update(part[0])
                group.append(part)
                break
        else:
            groups.append(({i, *part[0]}, [part]))
    return [group for _, group in groups]


def _multiplied(problem: Problem, i: int, tables: Sequence[Part], place: dict[int, int]) -> Part:
    scope = tuple(sorted({i}.union(*(own for own, _ in tables)), key=place.__getitem__))
    cards = problem.cards
    shaped = [
        table.holding(table.values.reshape([cards[j] if j in own else 1 for j in scope])) for own, table in tables
    ]
    return scope, product(shaped, tuple(cards[j] for j in scope))


def _proposed(
    problem: Problem, order: Sequence[int], parts: Sequence[Sequence[Part]], count: int, rng: np.random.Generator
) -> tuple[IntArray, FloatArray]:
    """`[nodes, count]` samples of the relaxed model, and the log of the probability of each."""
    drawn = np.zeros((len(problem.cards), count), dtype=np.int64)
    log_q = np.zeros(count)
    for i, bucket in zip(reversed(order), reversed(parts), strict=True):
        logs = np.zeros((problem.cards[i], count))
        for scope, table in bucket:
            column = table.values[(slice(None), *[drawn[j] for j in scope[1:]])]
            column = column if table.logs else in_logs(column)
            logs = logs + (column if column.ndim > 1 else column[:, None])
        top = logs.max(axis=0)
        weights = np.exp(logs - np.where(np.isfinite(top), top, 0.0))
        drawn[i] = np.minimum(draw(weights, rng), problem.cards[i] - 1)
        chosen, total = weights[drawn[i], np.arange(count)], weights.sum(axis=0)
        with np.errstate(divide="ignore", invalid="ignore"):
            log_q += np.where(total > 0, np.log(chosen / total), math.inf)
    return drawn, log_q
