"""The gtsam engine. The only module that speaks to gtsam, which crashes on bad input: all is checked before.

gtsam drops the normaliser. It is recovered at one assignment x with P(x) > 0, here the one that the
conditionals name one after the other: log Z = Σ_f log f(x) - log P(x).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ..model.errors import CogmapError
from ..model.factors import FloatArray
from .errors import impossible
from .ordering import Elimination, elimination
from .posterior import expected_log
from .problem import Problem

if TYPE_CHECKING:
    import gtsam

LARGEST_CLUSTER = 1e6


@dataclass(frozen=True, slots=True)
class GtsamSolution:
    """An eliminated graph; its gtsam keys are the indices of the problem's variables.

    Attributes:
        problem: the reduced problem.
        log_evidence: log Z.
        plan: order of elimination, with separators.
        factors: the gtsam factor graph.
        tree: the gtsam Bayes tree.
    """

    problem: Problem
    log_evidence: float
    plan: Elimination
    factors: gtsam.DiscreteFactorGraph = field(repr=False)
    tree: gtsam.DiscreteBayesTree = field(repr=False)

    def joint(self, names: Sequence[str]) -> FloatArray:
        """P(names | evidence), one axis a name."""
        wanted = self.problem.carriers(names)
        if not wanted:
            joint = np.ones(())
        elif len(wanted) == 1:
            joint = _marginal(self.tree, wanted[0])
        elif len(wanted) == 2 and self._adjacent(*wanted):
            net = self.tree.jointBayesNet(*wanted)
            joint = self._table(net.at(0) * net.at(1), wanted)
        else:
            joint = self._by_elimination(wanted)
        return self.problem.expand(names, wanted, joint)

    def entropy(self) -> float:
        """H = log Z - Σ_f E[log f], in nats."""
        expected = self.problem.log_scale
        for scope, values in self.problem.tables:
            joint = self.joint([self.problem.names[i] for i in scope])
            expected += expected_log(joint, values)
        return self.log_evidence - expected

    def _adjacent(self, a: int, b: int) -> bool:
        return any((i == a and b in around) or (i == b and a in around) for i, around in self.plan)

    def _by_elimination(self, wanted: Sequence[int]) -> FloatArray:
        """The joint of variables that share no clique: the rest eliminated, what is left multiplied."""
        plan = elimination(self.problem, None, keep=wanted, limit=LARGEST_CLUSTER)
        _check_size(math.prod(self.problem.cards[i] for i in wanted), "the joint asked for")
        left = self.factors
        if plan:
            left = left.eliminatePartialSequential(_ordering(i for i, _ in plan))[1]
        return self._table(left.product(), wanted)  # pyright: ignore[reportArgumentType]

    def _table(self, factor: gtsam.DecisionTreeFactor, wanted: Sequence[int]) -> FloatArray:
        """Values of a factor over exactly `wanted`, normalised, axes in that order."""
        keys: list[int] = sorted(factor.keys())
        flat = np.zeros([self.problem.cards[i] for i in keys])
        for assignment, value in factor.enumerate():
            flat[tuple(assignment[i] for i in keys)] = value
        return flat.transpose([keys.index(i) for i in wanted]) / flat.sum()

    def __reduce__(self) -> tuple[Any, ...]:
        """gtsam objects do not pickle: solve again on arrival."""
        return solve, (self.problem, [self.problem.names[i] for i, _ in self.plan])


def solve(problem: Problem, order: Sequence[str] | None) -> GtsamSolution:
    """Sum-product along the order: a Bayes net for log Z, a Bayes tree for the marginals.

    Raises:
        ImpossibleEvidence: Z = 0.
        CogmapError: gtsam is not installed, a cluster above `LARGEST_CLUSTER`, or a bad `order`.
    """
    plan, factors, ordering = _prepared(problem, order)
    tree = _guarded(problem, factors.eliminateMultifrontal, ordering)
    log_evidence = problem.log_scale
    if plan:
        net = _guarded(problem, factors.eliminateSequential, ordering)
        log_evidence += _log_normaliser(problem, net)
    return GtsamSolution(problem, log_evidence, plan, factors, tree)


def maximise(problem: Problem, order: Sequence[str] | None) -> list[int]:
    """Most probable index of each variable left, by max-product."""
    plan, factors, ordering = _prepared(problem, order)
    if not plan:
        return []
    best = _guarded(problem, factors.maxProduct, ordering).argmax()
    return [int(best[i]) for i in range(len(problem.names))]


def _prepared(problem: Problem, order: Sequence[str] | None) -> tuple[Elimination, Any, Any]:
    """Order, gtsam factors and gtsam ordering; a variable no table holds gets one of ones."""
    try:
        import gtsam
    except ImportError as error:
        raise CogmapError(f"engine 'gtsam' cannot be loaded ({error}); install it or use engine='numpy'") from error
    plan = elimination(problem, order, limit=LARGEST_CLUSTER)
    factors = gtsam.DiscreteFactorGraph()
    held: set[int] = set()
    for scope, values in problem.tables:
        held.update(scope)
        axes = sorted(range(len(scope)), key=scope.__getitem__)
        _add(factors, problem, [scope[axis] for axis in axes], values.transpose(axes))
    for i in set(range(len(problem.names))) - held:
        _add(factors, problem, [i], np.ones(problem.cards[i]))
    return plan, factors, _ordering(i for i, _ in plan)


def _add(factors: gtsam.DiscreteFactorGraph, problem: Problem, keys: list[int], values: FloatArray) -> None:
    """Add a table, keys ascending, after checking what gtsam would cut or crash on."""
    cards = [problem.cards[i] for i in keys]
    _check_size(values.size, "a table")
    if list(values.shape) != cards or min(cards) < 2 or not (values.min() >= 0 and values.max() < math.inf):
        raise CogmapError(f"engine 'gtsam': table {values.shape} does not fit cardinalities {cards}")
    factors.add(list(zip(keys, cards, strict=True)), np.ascontiguousarray(values).ravel())  # pyright: ignore


def _check_size(entries: int, what: str) -> None:
    if entries > LARGEST_CLUSTER:
        raise CogmapError(
            f"engine 'gtsam': {what} has {entries:.3g} entries, above {LARGEST_CLUSTER:.3g}; use engine='numpy'"
        )


def _ordering(keys: Iterable[int]) -> gtsam.Ordering:
    import gtsam

    ordering = gtsam.Ordering()
    for key in keys:
        ordering.push_back(key)
    return ordering


def _guarded(problem: Problem, eliminate: Callable[[Any], Any], ordering: Any) -> Any:
    """Eliminate; gtsam says "Product factor is 0" where the evidence is impossible."""
    try:
        return eliminate(ordering)
    except RuntimeError as error:
        if "Product factor is 0" in str(error):
            raise impossible(problem, problem.names) from error
        raise CogmapError(f"engine 'gtsam': {str(error).splitlines()[0]}; try engine='numpy'") from error


def _log_normaliser(problem: Problem, net: gtsam.DiscreteBayesNet) -> float:
    """log Z of the tables: Σ log f(x) - log P(x) at an x built backwards from the conditionals' best values."""
    import gtsam

    x: Any = gtsam.DiscreteValues()
    for at in reversed(range(net.size())):
        conditional = net.at(at)
        x[conditional.firstFrontalKey()] = conditional.argmax(x)
    logs = (math.log(values[tuple(x[i] for i in scope)]) for scope, values in problem.tables)
    return math.fsum(logs) - net.logProbability(x)


def _marginal(tree: gtsam.DiscreteBayesTree, key: int) -> FloatArray:
    import gtsam

    probabilities = np.array(gtsam.DiscreteDistribution(tree.marginalFactor(key)).pmf())
    return probabilities / probabilities.sum()
