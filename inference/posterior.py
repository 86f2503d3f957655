"""What inference returns: posteriors and most probable assignments."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass, field

import numpy as np

from ..model import CogmapError, Factor, FactorGraph, FloatArray
from .exact import Solution


@dataclass(frozen=True, slots=True)
class Posterior:
    """P(x | evidence) = Π_f f(x_f) / Z, exact.

    Attributes:
        graph: the graph as it was when asked; later additions to the original do not show here.
        evidence: labels of the observed variables, by name, those of the graph included.
        engine: name of the engine that computed it.
        log_evidence: log Z = log Σ_x Π_f f(x_f), x over all that agrees with the evidence. It is log P(evidence)
            where the factors are conditionals of one directed model.
    """

    graph: FactorGraph
    evidence: Mapping[str, Hashable]
    engine: str
    log_evidence: float
    _solution: Solution = field(repr=False, compare=False)
    _joints: Mapping[tuple[str, ...], FloatArray] = field(repr=False, compare=False)

    def marginal(self, name: str) -> FloatArray:
        """P(name | evidence), `[cardinality]`, in the order of the domain; one-hot where observed."""
        return self.joint(name)

    def joint(self, *names: str) -> FloatArray:
        """P(names | evidence), one axis a name, in the order given; for any set of variables.

        Those within one cluster, and the `pairs` of the query, are at hand; others cost an elimination.
        """
        if not names:
            raise CogmapError("joint: name at least one variable")
        if (known := self._joints.get(names)) is not None:
            return known
        for name in names:
            self.graph.variable_named(name)
        return self._solution.joint(names)

    def probability(self, name: str, label: Hashable) -> float:
        """P(name = label | evidence)."""
        return float(self.marginal(name)[self.graph.variable_named(name).index(label)])

    @property
    def entropy(self) -> float:
        """H[P(x | evidence)] over all latent variables, in nats."""
        return self._solution.entropy()

    def expected_log(self, factor: Factor | str) -> float:
        """E[log f(x_f)] under the posterior, in nats; 0 log 0 = 0."""
        if isinstance(factor, str):
            factor = self.graph.factor_named(factor)
        return expected_log(self.joint(*(variable.name for variable in factor.scope)), factor.dense())

    def expected_counts(self, table: object) -> FloatArray:
        """Σ of the joints over the factors tied to `table`: what `table.learn` wants, `[outcome, *parents]`."""
        tied = [factor for factor in self.graph.factors if factor.table is table]
        if not tied:
            raise CogmapError("expected counts: no factor of the graph is tied to this table")
        return np.sum([self.joint(*(v.name for v in factor.scope)) for factor in tied], axis=0)


@dataclass(frozen=True, slots=True)
class MostProbable:
    """argmax_x Π_f f(x_f) over all that agrees with the evidence.

    Attributes:
        graph: the graph asked about.
        assignment: a label for every variable, observed ones included.
        log_probability: log Π_f f(x_f) there, not normalised; minus log Z it is log P(x | evidence).
    """

    graph: FactorGraph
    assignment: Mapping[str, Hashable]
    log_probability: float


def expected_log(weights: FloatArray, values: FloatArray) -> float:
    """Σ w log v with 0 log 0 = 0; -inf where a zero has weight."""
    used = weights > 0
    with np.errstate(divide="ignore"):
        return float(weights[used] @ np.log(values[used]))
