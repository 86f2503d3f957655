"""The backward pass: from P(x_i | S_i) of every bucket to its belief P(x_i, S_i), and what is read off beliefs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ...model import FloatArray
from .buckets import LARGEST_CLUSTER, Buckets
from .ordering import elimination
from .problem import Problem

Scopes = Sequence[tuple[int, ...]]


@dataclass(frozen=True, slots=True)
class BucketTree:
    """A tree of buckets, one a variable, in order of elimination; each is calibrated when it is asked for.

    Attributes:
        problem: the reduced problem.
        log_evidence: log Z.
        scopes: for each bucket its variables, the eliminated one first, then its separator by order.
        tables: for each bucket, one axis a variable: proportional to P(x_i | S_i), and once it is calibrated
            P(x_i, S_i | evidence) in its place.
        messages: P(x_i | S_i) as it was in `tables`, summed over x_i.
        place: bucket of each variable.
    """

    problem: Problem
    log_evidence: float
    scopes: Scopes
    tables: list[FloatArray]
    messages: Sequence[FloatArray]
    place: Mapping[int, int]
    _calibrated: set[int] = field(default_factory=set[int], repr=False, compare=False)

    def joint(self, names: Sequence[str]) -> FloatArray:
        """P(names | evidence), one axis a name; eliminates the rest afresh where no bucket holds them all."""
        wanted = self.problem.carriers(names)
        if not wanted:
            return self.problem.expand(names, wanted, np.ones(()))
        # the first of them to leave: its bucket holds them all, or none does
        at = min([self.place[i] for i in wanted])
        if set(wanted) <= set(self.scopes[at]):
            joint = _marginal(self.belief(at), self.scopes[at], wanted)
        else:
            joint = _by_elimination(self.problem, wanted)
        return self.problem.expand(names, wanted, joint)

    def belief(self, at: int) -> FloatArray:
        """P(x_i, S_i) = P(S_i) product_i / message_i, from the last bucket on the way down to this one; 0 / 0 = 0."""
        way = [at]
        while way[-1] not in self._calibrated and len(self.scopes[way[-1]]) > 1:
            way.append(self.place[self.scopes[way[-1]][1]])
        for here in reversed(way):
            if here not in self._calibrated:
                self._calibrate(here)
        return self.tables[at]

    def _calibrate(self, at: int) -> None:
        """Multiply by P(S_i) / message_i; the bucket that S_i is part of is calibrated already."""
        scope, message = self.scopes[at], self.messages[at]
        above = np.ones(())
        if len(scope) > 1:
            parent = self.place[scope[1]]
            above = _marginal(self.tables[parent], self.scopes[parent], scope[1:])
        ratio = np.divide(above, message, out=np.zeros(message.shape), where=message > 0)
        self.tables[at] = self.tables[at] * ratio
        self._calibrated.add(at)

    def entropy(self) -> float:
        """H = Σ_i H(x_i, S_i) - H(S_i), in nats."""
        beliefs = [self.belief(at) for at in range(len(self.scopes))]
        return sum(_entropy(belief) - _entropy(belief.sum(axis=0)) for belief in beliefs)


def tree_of(
    problem: Problem,
    log_evidence: float,
    scopes: Scopes,
    products: Sequence[FloatArray],
    messages: Sequence[FloatArray],
) -> BucketTree:
    """The tree of these buckets, in order of elimination; `products` are what its `tables` begin with."""
    place = {scope[0]: at for at, scope in enumerate(scopes)}
    return BucketTree(problem, log_evidence, scopes, list(products), messages, place)


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
