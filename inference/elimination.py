"""The numpy engine: exact sum-product and max-product by bucket elimination, two passes for all marginals.

Eliminating x_i multiplies the tables that hold it and sums it out; the message over its separator S_i goes to
the bucket of the next variable to leave. Each message is scaled to maximum 1 and the log of its scale is
carried along, so nothing underflows however long the chain. Backwards, P(x_i, S_i) = P(x_i | S_i) P(S_i).
Entries below 1e-300 of the largest of their table count as zero.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce

import numpy as np

from ..model.factors import FloatArray
from .errors import impossible
from .ordering import Elimination, elimination
from .problem import Problem
from .substitution import Table

LARGEST_CLUSTER = 5e7
_UNDERFLOW = 1e-150


@dataclass(frozen=True, slots=True)
class EliminationSolution:
    """A calibrated bucket tree.

    Attributes:
        problem: the reduced problem.
        log_evidence: log Z.
        scopes: for each bucket, in order of elimination, the variables (the eliminated one first).
        beliefs: P(scope | evidence) for each bucket, one axis a variable.
    """

    problem: Problem
    log_evidence: float
    scopes: tuple[tuple[int, ...], ...]
    beliefs: tuple[FloatArray, ...]

    def joint(self, names: Sequence[str]) -> FloatArray:
        """P(names | evidence), one axis a name; eliminates the rest afresh where no bucket holds them all."""
        wanted = self.problem.carriers(names)
        joint = self._within_bucket(wanted) if wanted else np.ones(())
        if joint is None:
            joint = _by_elimination(self.problem, wanted)
        return self.problem.expand(names, wanted, joint)

    def entropy(self) -> float:
        """H = Σ_i H(x_i, S_i) - H(S_i), in nats."""
        return sum(_entropy(belief) - _entropy(belief.sum(axis=0)) for belief in self.beliefs)

    def _within_bucket(self, wanted: Sequence[int]) -> FloatArray | None:
        for scope, belief in zip(self.scopes, self.beliefs, strict=True):
            if scope[0] in wanted:  # the first of them to leave: its bucket holds all, or none does
                if not set(wanted) <= set(scope):
                    return None
                return _marginal(belief, scope, wanted)
        return None


def solve(problem: Problem, order: Sequence[str] | None) -> EliminationSolution:
    """Both passes of sum-product.

    Raises:
        ImpossibleEvidence: Z = 0.
        CogmapError: a cluster above `LARGEST_CLUSTER`, or a bad `order`.
    """
    plan = elimination(problem, order, limit=LARGEST_CLUSTER)
    scopes, products, messages, log_evidence = _upward(problem, plan)
    return EliminationSolution(problem, log_evidence, scopes, _downward(scopes, products, messages))


def maximise(problem: Problem, order: Sequence[str] | None) -> list[int]:
    """Most probable index of each variable left: max-product, then traced back; ties go to the lowest index."""
    plan = elimination(problem, order, limit=LARGEST_CLUSTER)
    buckets = _Buckets(problem, plan)
    best: list[FloatArray] = []
    for position in range(len(plan)):
        product = buckets.product(position)
        best.append(product.argmax(axis=0))
        buckets.send(position, product.max(axis=0))
    values = [0] * len(problem.names)
    for scope, argmax in zip(reversed(buckets.scopes), reversed(best), strict=True):
        values[scope[0]] = int(argmax[tuple(values[i] for i in scope[1:])])
    return values


class _Buckets:
    """The tables and messages waiting at each variable, axes sorted by order of elimination."""

    def __init__(self, problem: Problem, plan: Elimination, keep: Sequence[int] = ()) -> None:
        self.problem = problem
        self.log_scale = problem.log_scale
        self.place = {i: at for at, i in enumerate([*(i for i, _ in plan), *keep])}
        key = self.place.__getitem__
        self.scopes = tuple((i, *sorted(around, key=key)) for i, around in plan)
        self.waiting: list[list[Table]] = [[] for _ in self.place]
        for scope, values in problem.tables:
            ranks = [self.place[i] for i in scope]
            if ranks != sorted(ranks):
                axes = sorted(range(len(ranks)), key=ranks.__getitem__)
                scope, values = tuple(scope[axis] for axis in axes), values.transpose(axes)
            self.waiting[self.place[scope[0]]].append((scope, values))

    def product(self, position: int) -> FloatArray:
        """All that waits at a bucket, multiplied over the bucket's scope."""
        return self.product_over(self.scopes[position], self.waiting[position])

    def product_over(self, scope: Sequence[int], tables: Sequence[Table]) -> FloatArray:
        """Product of tables, broadcast over `scope`; rescaled step by step where it would underflow."""
        cards = self.problem.cards
        if not tables:
            return np.ones([cards[i] for i in scope])
        aligned = [t.reshape([cards[i] if i in own else 1 for i in scope]) for own, t in tables]
        product = reduce(np.multiply, aligned)
        if len(aligned) > 1 and product.max(initial=0.0) < _UNDERFLOW:
            product = aligned[0]
            for table in aligned[1:]:
                product = self._scaled(product * table, scope)
        if product.ndim and product.size < math.prod(cards[i] for i in scope):
            product = np.broadcast_to(product, [cards[i] for i in scope])
        return product

    def send(self, position: int, message: FloatArray) -> None:
        """Scale the message over the separator and hand it on."""
        scope = self.scopes[position]
        message = self._scaled(message, scope)
        if len(scope) > 1:
            self.waiting[self.place[scope[1]]].append((scope[1:], message))

    def _scaled(self, values: FloatArray, scope: Sequence[int]) -> FloatArray:
        largest = float(values.max())
        if not largest > 0:
            raise impossible(self.problem, (self.problem.names[i] for i in scope))
        self.log_scale += math.log(largest)
        return values / largest


def _upward(
    problem: Problem, plan: Elimination
) -> tuple[tuple[tuple[int, ...], ...], list[FloatArray], list[FloatArray], float]:
    buckets = _Buckets(problem, plan)
    products: list[FloatArray] = []
    messages: list[FloatArray] = []
    for position in range(len(plan)):
        product = buckets.product(position)
        message = product.sum(axis=0)
        buckets.send(position, message)
        products.append(product)
        messages.append(message)
    return buckets.scopes, products, messages, buckets.log_scale


def _downward(
    scopes: Sequence[tuple[int, ...]], products: list[FloatArray], messages: Sequence[FloatArray]
) -> tuple[FloatArray, ...]:
    """P(x_i, S_i) = (product / message) * P(S_i), from the last bucket to the first; 0 / 0 = 0."""
    place = {scope[0]: at for at, scope in enumerate(scopes)}
    beliefs: list[FloatArray] = list(products)
    for at in reversed(range(len(scopes))):
        scope, message = scopes[at], messages[at]
        above = np.ones(())
        if len(scope) > 1:
            parent = place[scope[1]]
            above = _marginal(beliefs[parent], scopes[parent], scope[1:])
        ratio = np.divide(above, message, out=np.zeros_like(message), where=message > 0)
        beliefs[at] = products[at] * ratio
    return tuple(beliefs)


def _by_elimination(problem: Problem, wanted: Sequence[int]) -> FloatArray:
    """The joint over `wanted`, all other variables eliminated first."""
    plan = elimination(problem, None, keep=wanted, limit=LARGEST_CLUSTER)
    buckets = _Buckets(problem, plan, keep=wanted)
    for position in range(len(plan)):
        buckets.send(position, buckets.product(position).sum(axis=0))
    rest = [table for waiting in buckets.waiting[len(plan) :] for table in waiting]
    product = buckets.product_over(wanted, rest)
    return product / product.sum()


def _marginal(belief: FloatArray, scope: Sequence[int], wanted: Sequence[int]) -> FloatArray:
    """Sum a belief over `scope` down to the axes `wanted`, in that order."""
    away = tuple(axis for axis, i in enumerate(scope) if i not in wanted)
    left = [i for i in scope if i in wanted]
    summed = belief.sum(axis=away) if away else belief
    return summed if left == list(wanted) else summed.transpose([left.index(i) for i in wanted])


def _entropy(belief: FloatArray) -> float:
    positive = belief[belief > 0]
    return -float(positive @ np.log(positive))
