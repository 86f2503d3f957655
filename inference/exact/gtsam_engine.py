"""The gtsam engine. The only module that speaks to gtsam, which crashes on bad input: all is checked before.

gtsam eliminates (sum-product to a Bayes net, max-product to a lookup table); its conditionals are read back and
turned into beliefs by `bucket_tree`, as its own marginals and joints cost one more elimination each. gtsam drops
the normaliser; it is recovered at one assignment x with P(x) > 0: log Z = Σ_f log f(x) - log P(x).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...model import CogmapError, FloatArray
from . import elimination as numpy_engine
from .bucket_tree import BucketTree, tree_of
from .ordering import Elimination, elimination
from .problem import Problem

if TYPE_CHECKING:
    import gtsam

LARGEST_CLUSTER = 1e6


def solve(problem: Problem, order: Sequence[str] | None) -> BucketTree:
    """Sum-product along the order. gtsam keys are the indices of the problem's variables.

    Raises:
        ImpossibleEvidence: Z = 0.
        CogmapError: gtsam is not installed, a cluster above `LARGEST_CLUSTER`, or a bad `order`.
    """
    plan, factors = _prepared(problem, order)
    if not plan:
        return BucketTree(problem, problem.log_scale, (), [], (), {})
    net = _guarded(problem, factors.eliminateSequential, plan)
    conditionals = [net.at(at) for at in range(net.size())]
    place = {i: at for at, (i, _) in enumerate(plan)}
    scopes, products = zip(*(_read(problem, conditional, place) for conditional in conditionals), strict=True)
    messages = [product.sum(axis=0) for product in products]
    log_evidence = problem.log_scale + _log_normaliser(problem, net, conditionals)
    return tree_of(problem, log_evidence, scopes, products, messages)


def maximise(problem: Problem, order: Sequence[str] | None) -> list[int]:
    """Most probable index of each variable left, by max-product. Errors as for `solve`."""
    plan, factors = _prepared(problem, order)
    if not plan:
        return []
    best = _guarded(problem, factors.maxProduct, plan).argmax()
    return [int(best[i]) for i in range(len(problem.names))]


def _prepared(problem: Problem, order: Sequence[str] | None) -> tuple[Elimination, gtsam.DiscreteFactorGraph]:
    """The order and the gtsam factors; a variable no table holds gets a table of ones."""
    try:
        import gtsam
    except ImportError as error:
        raise CogmapError(f"engine 'gtsam' cannot be loaded ({error}); install it or use 'numpy'") from error
    plan = elimination(problem, order, limit=LARGEST_CLUSTER)
    factors = gtsam.DiscreteFactorGraph()
    held: set[int] = set()
    for scope, values in problem.tables:
        held.update(scope)
        axes = sorted(range(len(scope)), key=scope.__getitem__)
        _add(factors, problem, [scope[axis] for axis in axes], values.transpose(axes))
    for i in set(range(len(problem.names))) - held:
        _add(factors, problem, [i], np.ones(problem.cards[i]))
    return plan, factors


def _add(factors: gtsam.DiscreteFactorGraph, problem: Problem, keys: list[int], values: FloatArray) -> None:
    """Add a table, keys ascending, after checking what gtsam would cut, misread or crash on."""
    cards = [problem.cards[i] for i in keys]
    if values.size > LARGEST_CLUSTER:
        raise CogmapError(
            f"engine 'gtsam': a table has {values.size:.3g} entries, above {LARGEST_CLUSTER:.3g}; use 'numpy'"
        )
    if list(values.shape) != cards or min(cards) < 2 or not (values.min() >= 0 and values.max() < math.inf):
        raise CogmapError(f"engine 'gtsam': table {values.shape} does not fit cardinalities {cards}")
    # the scale is free, as log Z is recovered from the tables themselves; 1 keeps products from underflowing
    scaled = np.ascontiguousarray(values / (values.max() or 1.0)).ravel()
    factors.add(list(zip(keys, cards, strict=True)), scaled)  # pyright: ignore[reportArgumentType, reportCallIssue]


def _guarded(problem: Problem, eliminate: Callable[[Any], Any], plan: Elimination) -> Any:
    """Eliminate along the plan; gtsam says "Product factor is 0" for impossible evidence, and where it underflows."""
    try:
        return eliminate(_ordering(i for i, _ in plan))
    except RuntimeError as error:
        if "Product factor is 0" in str(error):
            numpy_engine.maximise(problem, None)  # raises ImpossibleEvidence where it is, and says where
        raise CogmapError(f"engine 'gtsam': {str(error).splitlines()[0]}; try engine='numpy'") from error


def _ordering(keys: Iterable[int]) -> gtsam.Ordering:
    import gtsam

    ordering = gtsam.Ordering()
    for key in keys:
        ordering.push_back(key)
    return ordering


def _read(problem: Problem, conditional: Any, place: dict[int, int]) -> tuple[tuple[int, ...], FloatArray]:
    """P(x_i | S_i) as an array, its variables in order of elimination."""
    keys: list[int] = list(conditional.keys())
    # gtsam enumerates with the last of its keys fastest
    values = np.array([value for _, value in conditional.enumerate()]).reshape([problem.cards[i] for i in keys])
    scope = sorted(keys, key=place.__getitem__)
    return tuple(scope), values.transpose([keys.index(i) for i in scope])


def _log_normaliser(problem: Problem, net: gtsam.DiscreteBayesNet, conditionals: Sequence[Any]) -> float:
    """log Z of the tables, at the x the conditionals name one after the other, from the last to the first."""
    import gtsam

    x: Any = gtsam.DiscreteValues()
    for conditional in reversed(conditionals):
        x[conditional.firstFrontalKey()] = conditional.argmax(x)
    logs = [math.log(values[tuple([x[i] for i in scope])]) for scope, values in problem.tables]
    return math.fsum(logs) - net.logProbability(x)
