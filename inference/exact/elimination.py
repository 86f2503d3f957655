"""The numpy engine: exact sum-product and max-product by bucket elimination, a second pass for the marginals asked for.

Eliminating x_i multiplies the tables that hold it and sums it out; the message over its separator S_i goes to
the bucket of the next variable to leave. Each message is scaled to maximum 1 and the log of its scale is
carried along, so nothing underflows however long the chain. Backwards, P(x_i, S_i) = P(x_i | S_i) P(S_i).
Entries below 1e-300 of the largest of their table count as zero.
"""

from __future__ import annotations

from collections.abc import Sequence

from ...model import FloatArray, IntArray
from .bucket_tree import BucketTree, tree_of
from .buckets import LARGEST_CLUSTER, Buckets
from .ordering import elimination
from .problem import Problem


def solve(problem: Problem, order: Sequence[str] | None) -> BucketTree:
    """Sum-product: the forward pass; the backward one is for the tree, when it is asked.

    Raises:
        ImpossibleEvidence: Z = 0.
        CogmapError: a cluster above `LARGEST_CLUSTER`, or a bad `order`.
    """
    plan = elimination(problem, order, limit=LARGEST_CLUSTER)
    buckets = Buckets(problem, plan)
    products: list[FloatArray] = []
    messages: list[FloatArray] = []
    for position in range(len(plan)):
        product = buckets.product(position)
        message = product.sum(axis=0)
        buckets.send(position, message)
        products.append(product)
        messages.append(message)
    return tree_of(problem, buckets.log_scale, buckets.scopes, products, messages)


def maximise(problem: Problem, order: Sequence[str] | None) -> list[int]:
    """Most probable index of each variable left: max-product, traced back; ties go to the lowest index.

    Raises:
        ImpossibleEvidence: every product is 0.
        CogmapError: a cluster above `LARGEST_CLUSTER`, or a bad `order`.
    """
    plan = elimination(problem, order, limit=LARGEST_CLUSTER)
    buckets = Buckets(problem, plan)
    best: list[IntArray] = []
    for position in range(len(plan)):
        product = buckets.product(position)
        best.append(product.argmax(axis=0))
        buckets.send(position, product.max(axis=0))
    values = [0] * len(problem.names)
    for scope, argmax in zip(reversed(buckets.scopes), reversed(best), strict=True):
        values[scope[0]] = int(argmax[tuple([values[i] for i in scope[1:]])])
    return values
