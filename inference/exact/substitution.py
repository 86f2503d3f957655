"""Variables that another one determines are replaced by it: a ladder of (s, p) becomes a chain of s."""

from collections.abc import Sequence

import numpy as np

from ...model import FloatArray, IntArray

Scope = tuple[int, ...]
Parents = dict[int, tuple[int, IntArray]]


def substitute(
    scopes: Sequence[Scope], tables: Sequence[FloatArray], cards: Sequence[int]
) -> tuple[Parents, list[Scope], list[FloatArray]]:
    """Replace v by f(u) in all tables, where a table over (u, v) allows one v at most for each u.

    Done only where it is free: every rewritten table must fit the scope of a table that stays as it is
    (or a single variable), so no cluster of an elimination grows by it. Exact, zeros included.

    Args:
        scopes: variables of each table.
        tables: values of each table, one axis a variable.
        cards: number of labels of each variable.

    Returns:
        For each replaced v the pair (u, f), u itself not replaced, `f[label of u] = label of v`; and the
        tables without the replaced variables.
    """
    parents = _determined(scopes, tables)
    if parents:
        parents = _free_of_charge(parents, scopes, len(cards))
    if not parents:
        return parents, list(scopes), list(tables)
    rewritten = [_rewritten(scope, values, parents, cards) for scope, values in zip(scopes, tables, strict=True)]
    return parents, [scope for scope, _ in rewritten], [values for _, values in rewritten]


def _determined(scopes: Sequence[Scope], tables: Sequence[FloatArray]) -> Parents:
    """Chains of one-hot tables followed to their root; the variable declared first is preferred as root."""
    parents: Parents = {}
    for scope, values in zip(scopes, tables, strict=True):
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


def _free_of_charge(parents: Parents, scopes: Sequence[Scope], count: int) -> Parents:
    """Drop replacements until every rewritten table fits the scope of an untouched one."""
    parents = dict(parents)
    while True:
        roots = [parents[i][0] if i in parents else i for i in range(count)]
        untouched: list[list[frozenset[int]]] = [[] for _ in range(count)]
        for scope in scopes:
            if not any(i in parents for i in scope):
                members = frozenset(scope)
                for i in scope:
                    untouched[i].append(members)
        costly = {i for scope in scopes if not _fits(scope, roots, untouched) for i in scope if i in parents}
        if not costly:
            return parents
        parents = {child: parent for child, parent in parents.items() if child not in costly}


def _fits(scope: Sequence[int], roots: Sequence[int], untouched: Sequence[Sequence[frozenset[int]]]) -> bool:
    members = {roots[i] for i in scope}
    if len(members) == 1 or members == set(scope):
        return True
    return any(members <= other for other in untouched[next(iter(members))])


def _rewritten(scope: Scope, values: FloatArray, parents: Parents, cards: Sequence[int]) -> tuple[Scope, FloatArray]:
    """values[..., v, ...] -> values[..., f(u), ...], with one axis for each root that occurs."""
    if not any(i in parents for i in scope):
        return scope, values
    own = [parents[i][0] if i in parents else i for i in scope]
    roots = tuple(dict.fromkeys(own))
    index = tuple(
        (parents[i][1] if i in parents else np.arange(cards[i])).reshape([-1 if each == root else 1 for each in roots])
        for i, root in zip(scope, own, strict=True)
    )
    return roots, values[index]
