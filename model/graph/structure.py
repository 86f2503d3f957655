"""What a factor graph consists of: variables, factors over them, evidence; and how each is declared."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Self

from numpy.typing import ArrayLike

from ..errors import CogmapError
from .conditional import LearnableTable
from .factors import Factor, SparseValues
from .variables import Variable


class GraphStructure:
    """P(x) ∝ Π_f f(x_f): variables with labelled domains and factors over them. What `FactorGraph` is built on.

    Everything raises `CogmapError` on names unknown or taken, and on values that do not fit their scope.
    """

    def __init__(self) -> None:
        self._variables: dict[str, Variable] = {}
        self._factors: dict[str, Factor] = {}
        self._evidence: dict[str, Hashable] = {}

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

    def variable(
        self, name: str, domain: Iterable[Hashable], *, time: int | None = None, observed: bool = False
    ) -> Variable:
        """Declare a variable and return it; see `Variable`."""
        labels = domain if isinstance(domain, str) else tuple(domain)
        return self.add_variable(Variable(name, labels, time, observed))  # pyright: ignore[reportArgumentType]

    def add_variable(self, variable: Variable) -> Variable:
        """Add a ready-made variable and return it."""
        if variable.name in self._variables or variable.name in self._factors:
            raise CogmapError(f"graph: the name {variable.name!r} is taken; give each variable its own")
        self._variables[variable.name] = variable
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
    ) -> Factor:
        """Declare a factor over variables of this graph and return it; see `Factor` for the axes of `values`."""
        if isinstance(scope, str):
            raise CogmapError(f"factor {name!r}: the scope is a string; give a list of variables")
        members = tuple(self._member(item, name) for item in scope)
        return self.add_factor(Factor(name, members, values, kind, equation, table))  # pyright: ignore[reportArgumentType]

    def add_factor(self, factor: Factor) -> Factor:
        """Add a ready-made factor over variables of this graph and return it."""
        for variable in factor.scope:
            self._member(variable, factor.name)
        if factor.label in self._factors or factor.label in self._variables:
            raise CogmapError(f"graph: there is a {factor.label} already; give the factor another name")
        self._factors[factor.label] = factor
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

    def observe(self, name: str | Variable, label: Hashable) -> Self:
        """A new graph with the evidence `name = label`; this one stays as it is."""
        return self.observe_all({self._member(name, "observe").name: label})

    def observe_all(self, evidence: Mapping[str, Hashable]) -> Self:
        """A new graph with a label for each variable named; this one stays as it is."""
        graph = self.copy()
        for name, label in evidence.items():
            self.variable_named(name).index(label)
            if graph._evidence.setdefault(name, label) != label:
                raise CogmapError(f"evidence: {name} is {graph._evidence[name]!r} in the graph already, not {label!r}")
        return graph

    def refreshed(self) -> Self:
        """A new graph whose learnable conditionals have the present mean of their tables."""
        graph = self.copy()
        for label, factor in self._factors.items():
            if isinstance(factor.table, LearnableTable):
                graph._factors[label] = replace(factor, values=factor.table.mean())
        return graph

    def copy(self) -> Self:
        """A graph of its own with the same variables, factors and evidence."""
        graph = type(self)()
        graph._variables.update(self._variables)
        graph._factors.update(self._factors)
        graph._evidence.update(self._evidence)
        return graph

    def variable_named(self, name: str) -> Variable:
        """The variable of that name."""
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

    def is_observed(self, variable: Variable) -> bool:
        """Whether the variable is an observation or has evidence."""
        return variable.observed or variable.name in self._evidence

    def _member(self, item: str | Variable, where: str) -> Variable:
        if not isinstance(item, Variable):
            return self.variable_named(item)
        if (known := self._variables.get(item.name)) is not item and known != item:
            raise CogmapError(f"{where}: variable {item.name!r} is not of this graph; declare it first")
        return item
