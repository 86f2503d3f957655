"""Which factors touch which variables, in numbers."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from .factors import Factor
from .variables import Variable


@dataclass(frozen=True)
class Wiring:
    """The shape of a graph: variables and factors by number, in the order they were declared."""

    variables: Sequence[Variable]
    number: Mapping[str, int]  # the number of each variable, by name
    factors: Sequence[Factor]
    scopes: Sequence[tuple[int, ...]]  # for each factor the numbers of its variables
    touching: Sequence[Sequence[int]]  # for each variable the numbers of the factors that touch it

    @classmethod
    def of(cls, variables: Iterable[Variable], factors: Iterable[Factor]) -> Wiring:
        """The wiring of these variables and factors."""
        variables, factors = tuple(variables), tuple(factors)
        number = {variable.name: i for i, variable in enumerate(variables)}
        scopes = [tuple([number[variable.name] for variable in factor.scope]) for factor in factors]
        touching: list[list[int]] = [[] for _ in number]
        for at, scope in enumerate(scopes):
            for i in scope:
                touching[i].append(at)
        return cls(variables, number, factors, scopes, touching)

    @cached_property
    def single(self) -> Sequence[int]:
        """The variables of one label."""
        return [i for i, variable in enumerate(self.variables) if len(variable.domain) == 1]

    @cached_property
    def observed(self) -> Sequence[int]:
        """The variables that were declared observed and have several labels: evidence must tell which."""
        return [i for i, variable in enumerate(self.variables) if variable.observed and len(variable.domain) > 1]

    @cached_property
    def own(self) -> Sequence[int] | None:
        """For each variable the number of its factor P(variable | parents), where the whole graph is a directed model.

        That is: each variable is first in the scope of one factor, which is normalised over it, and there is no cycle.
        """
        scopes = self.scopes
        if len(scopes) != len(self.number) or len({scope[0] for scope in scopes}) < len(scopes):
            return None
        if not acyclic(scopes) or not all(factor.normalised for factor in self.factors):
            return None
        own = [0] * len(scopes)
        for at, scope in enumerate(scopes):
            own[scope[0]] = at
        return own

    def needed(self, asked: Collection[int]) -> list[int]:
        """Numbers of the factors left once all that sums to 1 whatever the variables `asked` are is taken out.

        A variable that is not asked for and in one factor only, normalised over it, is barren: summed out it leaves 1.
        """
        if self.own is not None:
            return sorted(self.own[i] for i in self.ancestors(asked))
        alive = [True] * len(self.factors)
        count = [len(around) for around in self.touching]
        waiting = [i for i, many in enumerate(count) if many == 1]
        while waiting:
            i = waiting.pop()
            at = next((at for at in self.touching[i] if alive[at]), None)
            if at is None or i in asked or self.scopes[at][0] != i or not self.factors[at].normalised:
                continue
            alive[at] = False
            for j in self.scopes[at]:
                count[j] -= 1
                if count[j] == 1:
                    waiting.append(j)
        return [at for at, is_alive in enumerate(alive) if is_alive]

    def ancestors(self, asked: Iterable[int]) -> set[int]:
        """The variables `asked`, their parents, the parents of these, and so on, in a directed model."""
        assert self.own is not None
        found = set(asked)
        waiting = list(found)
        while waiting:
            for j in self.scopes[self.own[waiting.pop()]]:
                if j not in found:
                    found.add(j)
                    waiting.append(j)
        return found


def acyclic(scopes: Sequence[tuple[int, ...]]) -> bool:
    """Whether scopes `(child, *parents)`, one a child, have no cycle."""
    children: dict[int, list[int]] = {}
    missing = {scope[0]: len(scope) - 1 for scope in scopes}
    for child, *parents in scopes:
        for parent in parents:
            children.setdefault(parent, []).append(child)
    ready = [child for child, many in missing.items() if many == 0]
    done = 0
    while ready:
        done += 1
        for child in children.get(ready.pop(), ()):
            missing[child] -= 1
            if missing[child] == 0:
                ready.append(child)
    return done == len(scopes)
