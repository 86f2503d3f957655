"""The numpy engine: exact sum-product and max-product by bucket elimination, in logs where plain numbers fall short."""

import heapq
from collections.abc import Collection, Iterator, Sequence

import numpy as np

from ...model import Variable
from .bucket_tree import BucketTree, tree_of
from .buckets import Pass, buckets, forward
from .ordering import elimination
from .problem import Problem

Order = Sequence[str | Variable] | None


def solve(problem: Problem, order: Order, memory: float) -> BucketTree:
    """Sum-product: the forward pass; the backward one is for the tree, when it is asked.

    Raises:
        ImpossibleEvidence: Z = 0.
        CogmapError: too much memory, or a bad `order`.
    """
    plan = elimination(problem, order, memory=memory)
    return tree_of(forward(buckets(problem, plan), problem.tables), memory)


def maximise(problem: Problem, order: Order, memory: float) -> list[int]:
    """Most probable index of each node: max-product, traced back; ties go to the lowest index. Errors as `solve`."""
    plan = elimination(problem, order, memory=memory)
    return traced(forward(buckets(problem, plan), problem.tables, maximum=True))


def traced(done: Pass) -> list[int]:
    """Index of each node that attains the maximum."""
    values = [0] * len(done.buckets.problem.cards)
    for node, index in done.given.items():
        values[node] = index
    for scope, over in zip(reversed(done.buckets.scopes), reversed(done.over), strict=True):
        values[scope[0]] = int(over[(slice(None), *[values[i] for i in scope[1:]])].argmax())
    return values


def best_first(done: Pass) -> Iterator[tuple[list[int], float]]:
    """Assignments of the nodes by falling product, each with log(product / largest product).

    Best-first search from the last bucket to the first. over / by of a maximising pass is how much of the best product
    below remains, so every bound is exact, and each assignment costs one way through the buckets.
    """
    buckets_, cards = done.buckets, done.buckets.problem.cards
    start = [0] * len(cards)
    for node, index in done.given.items():
        start[node] = index
    queue: list[tuple[float, int, int, list[int]]] = [(0.0, 0, len(buckets_.scopes), start)]
    tickets = 0
    while queue:
        lost, _, left, values = heapq.heappop(queue)
        for at in range(left - 1, -1, -1):
            scope = buckets_.scopes[at]
            where = tuple([values[i] for i in scope[1:]])
            column = done.over[at][(slice(None), *where)]
            with np.errstate(divide="ignore"):
                losses = -np.log(column / done.by[at][where])
            best = int(column.argmax())
            for index in np.flatnonzero(np.isfinite(losses)).tolist():
                if index != best:
                    tickets += 1
                    other = [*values]
                    other[scope[0]] = index
                    heapq.heappush(queue, (lost + float(losses[index]), tickets, at, other))
            values[scope[0]] = best
        yield list(values), -lost


def marginal_maximum(problem: Problem, wanted: Collection[int], memory: float) -> tuple[list[int], float]:
    """Index of the nodes `wanted` that maximises the sum over all others, and log of that sum.

    Raises:
        ImpossibleEvidence: Z = 0.
        CogmapError: too much memory; the others must be summed out first, which can cost much.
    """
    others = [i for i in range(len(problem.cards)) if i not in wanted]
    plan = elimination(problem, first=others, memory=memory)
    done = forward(buckets(problem, plan), problem.tables, maximum=set(wanted))
    return traced(done), done.log_scale
