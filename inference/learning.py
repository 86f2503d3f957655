"""Learning the tables of a graph from data: expectation maximisation, and variational Bayes with Dirichlet priors.

All rows of data are asked at once: the number of the row is one more variable, and a table over it and each variable
with data says what was seen. Eliminating everything but the row gives the likelihood of each row.
"""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np

from ..model import CogmapError, ConditionalTable, Factor, FactorGraph, FloatArray, IntArray, Variable
from .errors import ImpossibleEvidence
from .evidence import given
from .exact import MEMORY, buckets, forward, plan_elimination, reduce, tree_of

METHODS = ("em", "variational")
CHUNK = 2**27  # bytes of products and messages that rows asked at once should take
Data = Mapping[str, Sequence[Hashable]] | Sequence[Mapping[str, Hashable]] | Mapping[Variable, Sequence[Hashable]]


@dataclass(frozen=True, slots=True)
class Fit:
    """The result of `fit`."""

    # the graph with the learned values; its learnable tables are new ones, which have the prior of the old
    # ones, and as counts this prior and the expected counts of the data
    graph: FactorGraph
    method: str  # `"em"` or `"variational"`
    # after each iteration, in nats, never falling: log-likelihood of the data (EM), or the evidence lower bound
    # (variational Bayes)
    objective: tuple[float, ...]
    converged: bool  # whether it settled before the iterations ran out
    # expected counts of the data `[outcome, *parents]`, by label of the factor; those that share a table share
    # them
    counts: Mapping[str, FloatArray]


def fit(
    graph: FactorGraph,
    data: Data,
    *,
    method: str = "em",
    iterations: int = 500,
    tolerance: float = 1e-10,
    rng: np.random.Generator | int | None = None,
    memory: float = MEMORY,
) -> Fit:
    """Learn the conditionals that are tied to a `ConditionalTable`; neither the graph nor its tables are changed.

    EM finds values of maximal likelihood; a column without data keeps its values, and the priors do not count.
    Variational Bayes finds the Dirichlet posterior of the tables; the values are its mean.

    Args:
        graph: each row of data is seen in a copy of it; its own evidence holds in every row.
        data: labels by variable, a sequence of one a row (a pandas DataFrame too), or a sequence of rows that are
            mappings. None, NaN, and what a row does not name are missing (at random).
        method: `"em"` or `"variational"`.
        iterations: at most.
        tolerance: it has settled where the objective rises by no more than this part of itself.
        rng: start from random values (a generator or a seed) instead of those of the graph: hidden variables whose
            labels are alike at the start stay alike.
        memory: bytes that a query may take.

    Raises:
        CogmapError: nothing to learn, an unknown variable, label or method, rows of different length, or a row that is
            impossible.
    """
    if data is None:  # pyright: ignore[reportUnnecessaryComparison]
        raise CogmapError("fit: the data are None; give labels by variable, or a sequence of rows")
    if method not in METHODS or iterations < 1:
        raise CogmapError(f"fit: method {method!r}, iterations {iterations}; choose one of {METHODS}, and 1 or more")
    rows = _Rows.of(graph, data)
    learned = _Tables(graph, method, None if rng is None else np.random.default_rng(rng))
    objective: list[float] = []
    converged = False
    while len(objective) < iterations and not converged:
        log_likelihood, counts = rows.expected(learned.graph(), learned.tables, memory)
        objective.append(log_likelihood - learned.divergence())
        if len(objective) > 1:
            converged = objective[-1] - objective[-2] <= tolerance * max(1.0, abs(objective[-1]))
        learned.update(counts)
    return Fit(learned.result(), method, tuple(objective), converged, learned.by_label())


class _Tables:
    """The tables while they are learned.

    Attributes:
        tables: the learnable tables, each once.
        values: what the factors of each have: its values, or exp E[log values].
        counts: expected counts of each.
    """

    def __init__(self, graph: FactorGraph, method: str, rng: np.random.Generator | None) -> None:
        self.source, self.method = graph, method
        tied: dict[int, tuple[ConditionalTable, Factor]] = {}
        for factor in graph.factors:
            if isinstance(factor.table, ConditionalTable):
                first = tied.setdefault(id(factor.table), (factor.table, factor))[1]
                if first.shape != factor.shape:
                    raise CogmapError(f"fit: {first.label} and {factor.label} share a table, but not its shape")
        if not tied:
            raise CogmapError(
                "fit: no factor has a ConditionalTable; declare some with graph.conditional, or take "
                "graph.with_tables()"
            )
        self.tables = [table for table, _ in tied.values()]
        self.values = [np.array(factor.dense()) for _, factor in tied.values()]
        if rng is not None:
            self.values = [_normalised(rng.gamma(1.0, size=values.shape) + 1e-3, values) for values in self.values]
        self.counts = [values.copy() for values in self.values]
        if method == "variational":
            self._expected_logs()

    def graph(self) -> FactorGraph:
        return self._with({id(table): (table, values) for table, values in zip(self.tables, self.values, strict=True)})

    def update(self, counts: list[FloatArray]) -> None:
        """Take the values that these expected counts make most likely, or the posterior that they make."""
        self.counts = counts
        if self.method == "em":
            self.values = [_normalised(own, values) for own, values in zip(counts, self.values, strict=True)]
        else:
            self._expected_logs()

    def divergence(self) -> float:
        """KL[q || prior] of the Dirichlet posteriors of all columns; 0 for EM."""
        if self.method == "em":
            return 0.0
        return sum(
            _divergence(table.prior + counts, table.prior)
            for table, counts in zip(self.tables, self.counts, strict=True)
        )

    def result(self) -> FactorGraph:
        new: dict[int, tuple[ConditionalTable, FloatArray]] = {}
        for table, values, counts in zip(self.tables, self.values, self.counts, strict=True):
            fresh = ConditionalTable(table.prior)
            fresh.learn(counts)
            new[id(table)] = fresh, values if self.method == "em" else fresh.mean()
        return self._with(new)

    def by_label(self) -> dict[str, FloatArray]:
        counts = {id(table): own for table, own in zip(self.tables, self.counts, strict=True)}
        return {factor.label: counts[id(factor.table)] for factor in self.source.factors if id(factor.table) in counts}

    def _expected_logs(self) -> None:
        """exp E[log θ] under Dirichlet(prior + counts)."""
        from scipy.special import digamma  # slow to import

        posteriors = [table.prior + counts for table, counts in zip(self.tables, self.counts, strict=True)]
        self.values = [np.exp(digamma(each) - digamma(each.sum(axis=0))) for each in posteriors]

    def _with(self, new: Mapping[int, tuple[ConditionalTable, FloatArray]]) -> FactorGraph:
        tied = [(factor, new[id(factor.table)]) for factor in self.source.factors if id(factor.table) in new]
        return self.source.replaced(replace(factor, table=table, values=values) for factor, (table, values) in tied)


@dataclass(frozen=True, slots=True)
class _Rows:
    """Data, equal rows together."""

    names: Sequence[str]  # the variables with data
    indices: IntArray  # `[rows, names]` indices of labels; -1 where missing
    weights: FloatArray  # `[rows]` how often each row was seen
    first: IntArray  # `[rows]` the first row of the data that is this one

    @classmethod
    def of(cls, graph: FactorGraph, data: Data) -> _Rows:
        columns, count = _columns(graph, data)
        if count == 0 or any(len(column) != count for column in columns.values()):
            raise CogmapError("fit: the data have no rows, or variables have different numbers of them")
        known = {*graph.evidence, *graph.likelihoods}
        if twice := [name for name in columns if name in known]:
            raise CogmapError(f"fit: {twice[0]!r} has data, and evidence in the graph; take one of them away")
        by_name = [_indices(graph, name, column) for name, column in columns.items()]
        indices = np.stack(by_name, axis=1) if by_name else np.zeros((count, 0), dtype=np.int64)
        unique, first, counts = np.unique(indices, axis=0, return_index=True, return_counts=True)
        return cls(list(columns), unique, counts.astype(float), first)

    def expected(
        self, graph: FactorGraph, tables: Sequence[ConditionalTable], memory: float
    ) -> tuple[float, list[FloatArray]]:
        """Log-likelihood of all rows, and the expected counts of each table."""
        total, counts = 0.0, [np.zeros(table.counts.shape) for table in tables]
        step = self._at_once(graph, memory)
        for begin in range(0, len(self.weights), step):
            part = slice(begin, begin + step)
            total += self._of_part(graph, part, tables, counts, memory)
        return total, counts

    def _at_once(self, graph: FactorGraph, memory: float) -> int:
        """Rows whose products and messages take about `CHUNK` bytes."""
        with_rows, row = self._joined(graph, self.indices[:2])
        problem = reduce(with_rows, given(with_rows))
        plan = plan_elimination(problem, keep=problem.nodes([row]), memory=memory)
        return int(min(max(min(CHUNK, memory) / (8.0 * plan.entries / 2.0 + 1.0), 2), len(self.weights)))

    def _of_part(
        self,
        graph: FactorGraph,
        part: slice,
        tables: Sequence[ConditionalTable],
        counts: list[FloatArray],
        memory: float,
    ) -> float:
        weights, indices = self.weights[part], self.indices[part]
        with_rows, row = self._joined(graph, indices)
        try:
            problem = reduce(with_rows, given(with_rows))
            keep = problem.nodes([row])
            plan = plan_elimination(problem, keep=keep, memory=memory)
            done = forward(buckets(problem, plan, keep=keep), problem.tables, keep=1)
        except ImpossibleEvidence:
            raise self._impossible(part.start) from None
        message = done.messages[-1]
        logs = message.log_values()[: len(weights)] + message.offset + done.log_scale
        if not np.isfinite(logs).all():
            raise self._impossible(part.start + int(np.flatnonzero(~np.isfinite(logs))[0]))
        over = [*done.over[:-1], np.pad(weights, (0, problem.cards[keep[0]] - len(weights)))]
        tree = tree_of(replace(done, over=over), memory, root=True)
        places = {id(table): at for at, table in enumerate(tables)}
        for factor in graph.factors:
            if (at := places.get(id(factor.table))) is not None:
                counts[at] += tree.joint([variable.name for variable in factor.scope])
        return float(weights @ logs)

    def _joined(self, graph: FactorGraph, indices: IntArray) -> tuple[FactorGraph, str]:
        """The graph with a variable for the row, two labels at least, and what each row says."""
        joined, row = graph.copy(), "row"
        while row in joined.wiring.number:
            row += "'"
        count = max(len(indices), 2)
        joined.variable(row, range(count))
        for name, column in zip(self.names, indices.T, strict=True):
            card = joined.variable_named(name).cardinality
            seen = np.ones((card, count))
            seen[:, : len(column)] = np.where(column < 0, True, np.arange(card)[:, None] == column)
            joined.factor("data", [name, row], seen)
        return joined, row

    def _impossible(self, at: int) -> CogmapError:
        return CogmapError(
            f"fit: row {int(self.first[at])} of the data (counted from 0) has probability 0; check it, and the zeros "
            "of the values to start from"
        )


def _columns(graph: FactorGraph, data: Data) -> tuple[Mapping[str, Sequence[Hashable]], int]:
    """Labels by variable, and the number of rows."""
    if isinstance(data, Mapping) or hasattr(data, "columns"):
        columns = {graph.variable_named(name).name: list(column) for name, column in cast(Any, data).items()}
        return columns, max(map(len, columns.values()), default=0)
    rows = list(data)
    if not all(isinstance(row, Mapping) for row in cast(list[object], rows)):
        raise CogmapError("fit: give a mapping of variables to labels, or a list of rows that are mappings")
    named = [{graph.variable_named(name).name: label for name, label in row.items()} for row in rows]
    names = dict.fromkeys(name for row in named for name in row)
    return {name: [row.get(name) for row in named] for name in names}, len(rows)


def _indices(graph: FactorGraph, name: str, column: Sequence[Hashable]) -> IntArray:
    variable = graph.variable_named(name)
    result = np.full(len(column), -1, dtype=np.int64)
    for at, label in enumerate(column):
        if label in variable.domain:
            result[at] = variable.index(label)
        elif not (label is None or label != label):  # NaN alone differs from itself
            raise CogmapError(f"fit: row {at} of the data (counted from 0): {name!r} has no label {label!r}")
    return result


def _normalised(counts: FloatArray, otherwise: FloatArray) -> FloatArray:
    """Columns that sum to 1; where a column has no counts, that of `otherwise`."""
    sums = counts.sum(axis=0)
    return np.where(sums > 0, counts / np.where(sums > 0, sums, 1.0), otherwise)


def _divergence(one: FloatArray, other: FloatArray) -> float:
    """KL[Dirichlet(one) || Dirichlet(other)], summed over the columns."""
    from scipy.special import digamma, gammaln  # slow to import

    totals = one.sum(axis=0), other.sum(axis=0)
    columns = gammaln(totals[0]) - gammaln(totals[1]) - (gammaln(one) - gammaln(other)).sum(axis=0)
    columns = columns + ((one - other) * (digamma(one) - digamma(totals[0]))).sum(axis=0)
    return math.fsum(np.ravel(columns))
