"""The factor graph of the window for a recording: what each step added to it, and what is believed of its variables."""

from __future__ import annotations

from typing import Any

from ..inference import infer
from ..model import Factor, FactorGraph, Variable, encode

DIGITS = 4


class WindowWatch:
    """Tells what is new in the windows that follow one another.

    Variables and factors are told once, at the step that added them. The graph of a step is the prior of time
    `since`, the other factors of later times, and the variables in their scopes. `tops` has the latent variables whose
    most probable label, or its probability, is not what was told last.
    """

    def __init__(self) -> None:
        self._told: set[str] = set()
        self._tops: dict[str, list[Any]] = {}

    def delta(self, graph: FactorGraph) -> dict[str, Any]:
        """What is new since the last call, as JSON values."""
        variables = [variable for variable in graph.variables if variable.name not in self._told]
        factors = [factor for factor in graph.factors if factor.label not in self._told]
        self._told.update([*(variable.name for variable in variables), *(factor.label for factor in factors)])
        before, self._tops = self._tops, _tops(graph)
        return {
            "since": min(variable.time or 0 for variable in graph.variables),
            "variables": [_variable(variable) for variable in variables],
            "factors": [_factor(factor) for factor in factors],
            "tops": [[name, *top] for name, top in self._tops.items() if before.get(name) != top],
        }


def _variable(variable: Variable) -> list[Any]:
    """Name, time, and the label where it is observed."""
    return [variable.name, variable.time, *([encode(variable.domain[0])] if variable.observed else [])]


def _factor(factor: Factor) -> list[Any]:
    """Symbol, kind and scope."""
    return [factor.name, factor.kind, *(variable.name for variable in factor.scope)]


def _tops(graph: FactorGraph) -> dict[str, list[Any]]:
    """The most probable label of every latent variable, and its probability."""
    posterior, tops = infer(graph), dict[str, list[Any]]()
    for variable in graph.variables:
        if not variable.observed:
            q = posterior.marginal(variable.name)
            best = int(q.argmax())
            tops[variable.name] = [encode(variable.domain[best]), round(float(q[best]), DIGITS)]
    return tops
