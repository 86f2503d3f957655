"""A graph and its evidence, reduced to what an engine has to sum over."""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...model import FactorGraph, FloatArray, IntArray
from ..errors import impossible
from ..evidence import fixed_indices
from .substitution import Table, substitute

Where = tuple[int | None, IntArray | int | None]


@dataclass(frozen=True, slots=True)
class Problem:
    """Tables over the variables that are left once everything known is taken out.

    Observed variables and those of one label are sliced away. A variable that another one determines
    (a one-hot table between the two) is replaced by it where that costs nothing, see `substitution`.

    Attributes:
        graph: the graph asked about.
        given: the evidence, labels by name.
        names: name of each variable left; tables speak of them by index.
        cards: number of labels of each, all at least 2.
        times: time step of each.
        tables: pairs (indices of the variables, values with one axis each).
        log_scale: log of the product of all factors over known variables only.
        where: for each variable of the graph: (index of the variable left that carries it or None,
            map from that one's labels to its own, or the fixed index, or None where they are the same).
    """

    graph: FactorGraph
    given: Mapping[str, Hashable]
    names: tuple[str, ...]
    cards: tuple[int, ...]
    times: tuple[int | None, ...]
    tables: tuple[Table, ...]
    log_scale: float
    where: Mapping[str, Where]

    def carriers(self, names: Sequence[str]) -> tuple[int, ...]:
        """The variables left that carry `names`, each once, in order of appearance."""
        found = (self.where[name][0] for name in names)
        return tuple(dict.fromkeys(index for index in found if index is not None))

    def expand(self, names: Sequence[str], carriers: Sequence[int], joint: FloatArray) -> FloatArray:
        """The joint over `names`, from the joint over their carriers (axes in that order)."""
        if len(carriers) == len(names) and all(self.where[name][1] is None for name in names):
            return joint
        shape = tuple(self.graph.variable_named(name).cardinality for name in names)
        flat: IntArray = np.zeros((1,) * len(carriers), dtype=np.int64)
        for name, card in zip(names, shape, strict=True):
            flat = flat * card + self._own_index(name, carriers)
        size = math.prod(shape)
        return np.asarray(np.bincount(flat.ravel(), weights=joint.ravel(), minlength=size), dtype=np.float64).reshape(
            shape
        )

    def labels(self, indices: Sequence[int]) -> dict[str, Hashable]:
        """The assignment of every variable of the graph, from an index for each variable left."""
        result: dict[str, Hashable] = {}
        for variable in self.graph.variables:
            carrier, mapping = self.where[variable.name]
            own = mapping if carrier is None else indices[carrier]
            if isinstance(mapping, np.ndarray):
                own = int(mapping[own])
            assert isinstance(own, int)
            result[variable.name] = variable.domain[own]
        return result

    def _own_index(self, name: str, carriers: Sequence[int]) -> IntArray:
        """Index of `name`, broadcastable over the axes of its carriers."""
        carrier, mapping = self.where[name]
        if carrier is None:
            return np.full((1,) * len(carriers), mapping)
        own = np.arange(self.cards[carrier]) if mapping is None else np.asarray(mapping)
        return own.reshape([-1 if each == carrier else 1 for each in carriers])


def reduce(graph: FactorGraph, given: Mapping[str, Hashable]) -> Problem:
    """Slice the evidence out of every factor, then substitute determined variables.

    Raises:
        ImpossibleEvidence: a factor over known variables only is zero.
    """
    fixed = fixed_indices(graph, given)
    free = [variable for variable in graph.variables if variable.name not in fixed]
    index = {variable.name: i for i, variable in enumerate(free)}
    tables, log_scale, blame = _sliced(graph, fixed, index)
    parents, tables = substitute(tables, len(free))
    left = [i for i in range(len(free)) if i not in parents]
    new = {old: i for i, old in enumerate(left)}
    where: dict[str, Where] = {name: (None, at) for name, at in fixed.items()}
    for name, old in index.items():
        root, mapping = parents.get(old, (old, None))
        where[name] = (new[root], mapping)
    problem = Problem(
        graph=graph,
        given=given,
        names=tuple(free[i].name for i in left),
        cards=tuple(free[i].cardinality for i in left),
        times=tuple(free[i].time for i in left),
        tables=tuple((tuple(new[i] for i in scope), values) for scope, values in tables),
        log_scale=log_scale,
        where=where,
    )
    if blame:
        raise impossible(graph, given, blame)
    return problem


def _sliced(
    graph: FactorGraph, fixed: Mapping[str, int], index: Mapping[str, int]
) -> tuple[list[Table], float, list[str]]:
    """Every factor at the fixed indices: tables of free variables, log of the plain numbers, names of a zero."""
    tables: list[Table] = []
    number, blame = 0.0, list[str]()
    for factor in graph.factors:
        names = [variable.name for variable in factor.scope]
        values = factor.dense()
        scope = tuple([index[name] for name in names if name in index])
        if len(scope) < len(names):
            values = values[tuple([fixed.get(name, slice(None)) for name in names])]
        if scope:
            tables.append((scope, values))
        else:
            number += math.log(values) if values > 0 else -math.inf
            blame = blame or (names if number == -math.inf else [])
    return tables, number, blame
