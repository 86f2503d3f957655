"""The tables and messages of an elimination, waiting at the variable that will multiply them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import reduce

import numpy as np

from ...model import FloatArray
from ..errors import impossible
from .ordering import Elimination
from .problem import Problem
from .substitution import Table

LARGEST_CLUSTER = 5e7
_TINY, _HUGE = 1e-150, 1e150


class Buckets:
    """One bucket a variable of the plan, axes of all tables sorted by order of elimination.

    Args:
        problem: the tables.
        plan: order of elimination, with separators.
        keep: variables not eliminated, placed after all others.
    """

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
        """Product of tables, broadcast over `scope`; rescaled step by step where it would under- or overflow."""
        cards = self.problem.cards
        shape = tuple([cards[i] for i in scope])
        if not tables:
            return np.ones(shape)
        aligned = [t.reshape([cards[i] if i in own else 1 for i in scope]) for own, t in tables]
        with np.errstate(over="ignore"):
            product = reduce(np.multiply, aligned)
        if not _TINY < product.max() < _HUGE:
            product = reduce(lambda one, other: self._scaled(one * other, scope), aligned, np.ones(()))
        return product if product.shape == shape else np.broadcast_to(product, shape)

    def send(self, position: int, message: FloatArray) -> None:
        """Scale the message over the separator to maximum 1 and hand it on."""
        scope = self.scopes[position]
        message = self._scaled(message, scope)
        if len(scope) > 1:
            self.waiting[self.place[scope[1]]].append((scope[1:], message))

    def _scaled(self, values: FloatArray, scope: Sequence[int]) -> FloatArray:
        largest = float(values.max())
        if not largest > 0:
            names = (self.problem.names[i] for i in scope)
            raise impossible(self.problem.graph, self.problem.given, names)
        self.log_scale += math.log(largest)
        return values / largest
