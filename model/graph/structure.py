"""What a factor graph consists of: variables, factors over them, evidence; and how each is declared."""

import math
from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Self, cast

import numpy as np
from numpy.typing import ArrayLike

from ..errors import CogmapError
from .conditional import ConditionalTable, LearnableTable
from .factors import Factor, SparseValues
from .variables import Variable
from .wiring import Wiring

Evidence = Hashable | Mapping[Hashable, float]
"""A label, or likelihoods of labels."""
AllEvidence = Mapping[str, Evidence] | Mapping[Variable, Evidence] | Mapping[str | Variable, Evidence]
"""Evidence by variable: by its name, or by itself."""


class GraphStructure:
    """P(x) ∝ Π_f f(x_f): variables with labelled domains and factors over them. What `FactorGraph` is built on.

    Everything raises `CogmapError` on names unknown or taken, and on values that do not fit their scope.
    """

    def __init__(self) -> None:
        self._variables: dict[str, Variable] = {}
        self._factors: dict[str, Factor] = {}
        self._evidence: dict[str, Hashable] = {}
        self._likelihoods: dict[str, tuple[float, ...]] = {}
        self._wiring: Wiring | None = None

    @property
    def variables(self) -> tuple[Variable, ...]:
        """All variables, in the order they were declared."""
        return tuple(self._variables.values())

    @property
    def factors(self) -> tuple[Factor, ...]:
        """All factors, in the order they were declared."""
        return tuple(self._factors.values())

    @property
    def evidence(self) -> Mapping[str, Hashable]:
        """Labels given by `observe`, by variable name (read-only)."""
        return MappingProxyType(self._evidence)

    @property
    def likelihoods(self) -> Mapping[str, tuple[float, ...]]:
        """Soft evidence given by `observe`, by variable name: one likelihood a label of the domain (read-only)."""
        return MappingProxyType(self._likelihoods)

    @property
    def wiring(self) -> Wiring:
        """Which factors touch which variables, by number; made once and shared by copies."""
        if self._wiring is None:
            self._wiring = Wiring.of(self._variables.values(), self._factors.values())
        return self._wiring

    def variable(
        self, name: str, domain: Iterable[Hashable], *, time: int | None = None, observed: bool = False
    ) -> Variable:
        """Declare a variable and return it; see `Variable`."""
        return self.add_variable(Variable(name, cast(tuple[Hashable, ...], domain), time, observed))

    def add_variable(self, variable: Variable) -> Variable:
        """Add a ready-made variable and return it."""
        if variable.name in self._variables or variable.name in self._factors:
            raise CogmapError(f"graph: the name {variable.name!r} is taken; give each variable its own")
        self._variables[variable.name] = variable
        self._wiring = None
        return variable

    def factor(
        self,
        name: str,
        scope: Sequence[str | Variable],
        values: ArrayLike | SparseValues,
        *,
        kind: str = "factor",
        equation: str = "",
        table: object | None = None,
        normalised: bool = False,
    ) -> Factor:
        """Declare a factor over variables of this graph and return it; see `Factor` for the axes of `values`.

        With `normalised=True` it must be a conditional: over the first variable its values sum to 1.
        """
        if isinstance(scope, str):
            raise CogmapError(f"factor {name!r}: the scope is a string; give a list of variables")
        members = tuple(self._member(item, name) for item in scope)
        factor = Factor(name, members, values, kind, equation, table)  # pyright: ignore[reportArgumentType]
        if normalised:
            factor.check_normalised()
        return self.add_factor(factor)

    def add_factor(self, factor: Factor) -> Factor:
        """Add a ready-made factor over variables of this graph and return it."""
        for variable in factor.scope:
            self._member(variable, factor.name)
        if factor.label in self._factors or factor.label in self._variables:
            raise CogmapError(f"graph: there is a {factor.label} already; give the factor another name")
        self._factors[factor.label] = factor
        self._wiring = None
        return factor

    def conditional(
        self,
        child: str | Variable,
        parents: Sequence[str | Variable],
        table: LearnableTable,
        *,
        name: str = "P",
        kind: str = "conditional",
        equation: str = "",
    ) -> Factor:
        """Declare P(child | parents) with the values of `table.mean()`, axes `[child, *parents]`.

        The values are those of the moment; `refreshed` takes up what the table has learned since.
        """
        if not isinstance(table, LearnableTable):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise CogmapError(f"conditional {name!r}: the table needs `mean()` and `learn(counts, rate)`")
        return self.factor(name, [child, *parents], table.mean(), kind=kind, equation=equation, table=table)

    def observe(self, name: str | Variable, label: Evidence) -> Self:
        """A new graph with the evidence `name = label`; this one stays as it is.

        A mapping of labels to likelihoods is soft evidence: `observe("x", {"a": 0.7, "b": 0.2})` multiplies by
        0.7 where x = a, by 0.2 where x = b, and by 0 elsewhere.
        """
        return self.observe_all({name: label})

    def observe_all(self, evidence: AllEvidence) -> Self:
        """A new graph with a label, or likelihoods, for each variable named; this one stays as it is."""
        graph = self.copy()
        for item, label in evidence.items():
            graph._observe(self._member(item, "evidence"), label)
        return graph

    def _observe(self, variable: Variable, label: Evidence) -> None:
        name = variable.name
        if isinstance(label, Mapping):
            values = _likelihoods(variable, label)
            if name in self._evidence or self._likelihoods.setdefault(name, values) != values:
                raise CogmapError(f"evidence: {name} has evidence already; multiply the likelihoods, or take it back")
        else:
            variable.index(label)
            if name in self._likelihoods:
                raise CogmapError(f"evidence: {name} has soft evidence already; take it back with without_evidence")
            if self._evidence.setdefault(name, label) != label:
                raise CogmapError(f"evidence: {name} is {self._evidence[name]!r} in the graph already, not {label!r}")

    def without_evidence(self, *names: str | Variable) -> Self:
        """A new graph without the evidence about `names`; without any where none is named."""
        graph = self.copy()
        for name in [self._member(item, "without_evidence").name for item in names] or list(self._variables):
            known = graph._evidence.pop(name, None) is not None or graph._likelihoods.pop(name, None) is not None
            if names and not known:
                raise CogmapError(f"without_evidence: there is no evidence about {name!r}; name one that has some")
        return graph

    def without_factor(self, *names: str) -> Self:
        """A new graph without these factors, by label, or by name where only one factor has it."""
        graph = self.copy()
        for name in names:
            del graph._factors[graph.factor_named(name).label]
        graph._wiring = None
        return graph

    def intervene(self, name: str | Variable, label: Hashable) -> Self:
        """A new graph for do(name = label): the conditional of the variable is cut out, then it is set.

        The conditional is the one factor that has the variable first and is normalised over it.

        Raises:
            CogmapError: there is no such factor or several; the graph then does not say what causes the variable.
        """
        variable = self._member(name, "intervene")
        found = [factor for factor in self._factors.values() if factor.scope[0] == variable]
        if len(found) != 1 or not found[0].normalised:
            raise CogmapError(
                f"intervene: {variable.name!r} needs one conditional, a normalised factor that has it first in its "
                f"scope; {len(found)} factors have it first. Cut the graph yourself with without_factor, then observe"
            )
        return self.without_factor(found[0].label).observe(variable, label)

    def replaced(self, factors: Iterable[Factor]) -> Self:
        """A new graph with these factors in the places of those that have the same labels."""
        graph = self.copy()
        for factor in factors:
            graph._factors[self.factor_named(factor.label).label] = factor
        graph._wiring = None
        return graph

    def refreshed(self) -> Self:
        """A new graph whose learnable conditionals have the present mean of their tables."""
        tied = [(factor, factor.table) for factor in self._factors.values() if isinstance(factor.table, LearnableTable)]
        return self.replaced(replace(factor, values=table.mean()) for factor, table in tied)

    def with_tables(self, prior: float = 1.0) -> Self:
        """A new graph in which every conditional has a table to learn: `ConditionalTable`, the same prior everywhere.

        A conditional is a factor that is normalised over its first variable. The values stay as they are until they
        are `refreshed` or learned. Tables that are there already stay.
        """
        bare = [factor for factor in self._factors.values() if factor.table is None and factor.normalised]
        return self.replaced(replace(factor, table=ConditionalTable(np.full(factor.shape, prior))) for factor in bare)

    def copy(self) -> Self:
        """A graph of its own with the same variables, factors and evidence."""
        graph = type(self)()
        graph._variables.update(self._variables)
        graph._factors.update(self._factors)
        graph._evidence.update(self._evidence)
        graph._likelihoods.update(self._likelihoods)
        graph._wiring = self._wiring
        return graph

    def variable_named(self, name: str | Variable) -> Variable:
        """The variable of that name; a `Variable` of this graph stands for itself."""
        if isinstance(name, Variable):
            return self._member(name, "graph")
        try:
            return self._variables[name]
        except (KeyError, TypeError):
            known = ", ".join(list(self._variables)[:8]) + (", …" if len(self._variables) > 8 else "")
            raise CogmapError(f"graph: no variable {name!r}; it has {known or 'none yet'}") from None

    def factor_named(self, name: str) -> Factor:
        """The factor with that label (`"B_s(s1, s0)"`), or with that name where only one has it."""
        if name in self._factors:
            return self._factors[name]
        found = [factor for factor in self._factors.values() if factor.name == name]
        if len(found) != 1:
            raise CogmapError(f"graph: {len(found)} factors are called {name!r}; give a label such as 'B(x, y)'")
        return found[0]

    def is_observed(self, name: str | Variable) -> bool:
        """Whether the variable is an observation or has evidence."""
        variable = self.variable_named(name)
        return variable.observed or variable.name in self._evidence

    def _member(self, item: str | Variable, where: str) -> Variable:
        if not isinstance(item, Variable):
            return self.variable_named(item)
        if (known := self._variables.get(item.name)) is not item and known != item:
            raise CogmapError(f"{where}: variable {item.name!r} is not of this graph; declare it first")
        return item


def _likelihoods(variable: Variable, given: Mapping[Hashable, float]) -> tuple[float, ...]:
    """One likelihood a label of the domain, 0 where none is given."""
    values = [0.0] * variable.cardinality
    for label, value in given.items():
        number = float(value) if isinstance(cast(object, value), int | float) else math.nan
        if not 0 <= number < math.inf:
            raise CogmapError(
                f"evidence: the likelihood of {variable.name} = {label!r} is {value!r}; give a finite number, 0 or more"
            )
        values[variable.index(label)] = number
    if not any(values):
        raise CogmapError(f"evidence: every likelihood of {variable.name} is 0; give one label at least some")
    return tuple(values)
