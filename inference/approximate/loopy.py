"""Loopy belief propagation: damped sum-product on a graph with loops, and the evidence by Bethe's free energy.

Every message from a table to a node is made anew at once, from all messages of the last round; tables of one shape go
together. Exact on trees. Messages are kept as logs, with `ZERO` for log 0, so that they can be taken out of sums again.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...model import CogmapError, Factor, FloatArray, IntArray
from ..errors import impossible
from ..exact import Problem, Solution, in_logs

ZERO = -1e8  # stands for log 0


@dataclass(frozen=True, slots=True)
class Loopy:
    """Loopy belief propagation, an approximation.

    Raises:
        CogmapError: an option is out of its range.
    """

    name: ClassVar[str] = "loopy"  # of the engine
    damping: float = 0.5  # part of the log of a message that stays as it was, 0 or more, below 1
    iterations: int = 2000  # rounds at most
    tolerance: float = 1e-9  # it has converged where no marginal changes by more in a round

    def __post_init__(self) -> None:
        if not (0 <= self.damping < 1 and self.iterations >= 1 and self.tolerance > 0):
            raise CogmapError("loopy: give damping in [0, 1), 1 iteration or more, and a tolerance above 0")

    def solve(self, problem: Problem) -> LoopySolution:
        """Beliefs of all nodes and tables.

        Raises:
            ImpossibleEvidence: a node has no label left; evidence that is impossible otherwise is not noticed.
        """
        run = _Run(problem)
        change, done = math.inf, 0
        while done < self.iterations and change > self.tolerance:
            change, done = run.round(self.damping), done + 1
        report = LoopyReport(change <= self.tolerance, done, change)
        tables = [belief for group in run.groups for belief in group.beliefs(run.nodes)]
        scopes = [scope for group in run.groups for scope in group.scopes]
        return LoopySolution(problem, report, run.beliefs(), scopes, tables, run.log_evidence())


@dataclass(frozen=True, slots=True)
class LoopyReport:
    """How loopy belief propagation converged."""

    converged: bool  # whether it settled; where it did not, its numbers mean little
    iterations: int  # rounds that it took
    change: float  # largest change of a marginal in the last of them

    def __str__(self) -> str:
        how = (
            f"converged in {self.iterations} rounds" if self.converged else f"NOT CONVERGED in {self.iterations} rounds"
        )
        return f"approximate: loopy belief propagation, {how}"


@dataclass(frozen=True, slots=True)
class LoopySolution(Solution):
    """Beliefs of nodes and tables."""

    problem: Problem  # what was asked
    report: LoopyReport  # how it went
    nodes: Sequence[FloatArray]  # `[cardinality]` belief of each node
    scopes: Sequence[tuple[int, ...]]  # nodes of each table of several nodes
    tables: Sequence[FloatArray]  # belief of each of these
    log_evidence: float  # minus Bethe's free energy; neither a bound nor exact, but on trees
    instead: ClassVar[str] = "use an exact engine, or engine='sampling'"

    def joint(self, names: Sequence[str]) -> FloatArray:
        """The belief of variables that have a factor in common."""
        wanted = self.problem.nodes(names)
        if len(wanted) < 2:
            return self.problem.expand(names, {wanted: self.nodes[wanted[0]] if wanted else np.ones(())})
        for scope, belief in zip(self.scopes, self.tables, strict=True):
            if set(wanted) <= set(scope):
                summed = belief.sum(axis=tuple(axis for axis, i in enumerate(scope) if i not in wanted))
                left = [i for i in scope if i in wanted]
                return self.problem.expand(names, {wanted: summed.transpose([left.index(i) for i in wanted])})
        raise CogmapError(
            f"loopy: no factor holds all of {', '.join(names)}, so there is no belief of them; {self.instead}"
        )

    def entries(self, factor: Factor) -> tuple[IntArray, FloatArray] | None:
        return self.problem.listed(factor, self.nodes.__getitem__)

    def standard_error(self, names: Sequence[str]) -> FloatArray:
        raise CogmapError(f"loopy: how far its marginals are off is not known; {self.instead}")


class _Group:
    """The tables of one shape.

    Attributes:
        scopes: nodes of each.
        logs: `[tables, *shape]` logs of their values.
        messages: for each axis `[tables, cardinality]` logs, largest 0.
    """

    def __init__(self, scopes: Sequence[tuple[int, ...]], logs: FloatArray) -> None:
        self.scopes, self.logs = scopes, logs
        self.members: IntArray = np.array(scopes)
        self.messages = [np.zeros((len(scopes), length)) for length in logs.shape[1:]]

    def product(self, nodes: FloatArray) -> tuple[FloatArray, list[FloatArray]]:
        """Logs of tables times the messages that come in, and these by axis."""
        whole, incoming = self.logs, list[FloatArray]()
        for axis, messages in enumerate(self.messages):
            into = nodes[self.members[:, axis], : messages.shape[1]] - messages
            into = into - into.max(axis=1, keepdims=True)
            incoming.append(into)
            whole = whole + into.reshape(
                [len(into), *(into.shape[1] if a == axis else 1 for a in range(len(self.messages)))]
            )
        return whole, incoming

    def send(self, nodes: FloatArray, damping: float) -> None:
        """Make all messages anew."""
        whole, incoming = self.product(nodes)
        for axis, into in enumerate(incoming):
            others = tuple(a + 1 for a in range(len(incoming)) if a != axis)
            top = whole.max(axis=others, keepdims=True)
            new = np.log(np.exp(whole - top).sum(axis=others)) + top.reshape(into.shape) - into
            new = np.maximum(new - new.max(axis=1, keepdims=True), ZERO)
            self.messages[axis] = damping * self.messages[axis] + (1.0 - damping) * new

    def beliefs(self, nodes: FloatArray) -> FloatArray:
        """`[tables, *shape]` belief of each table."""
        whole, _ = self.product(nodes)
        axes = tuple(range(1, whole.ndim))
        weights = np.exp(whole - whole.max(axis=axes, keepdims=True))
        return weights / weights.sum(axis=axes, keepdims=True)


class _Run:
    """Nodes, padded to the largest number of labels, and groups of tables."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        count, most = len(problem.cards), max(problem.cards, default=1)
        labels = np.arange(most) < np.array(problem.cards, dtype=int).reshape(count, 1)
        self.own = np.where(labels, 0.0, ZERO)
        by_shape: dict[tuple[int, ...], list[int]] = {}
        for at, scope in enumerate(problem.scopes):
            if len(scope) == 1:
                self.own[scope[0], : problem.cards[scope[0]]] += _logs(problem.tables[at].values)
            else:
                by_shape.setdefault(problem.tables[at].values.shape, []).append(at)
        self.groups = [
            _Group([problem.scopes[at] for at in group], np.stack([_logs(problem.tables[at].values) for at in group]))
            for group in by_shape.values()
        ]
        self.nodes = self.own

    def round(self, damping: float) -> float:
        """One round; the largest change of a marginal."""
        before = _normalised(self.nodes)
        for group in self.groups:
            group.send(self.nodes, damping)
        self.nodes = self.own.copy()
        for group in self.groups:
            for axis, messages in enumerate(group.messages):
                np.add.at(self.nodes[:, : messages.shape[1]], group.members[:, axis], messages)
        lost = np.flatnonzero(self.nodes.max(axis=1, initial=ZERO) <= ZERO / 2)
        if len(lost):
            names = [self.problem.names[i] for i in lost.tolist()]
            raise impossible(self.problem.graph, self.problem.given.labels, names)
        return float(abs(_normalised(self.nodes) - before).max(initial=0.0))

    def beliefs(self) -> list[FloatArray]:
        """`[cardinality]` belief of each node."""
        beliefs = _normalised(self.nodes)
        return [belief[:card] for belief, card in zip(beliefs, self.problem.cards, strict=True)]

    def log_evidence(self) -> float:
        """Σ_f Σ b_f log(f / b_f) + Σ_i (d_i - 1) Σ b_i log b_i, d_i the number of tables of node i."""
        from scipy.special import xlogy  # slow to import, and only needed here

        beliefs = _normalised(self.nodes)
        shared = np.zeros(len(beliefs))
        total = self.problem.log_scale + _expected(beliefs, self.own)
        for group in self.groups:
            table_beliefs = group.beliefs(self.nodes)
            total += _expected(table_beliefs, group.logs) - float(xlogy(table_beliefs, table_beliefs).sum())
            np.add.at(shared, group.members, 1.0)
        return total + float((shared - 1.0) @ xlogy(beliefs, beliefs).sum(axis=1))


def _logs(values: FloatArray) -> FloatArray:
    return np.maximum(in_logs(values), ZERO)


def _normalised(logs: FloatArray) -> FloatArray:
    weights = np.exp(logs - logs.max(axis=1, keepdims=True, initial=ZERO * 1e3))
    return weights / weights.sum(axis=1, keepdims=True)


def _expected(weights: FloatArray, logs: FloatArray) -> float:
    """Σ w l; what stands for log 0 has no weight."""
    return float((weights * logs).sum())
