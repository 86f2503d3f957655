"""The exact engines: bucket elimination in numpy, gtsam, and enumeration."""

from collections.abc import Hashable, Sequence

from ...model import FactorGraph
from ..evidence import Given
from . import brute, elimination, gtsam_engine, targets
from .bucket_tree import BucketTree, draw, entropy, tree_of
from .buckets import Buckets, Pass, buckets, forward
from .elimination import Order, best_first, marginal_maximum, traced
from .ordering import CHEAP, MEMORY, Elimination, without
from .ordering import elimination as plan_elimination
from .problem import Problem, Where, reduce
from .solution import Solution
from .tables import Table, eliminated, in_logs, product, times

__all__ = [
    "CHEAP", "ENGINES", "MEMORY", "BucketTree", "Buckets", "Elimination", "Order", "Pass", "Problem", "Solution",
    "Table", "Where", "best_first", "buckets", "draw", "eliminated", "entropy", "forward", "in_logs",
    "marginal_maximum", "maximise", "plan_elimination", "product", "reduce", "solve", "times", "traced", "tree_of",
    "without",
]  # fmt: skip

ENGINES = ("numpy", "gtsam", "brute")


def solve(
    graph: FactorGraph, given: Given, engine: str, *, order: Order, memory: float, asked: Sequence[str] | None = None
) -> Solution:
    """Sum-product by the engine of that name, of all variables or of those asked for; see `infer`."""
    if engine == "brute":
        return brute.solve(graph, given)
    if engine == "gtsam":
        return gtsam_engine.solve(reduce(graph, given), order, memory)
    if asked is not None:
        return targets.solve(graph, given, asked, order, memory)
    return elimination.solve(reduce(graph, given), order, memory)


def maximise(graph: FactorGraph, given: Given, engine: str, *, order: Order, memory: float) -> dict[str, Hashable]:
    """The most probable label of every variable, by the engine of that name; see `most_probable`."""
    if engine == "brute":
        assignments, logs = brute.enumerated(graph, given)
        best = assignments[int(logs.argmax())]
        return {variable.name: variable.domain[i] for variable, i in zip(graph.variables, best, strict=True)}
    problem = reduce(graph, given)
    return problem.labels((gtsam_engine if engine == "gtsam" else elimination).maximise(problem, order, memory))
