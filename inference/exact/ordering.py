"""Elimination orders: along time, by minimum weight, by minimum fill, or as told; and what they cost."""

import heapq
import math
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass

from ...model import CogmapError, Variable
from .problem import Problem

MEMORY = 4 * 2**30
"""Bytes of products and messages that a query may take, unless it says otherwise."""
CHEAP, DEAR = 2e4, 1e6
"""Entries in all below which no other order is tried, and after minimum fill no third one."""
CROWDED = 40
"""Neighbours from which on the cost of eliminating a node is not kept up to date, but looked up when its turn comes."""


Neighbours = Sequence[set[int]]
Cost = Callable[[int, Neighbours, Sequence[float]], tuple[float, ...]]


@dataclass(frozen=True, slots=True)
class Elimination:
    """Which node goes when."""

    order: Sequence[int]  # the nodes
    around: Sequence[frozenset[int]]  # the separator of each: the nodes that its message speaks of
    entries: float  # entries of all clusters (a node and its separator) and messages
    filled: int  # pairs of nodes that had no table in common before

    def largest(self, cards: Sequence[int]) -> list[int]:
        """The nodes of the largest cluster."""
        at = max(range(len(self.order)), key=lambda at: _entries(cards, (self.order[at], *self.around[at])))
        return [self.order[at], *sorted(self.around[at])]


def elimination(
    problem: Problem,
    order: Sequence[str | Variable] | None = None,
    *,
    first: Collection[int] | None = None,
    keep: Collection[int] = (),
    known: Collection[int] = (),
    memory: float = MEMORY,
    largest: float = math.inf,
) -> Elimination:
    """The cheapest order found.

    Without `order` these are tried: along time where variables have one, minimum weight, minimum fill, and minimum
    weighted fill; the search ends where nothing is to be gained.

    Args:
        problem: what is to be eliminated.
        order: names in order of elimination; those observed, of one label or substituted are passed over.
        first: nodes that must go before all others.
        keep: nodes not to be eliminated.
        known: nodes that will be sliced out.
        memory: bytes that products and messages may take.
        largest: entries that a cluster may have.

    Raises:
        CogmapError: `order` misses a variable or names one twice, or the cheapest order takes too much memory.
    """
    out = {*keep, *known}
    going = [i for i in range(len(problem.cards)) if i not in out]
    neighbours = _neighbours(problem, known)
    if order is not None:
        plan = _eliminate(problem, neighbours, [[i] for i in _as_told(problem, order) if i not in out], _weight)
    elif first is not None:
        groups = [[i for i in going if i in first], [i for i in going if i not in first]]
        plan = _best(problem, neighbours, [(groups, cost) for cost in (_weight, _fill, _weighted_fill)])
    else:
        tries = [([going], cost) for cost in (_weight, _fill, _weighted_fill)]
        if any(problem.times[i] is not None for i in going):
            tries.insert(0, (_slices(problem, going), _fill))
        plan = _best(problem, neighbours, tries)
    bytes_ = 8.0 * plan.entries
    if plan.order and (bytes_ > memory or _entries(problem.cards, plan.largest(problem.cards)) > largest):
        cluster = plan.largest(problem.cards)
        names = ", ".join(problem.names[i] for i in cluster[:8]) + (", …" if len(cluster) > 8 else "")
        limit = f"memory={memory:.3g}" if bytes_ > memory else f"the {largest:.3g} entries of a cluster it takes"
        other = "or approximate: engine='loopy', 'sampling'" if bytes_ > memory else "or use engine='numpy'"
        raise CogmapError(
            f"inference: needs {bytes_ / 1e9:.3g} GB ({bytes_:.3g} bytes), above {limit}; the largest cluster "
            f"({names}) has {_entries(problem.cards, cluster):.3g} entries. Give more memory=, narrow the domains, "
            f"observe one of them, give another `order`, {other}"
        )
    return plan


def without(plan: Elimination, problem: Problem, known: Collection[int]) -> Elimination:
    """The same order of the nodes that are not known."""
    left = [at for at, i in enumerate(plan.order) if i not in known]
    around = [plan.around[at].difference(known) for at in left]
    order = [plan.order[at] for at in left]
    entries = sum(_entries(problem.cards, rest) * (problem.cards[i] + 1) for i, rest in zip(order, around, strict=True))
    return Elimination(order, around, entries, plan.filled)


def _best(problem: Problem, neighbours: Neighbours, tries: Iterable[tuple[Sequence[list[int]], Cost]]) -> Elimination:
    best: Elimination | None = None
    for groups, cost in tries:
        plan = _eliminate(problem, neighbours, groups, cost, math.inf if best is None else best.entries)
        if best is None or plan.entries < best.entries:
            best = plan
        # without fill-in every cluster is one of a table: there is no better order
        if plan.filled == 0 or best.entries < (DEAR if cost is _fill else CHEAP):
            break
    assert best is not None
    return best


def _as_told(problem: Problem, order: Sequence[str | Variable]) -> list[int]:
    told = [problem.graph.variable_named(item).name for item in order]
    if len(set(told)) < len(told):
        raise CogmapError("inference: `order` names a variable twice; name each once")
    index = {name: i for i, name in enumerate(problem.names)}
    known = {*told, *problem.entries}
    if missing := [name for name in problem.names if name not in known]:
        raise CogmapError(f"inference: `order` misses {missing[0]!r}; it must name every latent variable")
    first = [index[label] for label in problem.entries if label in index]  # the entries of sparse factors have no name
    return [*first, *(index[name] for name in told if name in index)]


def _slices(problem: Problem, going: Iterable[int]) -> list[list[int]]:
    """Nodes of one time step together, steps ascending, those without a time last."""
    groups: dict[float, list[int]] = {}
    for i in going:
        time = problem.times[i]
        groups.setdefault(math.inf if time is None else time, []).append(i)
    return [groups[time] for time in sorted(groups)]


def _weight(i: int, neighbours: Neighbours, cards: Sequence[float]) -> tuple[float, ...]:
    """Entries of the cluster."""
    return (cards[i] * math.prod([cards[j] for j in neighbours[i]]),)


def _fill(i: int, neighbours: Neighbours, cards: Sequence[float]) -> tuple[float, ...]:
    """Pairs of neighbours that have no table in common yet; then the weight."""
    around = neighbours[i]
    present = sum([len(neighbours[j] & around) for j in around])
    return (len(around) * (len(around) - 1) - present, *_weight(i, neighbours, cards))


def _weighted_fill(i: int, neighbours: Neighbours, cards: Sequence[float]) -> tuple[float, ...]:
    """These pairs, each counted by the entries it has; then the weight."""
    around = neighbours[i]
    cost = 0.0
    for j in around:
        missing = around - neighbours[j]
        if len(missing) > 1:  # j itself is missing
            cost += cards[j] * (sum([cards[k] for k in missing]) - cards[j])
    return (cost, *_weight(i, neighbours, cards))


def _eliminate(
    problem: Problem, neighbours: Neighbours, groups: Sequence[list[int]], cost: Cost, most: float = math.inf
) -> Elimination:
    """Group after group, within a group the cheapest node first; given up where it takes more entries than `most`."""
    cards = [float(card) for card in problem.cards]
    neighbours = [set(around) for around in neighbours]
    order: list[int] = []
    separators: list[frozenset[int]] = []
    entries, filled = 0.0, 0
    for group in groups:
        queue = _Queue(group, lambda i: cost(i, neighbours, cards))
        while (i := queue.pop()) is not None:
            around = neighbours[i]
            order.append(i)
            separators.append(frozenset(around))
            entries += math.prod([cards[j] for j in around]) * (cards[i] + 1)
            if entries > most:
                return Elimination(order, separators, math.inf, 1)
            missing = {j: around - neighbours[j] for j in around}  # j itself among them
            for j, new in missing.items():
                neighbours[j] |= new
                neighbours[j] -= {i, j}
            filled += sum(map(len, missing.values())) - len(missing)
            if cost is not _weight:  # a pair that has met counts no longer for those who know both
                for j, new in missing.items():
                    around = around.union(*[neighbours[j] & neighbours[k] for k in new if k < j])
            queue.changed(around, neighbours)
    return Elimination(order, separators, entries, filled)


class _Queue:
    """Nodes by cost. The cost of one with many neighbours is looked up when its turn comes, not at each change."""

    def __init__(self, nodes: Sequence[int], cost: Callable[[int], tuple[float, ...]]) -> None:
        self.cost = cost
        self.costs: dict[int, tuple[float, ...]] = {i: cost(i) if len(nodes) > 1 else (0.0,) for i in nodes}
        self.heap = [(value, i) for i, value in self.costs.items()]
        heapq.heapify(self.heap)
        self.stale: set[int] = set()

    def pop(self) -> int | None:
        """The cheapest node; None where none is left."""
        while self.heap:
            value, i = heapq.heappop(self.heap)
            if self.costs.get(i) != value:
                continue
            if i in self.stale:
                self.stale.discard(i)
                self.costs[i] = self.cost(i)
                heapq.heappush(self.heap, (self.costs[i], i))
                continue
            del self.costs[i]
            return i
        return None

    def changed(self, nodes: Iterable[int], neighbours: Neighbours) -> None:
        """The neighbours of these have changed."""
        for i in nodes:
            if i in self.costs:
                if len(neighbours[i]) > CROWDED:
                    self.stale.add(i)
                elif (value := self.cost(i)) != self.costs[i]:
                    self.costs[i] = value
                    heapq.heappush(self.heap, (value, i))


def _neighbours(problem: Problem, known: Collection[int]) -> list[set[int]]:
    """The nodes that each node has a table in common with, those that are known left out."""
    neighbours: list[set[int]] = [set() for _ in problem.cards]
    for scope in problem.scopes:
        if len(scope) > 1:
            for i in scope:
                neighbours[i].update(scope)
    for i, around in enumerate(neighbours):
        around.discard(i)
        around.difference_update(known)
    return neighbours


def _entries(cards: Sequence[int], nodes: Iterable[int]) -> float:
    return math.prod([float(cards[i]) for i in nodes])
