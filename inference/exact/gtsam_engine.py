"""The gtsam engine. The only module that speaks to gtsam, which crashes on bad input: all is checked before.

gtsam eliminates (sum-product to a Bayes net, max-product to a lookup table); its conditionals are read back and
turned into beliefs by `bucket_tree`, as its own marginals and joints cost one more elimination each. gtsam drops
the normaliser; it is recovered at one assignment x with P(x) > 0: log Z = Σ_f log f(x) - log P(x).

gtsam multiplies in plain numbers, and what falls below the smallest float is lost without a word. What is lost
misses from Z: the numpy engine, which loses nothing, says what Z must be, and where the two differ no answer is given.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...model import CogmapError, FloatArray
from .bucket_tree import BucketTree
from .buckets import buckets, forward
from .elimination import Order
from .ordering import Elimination, elimination
from .problem import Problem

if TYPE_CHECKING:
    import gtsam

LARGEST_CLUSTER = 1e6
TOLERANCE = 1e-9  # by how much log Z may differ from the one of the numpy engine; 1e-14 of its own size is rounding


def solve(problem: Problem, order: Order, memory: float) -> BucketTree:
    """Sum-product along the order. gtsam keys are the nodes of the problem.

    Raises:
        ImpossibleEvidence: Z = 0.
        CogmapError: gtsam is not installed, the problem is too large for it, a result is not finite or may have
            underflowed, or a bad `order`.
    """
    plan, factors = _prepared(problem, order, memory)
    ours = buckets(problem, plan)
    truth = forward(ours, problem.tables).log_scale
    if not plan.order:
        return BucketTree(ours, {}, problem.tables, truth, [], [], memory)
    net = _guarded(factors.eliminateSequential, plan)
    conditionals = [net.at(at) for at in range(net.size())]
    frontal = {each.firstFrontalKey(): each for each in conditionals}  # branches may come in another order than ours
    over = [_read(problem, frontal[scope[0]], scope) for scope in ours.scopes]
    log_evidence = problem.log_scale + _log_normaliser(problem, net, conditionals)
    _check(log_evidence, truth, all(np.isfinite(each).all() for each in over))
    by = [each.sum(axis=0) for each in over]
    return BucketTree(ours, {}, problem.tables, log_evidence, over, by, memory)


def maximise(problem: Problem, order: Order, memory: float) -> list[int]:
    """Most probable index of each node, by max-product. Errors as for `solve`."""
    plan, factors = _prepared(problem, order, memory)
    truth = forward(buckets(problem, plan), problem.tables, maximum=True).log_scale
    if not plan.order:
        return []
    found = _guarded(factors.maxProduct, plan).argmax()
    best = [int(found[i]) for i in range(len(problem.cards))]
    _check(problem.log_scale + _log_product(problem, best), truth, True)
    return best


def _prepared(problem: Problem, order: Order, memory: float) -> tuple[Elimination, gtsam.DiscreteFactorGraph]:
    """The order and the gtsam factors; a node no table holds gets a table of ones."""
    try:
        import gtsam
    except ImportError as error:
        raise CogmapError(f"engine 'gtsam' cannot be loaded ({error}); install it or use engine='numpy'") from error
    plan = elimination(problem, order, memory=memory, largest=LARGEST_CLUSTER)
    factors = gtsam.DiscreteFactorGraph()
    held: set[int] = set()
    for scope, table in zip(problem.scopes, problem.tables, strict=True):
        held.update(scope)
        axes = sorted(range(len(scope)), key=scope.__getitem__)
        _add(factors, problem, [scope[axis] for axis in axes], table.values.transpose(axes))
    for i in set(range(len(problem.cards))) - held:
        _add(factors, problem, [i], np.ones(problem.cards[i]))
    return plan, factors


def _add(factors: gtsam.DiscreteFactorGraph, problem: Problem, keys: list[int], values: FloatArray) -> None:
    """Add a table, keys ascending, after checking what gtsam would cut, misread or crash on."""
    cards = [problem.cards[i] for i in keys]
    if values.size > LARGEST_CLUSTER:
        raise CogmapError(
            f"engine 'gtsam': a table has {values.size:.3g} entries, above {LARGEST_CLUSTER:.3g}; use engine='numpy'"
        )
    if list(values.shape) != cards or min(cards) < 2 or not (values.min() >= 0 and values.max() < math.inf):
        raise CogmapError(f"engine 'gtsam': table {values.shape} does not fit cardinalities {cards}")
    # the scale is free, as log Z is recovered from the tables themselves; 1 keeps products from underflowing
    scaled = np.ascontiguousarray(values / (values.max() or 1.0)).ravel()
    factors.add(list(zip(keys, cards, strict=True)), scaled)  # pyright: ignore[reportArgumentType, reportCallIssue]


def _guarded(eliminate: Callable[[Any], Any], plan: Elimination) -> Any:
    """Eliminate along the plan; where everything underflows gtsam says "Product factor is 0"."""
    try:
        return eliminate(_ordering(plan.order))
    except RuntimeError as error:
        raise CogmapError(f"engine 'gtsam': {str(error).splitlines()[0]}; try engine='numpy'") from error


def _check(found: float, truth: float, finite: bool) -> None:
    if not finite or not abs(found - truth) <= max(TOLERANCE, 1e-14 * abs(truth)):
        raise CogmapError(
            f"engine 'gtsam': the product underflows (its log is {found!r}, not {truth!r}), as gtsam multiplies in "
            "plain numbers; try engine='numpy', which goes on in logs"
        )


def _ordering(keys: Iterable[int]) -> gtsam.Ordering:
    import gtsam

    ordering = gtsam.Ordering()
    for key in keys:
        ordering.push_back(key)
    return ordering


def _read(problem: Problem, conditional: Any, scope: Sequence[int]) -> FloatArray:
    """P(x_i | S_i) as an array, its nodes in order of elimination."""
    keys: list[int] = list(conditional.keys())
    # gtsam enumerates with the last of its keys fastest
    values = np.array([value for _, value in conditional.enumerate()]).reshape([problem.cards[i] for i in keys])
    return values.transpose([keys.index(i) for i in scope])


def _log_product(problem: Problem, x: Any) -> float:
    values = [
        table.values[tuple([x[i] for i in scope])] for scope, table in zip(problem.scopes, problem.tables, strict=True)
    ]
    return math.fsum(math.log(value) if value > 0 else -math.inf for value in values)


def _log_normaliser(problem: Problem, net: gtsam.DiscreteBayesNet, conditionals: Sequence[Any]) -> float:
    """log Z of the tables, at the x the conditionals name one after the other, from the last to the first."""
    import gtsam

    x: Any = gtsam.DiscreteValues()
    for conditional in reversed(conditionals):
        x[conditional.firstFrontalKey()] = conditional.argmax(x)
    return _log_product(problem, x) - net.logProbability(x)
