"""Graphs that repeat in time: the variables and factors of one slice, and of the step between two."""

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, field
from typing import Any, cast

from ..errors import CogmapError
from .factor_graph import FactorGraph
from .structure import GraphStructure
from .variables import Variable

Domain = Sequence[Hashable] | Callable[[int], Sequence[Hashable]]
Values = Any | Callable[[int], Any]


@dataclass(frozen=True, slots=True)
class Before:
    """The variable of the slice before; see `before`."""

    name: str


def before(name: str) -> Before:
    """In the scope of a template's factor: the variable `name` of the slice before."""
    return Before(name)


@dataclass(frozen=True, slots=True)
class _Variable:
    name: str
    domain: Domain
    observed: bool


@dataclass(frozen=True, slots=True)
class _Factor:
    name: str
    scope: tuple[str | Before, ...]
    values: Values
    first: bool | None
    options: dict[str, Any]


@dataclass(slots=True)
class Template:
    """The variables and factors of one slice, and of the step between two. Domains and values may be functions of t.

    A factor with a `before(…)` in its scope belongs to every step from one slice to the next; one with `first=True`
    to the first slice alone, one with `first=False` to all others; any other factor to every slice.

    Example: `t = Template(); t.variable("s", (0, 1)); t.factor("P", ["s"], [0.5, 0.5], first=True);
    t.factor("B", ["s", before("s")], [[0.9, 0.2], [0.1, 0.8]]); t.unroll(3)` has the variables s0, s1, s2.
    """

    _variables: dict[str, _Variable] = field(default_factory=dict[str, _Variable])
    _factors: list[_Factor] = field(default_factory=list[_Factor])

    def variable(self, name: str, domain: Domain, *, observed: bool = False) -> str:
        """Declare a variable of every slice; the name comes back. See `Variable`.

        Raises:
            CogmapError: the name is taken, or as for `Variable`.
        """
        if name in self._variables:
            raise CogmapError(f"template: the name {name!r} is taken; give each variable its own")
        if not callable(domain):
            Variable(name, cast(tuple[Hashable, ...], domain))  # refuses at once what is wrong
        self._variables[name] = _Variable(name, domain, observed)
        return name

    def factor(
        self,
        name: str,
        scope: Sequence[str | Before],
        values: Values,
        *,
        first: bool | None = None,
        kind: str = "factor",
        equation: str = "",
        table: object | None = None,
    ) -> None:
        """Declare a factor of every slice, of the first, or of every step; see `GraphStructure.factor`.

        Raises:
            CogmapError: the scope is no list of variables of the template, or as for `GraphStructure.factor`.
        """
        if isinstance(scope, str | Before):
            raise CogmapError(f"template: the scope of {name!r} is {scope!r}; give a list of variables")
        names = [item.name if isinstance(item, Before) else item for item in scope]
        if unknown := [each for each in names if each not in self._variables]:
            raise CogmapError(f"template: factor {name!r} names {unknown[0]!r}; declare this variable first")
        step = any(isinstance(item, Before) for item in scope)
        if step and first:
            raise CogmapError(f"template: factor {name!r} reaches before the first slice; drop `first` or `before`")
        options = {"kind": kind, "equation": equation, "table": table}
        self._factors.append(_Factor(name, tuple(scope), values, False if step else first, options))

    @property
    def names(self) -> tuple[str, ...]:
        """The variables of a slice."""
        return tuple(self._variables)

    @property
    def interface(self) -> tuple[str, ...]:
        """The variables that the next slice refers to: given these, past and future are independent."""
        used = {item.name for factor in self._factors for item in factor.scope if isinstance(item, Before)}
        return tuple(name for name in self._variables if name in used)

    def unroll(self, steps: int, *, start: int = 0) -> FactorGraph:
        """The graph of `steps` slices; the variables of slice t are called `{name}{t}`, and have the time t.

        Raises:
            CogmapError: fewer than one step, or what declaring variables and factors raises.
        """
        if steps < 1:
            raise CogmapError(f"template: cannot unroll {steps} slices; ask for 1 or more")
        graph = FactorGraph()
        for t in range(start, start + steps):
            self.declare(graph, t, lambda name, t=t: f"{name}{t}")
            self.connect(graph, t, lambda name, t=t: f"{name}{t}", lambda name, t=t: f"{name}{t - 1}", first=t == start)
        return graph

    def declare(
        self, graph: GraphStructure, t: int, called: Callable[[str], str], *, only: Sequence[str] | None = None
    ) -> None:
        """Declare the variables of slice t in a graph, or some of them, under the names `called`."""
        for each in self._variables.values() if only is None else [self._variables[name] for name in only]:
            domain = each.domain(t) if callable(each.domain) else each.domain
            graph.variable(called(each.name), domain, time=t, observed=each.observed and only is None)

    def connect(
        self, graph: GraphStructure, t: int, called: Callable[[str], str], earlier: Callable[[str], str], *, first: bool
    ) -> None:
        """Declare the factors of slice t, and of the step to it unless it is the first one."""
        for each in self._factors:
            if each.first is None or each.first == first:
                scope = [earlier(item.name) if isinstance(item, Before) else called(item) for item in each.scope]
                values: Any = each.values(t) if callable(each.values) else each.values
                graph.factor(each.name, scope, values, **each.options)
