"""Where the variables and factors of a graph are drawn: along time where they have one, or well apart."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..model import Factor, FactorGraph, Variable
from .layout import Point, spread

ABOVE = ("p", "s")
"""Rows of the cognitive map from the top; other names follow in the order they were declared."""

BESIDE = 0.2  # observations of one step stand this far from its column
DROP = 0.62  # from one row of observations to the next
TOUCHING = 0.12  # factors nearer than this are moved apart


@dataclass(frozen=True, slots=True)
class GraphLayout:
    """Coordinates, x to the right and y upwards; things that do not touch are about a unit apart.

    Attributes:
        variables: by name.
        factors: by label.
        columns: x of each time step; empty where no variable has a time.
    """

    variables: Mapping[str, Point]
    factors: Mapping[str, Point]
    columns: Mapping[int, float]


def layout_of(graph: FactorGraph, variables: Sequence[Variable], factors: Sequence[Factor]) -> GraphLayout:
    """The layout of a part of a graph: factors over `variables` only."""
    if any(variable.time is not None for variable in variables):
        return _in_time(graph, variables, factors)
    names = [variable.name for variable in variables]
    points = spread(names, ((factor.label, variable.name) for factor in factors for variable in factor.scope))
    return GraphLayout({name: points.pop(name) for name in names}, points, {})


def _in_time(graph: FactorGraph, variables: Sequence[Variable], factors: Sequence[Factor]) -> GraphLayout:
    columns = {time: float(x) for x, time in enumerate(sorted({v.time for v in variables if v.time is not None}))}
    switches = _switches(graph, variables, factors)
    rows, at_switch = _rows(graph, variables, switches)
    points: dict[str, Point] = {}
    for variable in variables:
        if variable.time is None:
            continue
        x, row = columns[variable.time], rows[stem(variable)]
        if variable.name in switches:
            points[variable.name] = (x + switches[variable.name], at_switch)
        elif graph.is_observed(variable):
            points[variable.name] = (x + _aside(graph, variables, variable), row)
        else:
            points[variable.name] = (x, row)
    points |= _timeless(variables, factors, points, above=max([*rows.values(), at_switch]) + 1.0)
    return GraphLayout(points, _between(factors, points), columns)


def stem(variable: Variable) -> str:
    """The name without the number of its time step: variables with the same stem stand in a row."""
    name = variable.name
    return re.sub(rf"[_\W]*{abs(variable.time)}[)\]]?$", "", name) or name if variable.time is not None else name


def _switches(graph: FactorGraph, variables: Sequence[Variable], factors: Sequence[Factor]) -> dict[str, float]:
    """Latent variables that only take part in transitions of others, such as `moved`, and how far they stand aside."""
    found: dict[str, float] = {}
    for variable in variables:
        if variable.time is None or graph.is_observed(variable):
            continue
        scopes = [factor.scope for factor in factors if variable in factor.scope and len(factor.scope) > 1]
        times = [
            {other.time for other in scope if other is not variable and other.time is not None} for scope in scopes
        ]
        lasting = any(other is not variable and stem(other) == stem(variable) for scope in scopes for other in scope)
        if scopes and not lasting and all(len(among) > 1 and variable.time in among for among in times):
            found[variable.name] = -0.5 if variable.time == max(times[0]) else 0.5
    return found


def _rows(
    graph: FactorGraph, variables: Sequence[Variable], switches: Mapping[str, float]
) -> tuple[dict[str, float], float]:
    """Height of each row by stem, and that of the switches: between the first two rows of latent variables."""
    timed = [variable for variable in variables if variable.time is not None]
    latent = dict.fromkeys(stem(v) for v in timed if not graph.is_observed(v) and v.name not in switches)
    observed = [name for name in dict.fromkeys(stem(v) for v in timed if graph.is_observed(v)) if name not in latent]
    names = [name for name in ABOVE if name in latent] + [name for name in latent if name not in ABOVE]
    rows = {name: -float(i) for i, name in enumerate(names)}
    bottom = -float(len(names) - 1)
    rows |= {name: bottom - 0.95 - DROP * i for i, name in enumerate(observed)}
    at_switch = -0.5 if len(names) > 1 else 0.8
    return {**{stem(v): at_switch for v in timed if v.name in switches}, **rows}, at_switch if switches else 0.0


def _aside(graph: FactorGraph, variables: Sequence[Variable], variable: Variable) -> float:
    """How far an observation stands beside its column, so that none hides the way to another."""
    others = [v.name for v in variables if v.time == variable.time and graph.is_observed(v)]
    if len(others) < 2:
        return 0.0
    return float(np.linspace(-BESIDE, BESIDE, len(others))[others.index(variable.name)])


def _timeless(
    variables: Sequence[Variable], factors: Sequence[Factor], points: Mapping[str, Point], *, above: float
) -> dict[str, Point]:
    """Variables without a time stand in a row of their own above those they have to do with."""
    found: dict[str, Point] = {}
    wanted: list[tuple[float, str]] = []
    for variable in variables:
        if variable.time is None:
            near = [v.name for f in factors if variable in f.scope for v in f.scope if v.name in points]
            wanted.append((float(np.mean([points[name][0] for name in near])) if near else 0.0, variable.name))
    free = -np.inf
    for x, name in sorted(wanted):
        found[name] = (max(x, free), above)
        free = found[name][0] + 1.0
    return found


def _between(factors: Sequence[Factor], points: Mapping[str, Point]) -> dict[str, Point]:
    """A factor of one variable stands beside it, one of several between those of its first two."""
    found: dict[str, Point] = {}
    for factor in factors:
        ends = [points[variable.name] for variable in factor.scope]
        (x, y), *others = ends
        spot = ((x + others[0][0]) / 2, (y + others[0][1]) / 2) if others else (x + _side(ends[0], points), y)
        while any(abs(spot[0] - x) + abs(spot[1] - y) < TOUCHING for x, y in found.values()):
            spot = (spot[0] + 0.17, spot[1] + 0.17)
        found[factor.label] = spot
    return found


def _side(point: Point, points: Mapping[str, Point]) -> float:
    """To the left of a column, to the right of a variable between two."""
    return 0.34 if point[0] % 1.0 else -0.34
