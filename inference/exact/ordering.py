"""Elimination orders: along time, by minimum fill, or as told; and what they cost."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Sequence
from itertools import combinations

from ...model import CogmapError
from .problem import Problem

Elimination = list[tuple[int, frozenset[int]]]


def elimination(
    problem: Problem, order: Sequence[str] | None, *, keep: Collection[int] = (), limit: float
) -> Elimination:
    """Which variable goes when, and its separator: the variables its message speaks of.

    Without `order`: along time where variables have one (within a step, and for those without a time at
    the end, by minimum fill), else by minimum fill; by minimum fill too where time is too costly.

    Args:
        problem: what is to be eliminated.
        order: names in order of elimination; those observed, of one label or substituted are passed over.
        keep: variables not to be eliminated.
        limit: entries a cluster (the variable and its separator) may have.

    Raises:
        CogmapError: `order` misses a variable or names one twice, or a cluster is above the limit.
    """
    going = [i for i in range(len(problem.names)) if i not in keep]
    if order is not None:
        plan = _eliminate(problem, [[i] for i in _as_told(problem, order) if i not in keep])
    else:
        plan = _eliminate(problem, _slices(problem, going))
        if keep or _too_large(problem, plan, limit):
            plan = min(plan, _eliminate(problem, [going]), key=lambda each: _total(problem, each))
    if cluster := _too_large(problem, plan, limit):
        names = ", ".join(problem.names[i] for i in cluster)
        raise CogmapError(
            f"inference: the cluster ({names}) would have {_entries(problem, cluster):.3g} entries, above the limit of "
            f"{limit:.3g}; narrow the domains, observe one of them, give another `order`, or use engine='numpy'"
        )
    return plan


def _as_told(problem: Problem, order: Sequence[str]) -> list[int]:
    for name in order:
        problem.graph.variable_named(name)
    if len(set(order)) < len(order):
        raise CogmapError("inference: `order` names a variable twice; name each once")
    index = {name: i for i, name in enumerate(problem.names)}
    told = [index[name] for name in order if name in index]
    if missing := [name for name in problem.names if name not in set(order)]:
        raise CogmapError(f"inference: `order` misses {missing[0]!r}; it must name every latent variable")
    return told


def _slices(problem: Problem, going: Iterable[int]) -> list[list[int]]:
    """Variables of one time step together, steps ascending, those without a time last."""
    groups: dict[float, list[int]] = {}
    for i in going:
        time = problem.times[i]
        groups.setdefault(math.inf if time is None else time, []).append(i)
    return [groups[time] for time in sorted(groups)]


def _eliminate(problem: Problem, groups: Sequence[list[int]]) -> Elimination:
    """Group after group, within a group the variable with the least fill-in first."""
    neighbours: list[set[int]] = [set() for _ in problem.names]
    for scope, _ in problem.tables:
        for i in scope:
            neighbours[i].update(scope)
    for i, around in enumerate(neighbours):
        around.discard(i)
    plan: Elimination = []
    for group in groups:
        waiting = list(group)
        costs: dict[int, tuple[int, float]] = {}
        while waiting:
            i = waiting[0] if len(waiting) == 1 else _cheapest(problem, waiting, neighbours, costs)
            waiting.remove(i)
            around = neighbours[i]
            plan.append((i, frozenset(around)))
            for j in around:
                neighbours[j] |= around
                neighbours[j] -= {i, j}
                costs.pop(j, None)
                for k in neighbours[j]:
                    costs.pop(k, None)
    return plan


def _cheapest(
    problem: Problem, waiting: Sequence[int], neighbours: Sequence[set[int]], costs: dict[int, tuple[int, float]]
) -> int:
    for i in waiting:
        if i not in costs:
            around = neighbours[i]
            fill = sum(b not in neighbours[a] for a, b in combinations(around, 2)) if len(around) > 1 else 0
            costs[i] = (fill, _entries(problem, [i, *around]))
    return min(waiting, key=costs.__getitem__)


def _too_large(problem: Problem, plan: Elimination, limit: float) -> list[int] | None:
    """The largest cluster, where it is above the limit."""
    worst = max(plan, key=lambda step: _entries(problem, (step[0], *step[1])), default=None)
    if worst is None or _entries(problem, (worst[0], *worst[1])) <= limit:
        return None
    return [worst[0], *sorted(worst[1])]


def _total(problem: Problem, plan: Elimination) -> float:
    return sum(_entries(problem, (i, *around)) for i, around in plan)


def _entries(problem: Problem, variables: Iterable[int]) -> float:
    return math.prod([float(problem.cards[i]) for i in variables])
