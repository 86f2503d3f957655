"""A graph compiled once and asked many times: evidence changes, the tree stays."""

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..model import AllEvidence, CogmapError, FactorGraph, FloatArray, log_bounds
from .errors import impossible
from .evidence import Given, given
from .exact import (
    CHEAP,
    MEMORY,
    Buckets,
    Elimination,
    Order,
    Pass,
    Problem,
    Table,
    buckets,
    forward,
    plan_elimination,
    reduce,
    times,
    traced,
    tree_of,
    without,
)
from .posterior import MostProbable, Name, Posterior
from .query import checked_pairs, checked_targets, log_product

MOST_TREES = 16  # sets of observed variables whose trees are kept


@dataclass(slots=True)
class _Tree:
    """Buckets for one set of observed nodes, and the last pass over them."""

    problem: Problem
    buckets: Buckets
    last: Pass | None = None


class CompiledGraph:
    """A graph with a fixed order of elimination; see `compile_graph`. It ignores later additions to the graph."""

    def __init__(self, graph: FactorGraph, observed: Sequence[Name], order: Order, memory: float) -> None:
        self.graph = graph.copy()
        self.memory = memory
        self._observed = checked_targets(graph, observed) if observed else []
        self._problem = reduce(self.graph, Given({}, {}, dict.fromkeys(graph.wiring.single, 0), {}))
        known = set(self._problem.nodes(self._observed)) if self._observed else set[int]()
        self._plan = plan_elimination(self._problem, order, known=known, memory=memory)
        self._trees: dict[tuple[frozenset[int], frozenset[int]], _Tree] = {}

    @property
    def bytes(self) -> float:
        """What products and messages take, without evidence."""
        return 8.0 * self._plan.entries

    def infer(self, evidence: AllEvidence | None = None, *, pairs: Iterable[Sequence[Name]] = ()) -> Posterior:
        """The posterior, as `infer` of the graph gives it.

        Args:
            evidence: on top of that of the graph.
            pairs: sets of variables whose joints are wanted at once.

        Raises:
            ImpossibleEvidence: no assignment has a product above zero.
            CogmapError: an unknown variable or label, or no evidence for a variable that was to be observed.
        """
        known = given(self.graph, evidence)
        tree, nodes, tables, log_scale = self._entered(known)
        done = forward(tree.buckets, tables, given=nodes, before=tree.last)
        tree.last = done
        solution = tree_of(replace(done, log_scale=done.log_scale + log_scale), self.memory)
        posterior = Posterior(self.graph, "numpy", None, known, solution, {})
        joints = {names: posterior.joint(*names) for names in checked_pairs(self.graph, pairs)}
        return replace(posterior, _joints=joints) if joints else posterior

    def most_probable(self, evidence: AllEvidence | None = None) -> MostProbable:
        """The most probable assignment, as `most_probable` of the graph gives it; errors as for `infer`."""
        known = given(self.graph, evidence)
        tree, nodes, tables, _ = self._entered(known)
        labels = tree.problem.labels(traced(forward(tree.buckets, tables, given=nodes, maximum=True)))
        return MostProbable(self.graph, log_product(self.graph, labels, known), labels)

    def _entered(self, known: Given) -> tuple[_Tree, Mapping[int, int], Sequence[Table], float]:
        """The tree for what is known, the nodes known with their index, the tables, and a number to add to log Z."""
        for name in self._observed:
            if name not in known.labels:
                raise CogmapError(f"evidence: the graph was compiled with {name!r} observed; give its label")
        nodes, soft, log_scale = self._on_nodes(known)
        key = frozenset(nodes), frozenset(soft)
        if (tree := self._trees.pop(key, None)) is None:
            problem = self._problem
            if soft:
                scopes = [*problem.scopes, *((node,) for node in soft)]
                problem = replace(problem, scopes=scopes, tables=[*problem.tables, *soft.values()])
            tree = _Tree(problem, buckets(problem, self._order(nodes), known=nodes))
            while len(self._trees) >= MOST_TREES:
                del self._trees[next(iter(self._trees))]
        self._trees[key] = tree
        own = len(self._problem.scopes)
        tables = [*self._problem.tables, *(soft[scope[0]] for scope in tree.problem.scopes[own:])]
        return tree, nodes, tables, log_scale

    def _order(self, nodes: Collection[int]) -> Elimination:
        """The order without the nodes that are known; a new one where that would cost much and is cheaper."""
        left = without(self._plan, self._problem, nodes)
        if left.entries < CHEAP:
            return left
        fresh = plan_elimination(self._problem, known=nodes, memory=math.inf)
        return min(left, fresh, key=lambda plan: plan.entries)

    def _on_nodes(self, known: Given) -> tuple[dict[int, int], dict[int, Table], float]:
        """Evidence about variables as evidence about the nodes that carry them: an index, or likelihoods."""
        soft: dict[int, Table] = {}
        log_scale = 0.0
        for i, likelihoods in self._likelihoods(known):
            node, mapping = self._problem.where[i]
            on_node = likelihoods if mapping is None else likelihoods[mapping]
            if node is None:
                log_scale += math.log(on_node) if on_node > 0 else -math.inf
            else:
                table = Table(on_node, *log_bounds(on_node))
                soft[node] = times(soft[node], table) if node in soft else table
        nodes: dict[int, int] = {}
        for node, table in list(soft.items()):
            possible = np.flatnonzero(table.values > (-math.inf if table.logs else 0.0))
            if len(possible) == 1:
                nodes[node] = int(possible[0])
                log_scale += float(table.log_values()[possible[0]]) + table.offset
                del soft[node]
            elif not len(possible):
                log_scale = -math.inf
        if log_scale == -math.inf:
            raise impossible(self.graph, known.labels, known.labels)
        return nodes, soft, log_scale

    def _likelihoods(self, known: Given) -> Iterable[tuple[int, FloatArray]]:
        variables = self.graph.wiring.variables
        for i, index in known.fixed.items():
            if len(variables[i].domain) > 1:
                values = np.zeros(len(variables[i].domain))
                values[index] = 1.0
                yield i, values
        yield from known.soft.items()


def compile_graph(
    graph: FactorGraph, *, observed: Iterable[Name] = (), order: Order = None, memory: float = MEMORY
) -> CompiledGraph:
    """Find the order of elimination of a graph once, for many queries with changing evidence.

    Evidence makes every cluster smaller, the order stays; of the tables only those are multiplied again that hang on
    evidence which has changed.

    Args:
        graph: the graph.
        observed: variables that every query will give evidence for; where the graph is too large without.
        order: order of elimination, all latent variables; by default the cheapest of several.
        memory: bytes that products and messages may take.

    Raises:
        CogmapError: an unknown variable, a bad `order`, or not enough memory.
    """
    return CompiledGraph(graph, list(observed), order, memory)
