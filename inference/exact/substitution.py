"""Variables that another one determines are replaced by it: a ladder of (s, p) becomes a chain of s."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ...model import FloatArray, IntArray

Table = tuple[tuple[int, ...], FloatArray]
Parents = dict[int, tuple[int, IntArray]]


def substitute(tables: Sequence[Table], count: int) -> tuple[Parents, list[Table]]:
    """Replace v by f(u) in all tables, where a table over (u, v) allows one v at most for each u.

    Done only where it is free: every rewritten table must fit the scope of a table that stays as it is
    (or a single variable), so no cluster of an elimination grows by it. Exact, zeros included.

    Args:
        tables: (variables, values) pairs.
        count: number of variables.

    Returns:
        For each replaced v the pair (u, f), u itself not replaced, `f[label of u] = label of v`; and the
        tables without the replaced variables.
    """
    parents = _determined(tables)
    if not parents:
        return parents, list(tables)
    parents = _free_of_charge(parents, tables, count)
    return parents, [_rewritten(table, parents) for table in tables]


def _determined(tables: Sequence[Table]) -> Parents:
    """Chains of one-hot tables followed to their root; the variable declared first is preferred as root."""
    parents: Parents = {}
    for scope, values in tables:
        if len(scope) != 2:
            continue
        many = np.count_nonzero(values)  # tells most tables without a look at each of their rows
        for axis in (0, 1) if scope[0] > scope[1] else (1, 0):
            child, parent = scope[axis], scope[1 - axis]
            if child in parents or many > values.shape[1 - axis] or np.count_nonzero(values, axis=axis).max() > 1:
                continue
            own = values.argmax(axis=axis)
            if parent in parents:
                parent, onto = parents[parent]
                own = own[onto]
            if parent == child:
                continue
            for other, (root, onto) in parents.items():
                if root == child:
                    parents[other] = (parent, onto[own])
            parents[child] = (parent, own)
            break
    return parents


def _free_of_charge(parents: Parents, tables: Sequence[Table], count: int) -> Parents:
    """Drop replacements until every rewritten table fits the scope of an untouched one."""
    parents = dict(parents)
    while True:
        roots = [parents[i][0] if i in parents else i for i in range(count)]
        untouched: list[list[frozenset[int]]] = [[] for _ in range(count)]
        for scope, _ in tables:
            if not any(i in parents for i in scope):
                members = frozenset(scope)
                for i in scope:
                    untouched[i].append(members)
        costly = {i for scope, _ in tables if not _fits(scope, roots, untouched) for i in scope if i in parents}
        if not costly:
            return parents
        parents = {child: parent for child, parent in parents.items() if child not in costly}


def _fits(scope: Sequence[int], roots: Sequence[int], untouched: Sequence[Sequence[frozenset[int]]]) -> bool:
    members = {roots[i] for i in scope}
    if len(members) == 1 or members == set(scope):
        return True
    return any(members <= other for other in untouched[next(iter(members))])


def _rewritten(table: Table, parents: Mapping[int, tuple[int, IntArray]]) -> Table:
    """values[..., v, ...] -> values[..., f(u), ...], with one axis for each root that occurs."""
    scope, values = table
    if not any(i in parents for i in scope):
        return table
    cards: dict[int, int] = {}
    for axis, i in enumerate(scope):
        root, length = (parents[i][0], len(parents[i][1])) if i in parents else (i, values.shape[axis])
        cards[root] = length
    roots = tuple(cards)
    index = tuple(
        (parents[i][1] if i in parents else np.arange(cards[i])).reshape(
            [-1 if root == (parents[i][0] if i in parents else i) else 1 for root in roots]
        )
        for i in scope
    )
    return roots, values[index]
