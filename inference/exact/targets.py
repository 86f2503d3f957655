"""A few targets without the rest: what cannot tell anything about them is left out."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from ...model import Factor, FactorGraph, FloatArray, IntArray
from ..evidence import Given
from . import elimination
from .bucket_tree import BucketTree
from .elimination import Order
from .problem import reduce
from .solution import Solution


@dataclass(frozen=True, slots=True)
class TargetSolution(Solution):
    """The posterior of some variables."""

    graph: FactorGraph  # the graph
    given: Given  # what is known
    memory: float  # bytes that a query may take
    tree: BucketTree  # of what is left of the graph
    instead: ClassVar[str] = "ask without `targets`"

    @property
    def log_evidence(self) -> float:  # pyright: ignore[reportIncompatibleVariableOverride]
        """log Z, by a query of its own."""
        wiring, factors = self.graph.wiring, _needed(self.graph, self.given, ())
        barren = {wiring.scopes[at][0] for at in set(range(len(wiring.scopes))).difference(factors)}
        left = set(range(len(wiring.variables))).difference(barren)
        problem = reduce(self.graph, self.given, factors=factors, keep=left)
        return elimination.solve(problem, None, self.memory).log_evidence

    def joint(self, names: Sequence[str]) -> FloatArray:
        return self.tree.joint(names)

    def entries(self, factor: Factor) -> tuple[IntArray, FloatArray] | None:
        return self.tree.entries(factor)


def solve(graph: FactorGraph, given: Given, targets: Sequence[str], order: Order, memory: float) -> TargetSolution:
    """The posterior of the targets from the factors that matter to them.

    Left out are barren variables (see `Wiring.needed`), and parts that the evidence cuts off, if the evidence is
    certainly possible there. Errors as for `elimination.solve`.
    """
    numbers = [graph.wiring.number[name] for name in targets]
    factors = _connected(graph, given, _needed(graph, given, numbers), numbers)
    problem = reduce(graph, given, factors=factors, keep=numbers)
    return TargetSolution(graph, given, memory, elimination.solve(problem, order, memory))


def _needed(graph: FactorGraph, given: Given, targets: Sequence[int]) -> list[int]:
    number = graph.wiring.number
    return graph.wiring.needed({*targets, *given.soft, *(number[name] for name in given.labels)})


def _connected(graph: FactorGraph, given: Given, factors: Sequence[int], targets: Sequence[int]) -> list[int]:
    """Those of the factors that variables without a fixed label connect with the targets, and those with zeros."""
    wiring, fixed = graph.wiring, given.fixed
    left, reached = set(factors), set[int]()
    seen = set(targets)
    waiting = list(targets)
    while waiting:
        i = waiting.pop()
        if i in fixed:
            continue
        for at in wiring.touching[i]:
            if at in left:
                left.discard(at)
                reached.add(at)
                for j in wiring.scopes[at]:
                    if j not in seen:
                        seen.add(j)
                        waiting.append(j)
    if all(wiring.factors[at].positive for at in left):
        left = set[int]()
    return sorted(reached | left)
