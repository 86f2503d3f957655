"""The backward pass: from P(x_i | S_i) of every bucket to its belief P(x_i, S_i), and what is read off beliefs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..model.factors import FloatArray
from .buckets import LARGEST_CLUSTER, Buckets
from .ordering import elimination
from .problem import Problem

Scopes = Sequence[tuple[int, ...]]


@dataclass(frozen=True, slots=True)
class BucketTree:
    """A calibrated tree of buckets, one a variable, in order of elimination.

    Attributes:
        problem: the reduced problem.
        log_evidence: log Z.
        scopes: for each bucket its variables, the eliminated one first, then its separator by order.
        beliefs: P(scope | evidence) for each bucket, one axis a variable.
        place: bucket of each variable.
    """

    problem: Problem
    log_evidence: float
    scopes: Scopes
    beliefs: Sequence[FloatArray]
    place: Mapping[int, int]

    def joint(self, names: Sequence[str]) -> FloatArray:
        """P(names | evidence), one axis a name; eliminates the rest afresh where no bucket holds them all."""
        wanted = self.problem.carriers(names)
        if not wanted:
            return self.problem.expand(names, wanted, np.ones(()))
        # the first of them to leave: its bucket holds them all, or none does
        at = min([self.place[i] for i in wanted])
        if set(wanted) <= set(self.scopes[at]):
            joint = _marginal(self.beliefs[at], self.scopes[at], wanted)
        else:
            joint = _by_elimination(self.problem, wanted)
        return self.problem.expand(names, wanted, joint)

    def entropy(self) -> float:
        """H = Σ_i H(x_i, S_i) - H(S_i), in nats."""
        return sum(_entropy(belief) - _entropy(belief.sum(axis=0)) for belief in self.beliefs)


def calibrated(
    problem: Problem,
    log_evidence: float,
    scopes: Scopes,
    products: Sequence[FloatArray],
    messages: Sequence[FloatArray],
) -> BucketTree:
    """P(x_i, S_i) = P(S_i) product_i / message_i, from the last bucket to the first; 0 / 0 = 0.

    Args:
        problem: the reduced problem.
        log_evidence: log Z.
        scopes: of the buckets, in order of elimination.
        products: proportional to P(x_i | S_i), axes as in the scope.
        messages: the products summed over x_i.
    """
    place = {scope[0]: at for at, scope in enumerate(scopes)}
    beliefs = list(products)
    for at in reversed(range(len(scopes))):
        scope, message = scopes[at], messages[at]
        above = np.ones(())
        if len(scope) > 1:
            parent = place[scope[1]]
            above = _marginal(beliefs[parent], scopes[parent], scope[1:])
        ratio = np.divide(above, message, out=np.zeros(message.shape), where=message > 0)
        beliefs[at] = products[at] * ratio
    return BucketTree(problem, log_evidence, scopes, beliefs, place)


def _by_elimination(problem: Problem, wanted: Sequence[int]) -> FloatArray:
    """The joint over `wanted`, all other variables eliminated first."""
    plan = elimination(problem, None, keep=wanted, limit=LARGEST_CLUSTER)
    buckets = Buckets(problem, plan, keep=wanted)
    for position in range(len(plan)):
        buckets.send(position, buckets.product(position).sum(axis=0))
    rest = [table for waiting in buckets.waiting[len(plan) :] for table in waiting]
    product = buckets.product_over(wanted, rest)
    return product / product.sum()


def _marginal(belief: FloatArray, scope: Sequence[int], wanted: Sequence[int]) -> FloatArray:
    """Sum a belief over `scope` down to the axes `wanted`, in that order."""
    if len(scope) == len(wanted):
        summed, left = belief, list(scope)
    else:
        summed = belief.sum(axis=tuple([axis for axis, i in enumerate(scope) if i not in wanted]))
        left = [i for i in scope if i in wanted]
    return summed if left == list(wanted) else summed.transpose([left.index(i) for i in wanted])


def _entropy(belief: FloatArray) -> float:
    positive = belief[belief > 0]
    return -float(positive @ np.log(positive))
