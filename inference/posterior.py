"""What inference returns: posteriors and most probable assignments."""

import math
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np

from ..model import CogmapError, Factor, FactorGraph, FloatArray, Variable
from .evidence import Given
from .exact import Solution, entropy

Name = str | Variable
LARGEST_JOINT = 2**28  # entries of the largest joint that is handed out


@dataclass(frozen=True, slots=True)
class Posterior:
    """P(x | evidence) = Π_f f(x_f) / Z. All arrays that it returns are read-only."""

    graph: FactorGraph  # the graph as it was when asked; later additions to the original do not show here
    engine: str  # name of the engine that computed it
    approximation: object | None  # what kind of approximation it is and how good; None where it is exact
    _given: Given = field(repr=False, compare=False)
    _solution: Solution = field(repr=False, compare=False)
    _joints: dict[tuple[str, ...], FloatArray] = field(repr=False, compare=False)

    @property
    def evidence(self) -> Mapping[str, Hashable]:
        """Labels of the observed variables, by name, those of the graph included (read-only)."""
        return MappingProxyType(dict(self._given.labels))

    @property
    def likelihoods(self) -> Mapping[str, tuple[float, ...]]:
        """Soft evidence, by name, one likelihood a label of the domain, that of the graph included (read-only)."""
        return MappingProxyType(dict(self._given.likelihoods))

    @property
    def log_evidence(self) -> float:
        """log Z = log Σ_x Π_f f(x_f), x over all that agrees with the evidence.

        It is log P(evidence) where the factors are conditionals of one directed model.
        """
        return self._solution.log_evidence

    @property
    def exact(self) -> bool:
        """Whether it is exact, up to rounding."""
        return self.approximation is None

    def marginal(self, name: Name) -> FloatArray:
        """P(name | evidence), `[cardinality]`, in the order of the domain; one-hot where observed."""
        return self.joint(name)

    def joint(self, *names: Name) -> FloatArray:
        """P(names | evidence), one axis a name, in the order given; for any set of variables.

        Those within one cluster, and the `pairs` of the query, are at hand; others cost an elimination.

        Raises:
            CogmapError: no variable, one twice, one that is not in the graph, or too many entries together.
        """
        if not names:
            raise CogmapError("joint: name at least one variable")
        key = tuple([self.graph.variable_named(name).name for name in names])
        if (joint := self._joints.get(key)) is None:
            if len(set(key)) < len(key):
                raise CogmapError(f"joint: {', '.join(key)}: a variable is named twice; name each once")
            if (size := math.prod(self.graph.variable_named(name).cardinality for name in key)) > LARGEST_JOINT:
                raise CogmapError(
                    f"joint: {len(key)} variables have {size:.3g} entries together; ask for fewer at once"
                )
            joint = self._solution.joint(key)
            joint.setflags(write=False)
            if len(key) == 1:
                self._joints[key] = joint
        return joint

    def probability(self, name: Name, label: Hashable) -> float:
        """P(name = label | evidence)."""
        return float(self.marginal(name)[self.graph.variable_named(name).index(label)])

    def standard_error(self, *names: Name) -> FloatArray:
        """Standard error of each entry of `joint(*names)`; 0 of an exact posterior.

        Raises:
            CogmapError: the approximation has none.
        """
        return self._solution.standard_error([self.graph.variable_named(name).name for name in names])

    @property
    def entropy(self) -> float:
        """H[P(x | evidence)] over all latent variables, in nats."""
        return self._solution.entropy()

    def entropy_of(self, *names: Name) -> float:
        """H[P(names | evidence)], in nats."""
        return entropy(self.joint(*names))

    def mutual_information(self, one: Name | Sequence[Name], other: Name | Sequence[Name]) -> float:
        """I(one; other | evidence) = H(one) + H(other) - H(one, other) of variables or groups of them, in nats."""
        first, second = _group(one), _group(other)
        shared = self.entropy_of(*first) + self.entropy_of(*second) - self.entropy_of(*first, *second)
        return max(shared, 0.0)

    def sample(self, count: int, *, rng: np.random.Generator | int) -> dict[str, list[Hashable]]:
        """Draws from P(x | evidence): for each variable, by name, `count` labels; the same places belong together.

        Args:
            count: number of draws.
            rng: a generator, or the seed of one.

        Raises:
            CogmapError: a number of draws below 0.
        """
        if count < 0:
            raise CogmapError(f"sample: cannot draw {count} times; give 0 or more")
        drawn = self._solution.sample(count, np.random.default_rng(rng))
        return {
            variable.name: [variable.domain[i] for i in indices]
            for variable, indices in zip(self.graph.variables, drawn.tolist(), strict=True)
        }

    def expected_log(self, factor: Factor | str) -> float:
        """E[log f(x_f)] under the posterior, in nats; 0 log 0 = 0."""
        if isinstance(factor, str):
            factor = self.graph.factor_named(factor)
        if (listed := self._solution.entries(factor)) is not None:
            rows, probabilities = listed
            return expected_log(probabilities, factor.at(list(rows.T)))
        return expected_log(self.joint(*factor.scope), factor.dense())

    def expected_counts(self, table: object) -> FloatArray:
        """Σ of the joints over the factors tied to `table`, `[outcome, *parents]`: expected counts of this posterior.

        They are counts on top of the prior of the table. To learn from data use `fit`, which repeats this until it
        settles; adding them again and again counts the same data again and again.

        Raises:
            CogmapError: no factor is tied to the table.
        """
        tied = [factor for factor in self.graph.factors if factor.table is table]
        if not tied:
            raise CogmapError("expected counts: no factor of the graph is tied to this table")
        return np.sum([self.joint(*factor.scope) for factor in tied], axis=0)

    def __repr__(self) -> str:
        kind = "exact" if self.exact else str(self.approximation)
        return f"Posterior({len(self.graph.variables)} variables, engine={self.engine!r}, {kind})"


@dataclass(frozen=True, slots=True)
class MostProbable:
    """argmax_x Π_f f(x_f) over all that agrees with the evidence."""

    graph: FactorGraph  # the graph asked about
    # log Π_f f(x_f) there (summed over the rest in a marginal query), times the likelihoods of soft evidence,
    # not normalised; minus log Z it is log P(x | evidence)
    log_probability: float
    _labels: dict[str, Hashable] = field(repr=False)

    @property
    def assignment(self) -> Mapping[str, Hashable]:
        """A label for every variable, observed ones included; of a marginal query, for those asked for (read-only)."""
        return MappingProxyType(self._labels)


def expected_log(weights: FloatArray, values: FloatArray) -> float:
    """Σ w log v with 0 log 0 = 0; -inf where a zero has weight."""
    used = weights > 0
    with np.errstate(divide="ignore"):
        return float(weights[used] @ np.log(values[used]))


def _group(names: Name | Sequence[Name]) -> Sequence[Name]:
    return [names] if isinstance(names, str | Variable) else names
