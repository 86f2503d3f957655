"""A graph and its evidence, reduced to what an engine has to sum over."""

import math
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...model import CogmapError, Factor, FactorGraph, FloatArray, IntArray, SparseValues, Variable, log_bounds
from ..errors import impossible
from ..evidence import Given
from .substitution import Scope, substitute
from .tables import Table

DENSE = 2**16  # entries up to which a sparse factor is written out

Where = tuple[int | None, IntArray | int | None]


@dataclass(frozen=True, slots=True)
class Problem:
    """Tables over the nodes that are left once everything known is taken out.

    Nodes are variables, and the entries of large sparse factors. Observed variables and those of one label are sliced
    away. A variable that another node determines (a one-hot table between the two) is replaced by it where that costs
    nothing, see `substitution`; so a sparse factor is a node, its entries, that determines every variable in its scope.
    """

    graph: FactorGraph  # the graph asked about
    given: Given  # what is known
    names: Sequence[str]  # name of each node, for people; tables speak of nodes by number
    cards: Sequence[int]  # number of labels of each, all at least 2
    times: Sequence[int | None]  # time step of each
    scopes: Sequence[Scope]  # the nodes of each table
    tables: Sequence[Table]  # the tables, one axis a node
    log_scale: float  # log of the product of all factors over known variables only
    # for each variable of the graph, by number: (node that carries it or None, map from that one's labels to
    # its own, or the fixed index, or None where they are the same)
    where: Mapping[int, Where]
    # where the number of the entry of a large sparse factor is, and the entries `[k, n]`, by its label
    entries: Mapping[str, tuple[Where, IntArray]]

    def located(self, names: Sequence[str]) -> list[Where]:
        """Where the variables are."""
        numbers = self.graph.wiring.number
        try:
            return [self.where[numbers[name]] for name in names]
        except KeyError as error:
            where = self.graph.wiring.variables[error.args[0]].name
            raise CogmapError(
                f"posterior: {where!r} is not among the targets asked for; add it to `targets`, or ask without targets"
            ) from None

    def expand(self, names: Sequence[str], joint_over: Mapping[tuple[int, ...], FloatArray]) -> FloatArray:
        """The joint over `names`, from the joint over the nodes that carry them (one item, axes in that order)."""
        ((nodes, joint),) = joint_over.items()
        places = self.located(names)
        if len(nodes) == len(names) and all(mapping is None for _, mapping in places):
            return joint
        shape = tuple([self.graph.variable_named(name).cardinality for name in names])
        flat: IntArray = np.zeros((1,) * len(nodes), dtype=np.int64)
        for place, card in zip(places, shape, strict=True):
            flat = flat * card + self._own_index(place, nodes)
        flat = np.broadcast_to(flat, joint.shape)
        size = math.prod(shape)
        counted = np.bincount(flat.ravel(), weights=joint.ravel(), minlength=size)
        return np.asarray(counted, dtype=np.float64).reshape(shape)

    def listed(self, factor: Factor, marginal: Callable[[int], FloatArray]) -> tuple[IntArray, FloatArray] | None:
        """Of a large sparse factor the entries that are possible, and P of each, from that of its node; else None."""
        if factor.label not in self.entries:
            return None
        (node, mapping), rows = self.entries[factor.label]
        assert node is not None
        p = marginal(node)
        if mapping is not None:
            p = np.asarray(np.bincount(np.asarray(mapping), weights=p, minlength=len(rows)), dtype=np.float64)
        return rows, p

    def nodes(self, names: Sequence[str]) -> tuple[int, ...]:
        """The nodes that carry `names`, each once, in order of appearance."""
        return tuple(dict.fromkeys(node for node, _ in self.located(names) if node is not None))

    def labels(self, indices: Sequence[int]) -> dict[str, Hashable]:
        """The assignment of every variable of the graph, from an index for each node."""
        own = self.columns(np.array(indices, dtype=np.int64)[:, None])[:, 0]
        pairs = zip(self.graph.variables, own.tolist(), strict=True)
        return {variable.name: variable.domain[i] for variable, i in pairs}

    def columns(self, indices: IntArray) -> IntArray:
        """`[variables, n]` indices of labels of all variables, from those of the nodes `[nodes, n]`."""
        result = np.empty((len(self.graph.variables), indices.shape[1]), dtype=np.int64)
        for number in range(len(result)):
            node, mapping = self.where[number]
            own = np.asarray(mapping)
            result[number] = own if node is None else indices[node] if mapping is None else own[indices[node]]
        return result

    def _own_index(self, place: Where, nodes: Sequence[int]) -> IntArray:
        """Index of a variable, broadcastable over the axes of the nodes."""
        node, mapping = place
        if node is None:
            return np.full((1,) * len(nodes), mapping)
        own = np.arange(self.cards[node]) if mapping is None else np.asarray(mapping)
        return own.reshape([-1 if each == node else 1 for each in nodes])


def reduce(
    graph: FactorGraph,
    given: Given,
    *,
    factors: Sequence[int] | None = None,
    keep: Iterable[int] = (),
    plain: bool = False,
) -> Problem:
    """Slice the evidence out of every factor, then substitute determined variables.

    Args:
        graph: the graph.
        given: what is known.
        factors: numbers of the factors that count; all of them by default.
        keep: variables that are kept though none of these factors touches them.
        plain: substitute nothing: each variable that is not known is a node.

    Raises:
        ImpossibleEvidence: a factor over known variables only is zero.
    """
    wiring = graph.wiring
    if factors is None:
        factors, keep = range(len(wiring.factors)), range(len(wiring.variables))
    return _Reduction(graph, given).problem(factors, keep, plain)


class _Reduction:
    """The tables of a problem while they are made, over free variables."""

    def __init__(self, graph: FactorGraph, given: Given) -> None:
        self.graph, self.given, self.wiring = graph, given, graph.wiring
        self.index: dict[int, int] = {}
        self.members: list[Variable | Factor] = []
        self.cards: list[int] = []
        self.scopes: list[Scope] = []
        self.tables: list[Table] = []
        self.entries: dict[str, tuple[int, IntArray]] = {}
        self.log_scale = 0.0

    def problem(self, factors: Iterable[int], keep: Iterable[int], plain: bool) -> Problem:
        factors, fixed = list(factors), self.given.fixed
        touched = {i for at in factors for i in self.wiring.scopes[at]}
        variables = sorted(touched.union(keep))
        for i in variables:
            if i not in fixed:
                self.index[i] = len(self.members)
                self.members.append(self.wiring.variables[i])
                self.cards.append(len(self.wiring.variables[i].domain))
        for at in factors:
            self._add(at)
        for i, values in self.given.soft.items():
            if i in self.index:
                self._table((self.index[i],), values)
            elif i in fixed:
                self._number(float(values[fixed[i]]), [self.wiring.variables[i].name])
        return self._substituted(variables, plain)

    def _substituted(self, variables: Sequence[int], plain: bool) -> Problem:
        arrays = [table.values for table in self.tables]
        parents, scopes = {}, self.scopes
        if not plain:
            parents, scopes, arrays = substitute(self.scopes, arrays, self.cards)
        left = [i for i in range(len(self.members)) if i not in parents]
        new = {old: i for i, old in enumerate(left)}

        def carrier(member: int) -> Where:
            root, mapping = parents.get(member, (member, None))
            return new[root], mapping

        fixed = self.given.fixed
        where = {i: carrier(self.index[i]) if i in self.index else (None, fixed[i]) for i in variables}
        entries = {label: (carrier(node), rows) for label, (node, rows) in self.entries.items()}
        tables = [table.holding(array) for table, array in zip(self.tables, arrays, strict=True)]
        return Problem(
            graph=self.graph,
            given=self.given,
            names=[_name(self.members[i]) for i in left],
            cards=[self.cards[i] for i in left],
            times=[_time(self.members[i]) for i in left],
            scopes=[tuple([new[i] for i in scope]) for scope in scopes] if parents else scopes,
            tables=tables,
            log_scale=self.log_scale,
            where=where,
            entries=entries,
        )

    def _add(self, at: int) -> None:
        factor, numbers, fixed = self.wiring.factors[at], self.wiring.scopes[at], self.given.fixed
        if isinstance(factor.values, SparseValues) and math.prod(factor.shape) > DENSE:
            self._sparse(factor, numbers, factor.values)
            return
        values = factor.dense()
        scope = tuple([self.index[i] for i in numbers if i not in fixed])
        if len(scope) < len(numbers):
            values = values[tuple([fixed.get(i, slice(None)) for i in numbers])]
        if scope:
            self._table(scope, values, *factor.bounds)
        else:
            self._number(float(values), [variable.name for variable in factor.scope])

    def _table(self, scope: Scope, values: FloatArray, low: float | None = None, high: float = 0.0) -> None:
        if low is None:
            low, high = log_bounds(values)
        self.scopes.append(scope)
        self.tables.append(Table(values, low if low < high else high, high))

    def _number(self, value: float, names: Sequence[str]) -> None:
        if not value > 0:
            raise impossible(self.graph, self.given.labels, names)
        self.log_scale += math.log(value)

    def _sparse(self, factor: Factor, numbers: Sequence[int], sparse: SparseValues) -> None:
        """A node for the entries that agree with the evidence; each variable of the scope hangs on it."""
        fixed, rows, values = self.given.fixed, sparse.indices, sparse.values
        known = [axis for axis, i in enumerate(numbers) if i in fixed]
        agree = (rows[:, known] == [fixed[numbers[axis]] for axis in known]).all(axis=1) & (values > 0)
        rows, values = rows[agree], values[agree]
        if len(values) < 2:
            self._number(float(values.sum()), [variable.name for variable in factor.scope])
        free = [(axis, i) for axis, i in enumerate(numbers) if i not in fixed]
        if len(values) == 1:
            for axis, i in free:
                self._table((self.index[i],), np.eye(self.cards[self.index[i]])[rows[0, axis]])
            return
        node = len(self.members)
        self.members.append(factor)
        self.cards.append(len(values))
        self.entries[factor.label] = node, rows
        self._table((node,), values)
        for axis, i in free:
            self._table((self.index[i], node), np.eye(self.cards[self.index[i]])[:, rows[:, axis]])


def _name(member: Variable | Factor) -> str:
    return member.name if isinstance(member, Variable) else member.label


def _time(member: Variable | Factor) -> int | None:
    if isinstance(member, Variable):
        return member.time
    return max((variable.time for variable in member.scope if variable.time is not None), default=None)
