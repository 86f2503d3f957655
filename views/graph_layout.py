"""Where the variables and factors of a graph are drawn: along time where they have one, or well apart."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..model import Factor, FactorGraph, Variable
from .layout import Point, spread

ABOVE = ("p", "s")  # rows of the cognitive map from the top; others follow in the order they were declared
BESIDE = 0.2  # observations of one step stand this far from its column
DROP = 0.62  # from one row of observations to the next
TOUCHING = 0.12  # factors nearer than this are moved apart


@dataclass(frozen=True, slots=True)
class GraphLayout:
    """Coordinates, x to the right and y upwards; things that do not touch are about a unit apart."""

    variables: Mapping[str, Point]  # by name
    factors: Mapping[str, Point]  # by label
    columns: Mapping[int, float]  # x of each time step; empty where no variable has a time


def layout_of(graph: FactorGraph, variables: Sequence[Variable], factors: Sequence[Factor]) -> GraphLayout:
    """The layout of a part of a graph: factors over `variables` only."""
    times = sorted({variable.time for variable in variables if variable.time is not None})
    if not times:
        names = [variable.name for variable in variables]
        points = spread(names, ((factor.label, variable.name) for factor in factors for variable in factor.scope))
        return GraphLayout({name: points.pop(name) for name in names}, points, {})
    columns = {time: float(x) for x, time in enumerate(times)}
    points = _timed(graph, [variable for variable in variables if variable.time is not None], factors, columns)
    points |= _timeless(variables, factors, points)
    return GraphLayout(points, _between(factors, points), columns)


def _stem(variable: Variable) -> str:
    """The name without the number of its time step: variables with the same stem stand in a row."""
    return re.sub(rf"[_\W]*{abs(variable.time or 0)}[)\]]?$", "", variable.name) or variable.name


def _timed(
    graph: FactorGraph, variables: Sequence[Variable], factors: Sequence[Factor], columns: Mapping[int, float]
) -> dict[str, Point]:
    """Rows of what is latent, and what is observed below; what decides on transitions between the first two rows."""
    switches = _switches(graph, variables, factors)
    observed = {v.name for v in variables if graph.is_observed(v)}
    latent = dict.fromkeys(_stem(v) for v in variables if v.name not in observed and v.name not in switches)
    below = dict.fromkeys(_stem(v) for v in variables if v.name in observed and _stem(v) not in latent)
    names = [*(name for name in ABOVE if name in latent), *(name for name in latent if name not in ABOVE)]
    rows = {name: -float(i) for i, name in enumerate(names)}
    rows |= {name: -float(len(names) - 1) - 0.95 - DROP * i for i, name in enumerate(below)}
    points: dict[str, Point] = {}
    for variable in variables:
        name, x = variable.name, columns[variable.time or 0]
        beside = [v.name for v in variables if v.time == variable.time and v.name in observed]
        if name in switches:
            points[name] = (x + switches[name], -0.5 if len(names) > 1 else 0.8)
        elif name in beside and len(beside) > 1:  # so that none hides the way to another
            points[name] = (
                x + np.linspace(-BESIDE, BESIDE, len(beside)).tolist()[beside.index(name)],
                rows[_stem(variable)],
            )
        else:
            points[name] = (x, rows[_stem(variable)])
    return points


def _switches(graph: FactorGraph, variables: Sequence[Variable], factors: Sequence[Factor]) -> dict[str, float]:
    """Latent variables that only take part in transitions of others, such as `moved`, and how far they stand aside."""
    found: dict[str, float] = {}
    for variable in variables:
        scopes = [factor.scope for factor in factors if variable in factor.scope and len(factor.scope) > 1]
        others = [[other for other in scope if other is not variable and other.time is not None] for scope in scopes]
        times = [{other.time for other in scope} for scope in others]
        lasting = any(_stem(other) == _stem(variable) for scope in others for other in scope)
        deciding = all(len(among) > 1 and variable.time in among for among in times)
        if scopes and deciding and not lasting and not graph.is_observed(variable):
            found[variable.name] = -0.5 if variable.time == max(time or 0 for time in times[0]) else 0.5
    return found


def _timeless(
    variables: Sequence[Variable], factors: Sequence[Factor], points: Mapping[str, Point]
) -> dict[str, Point]:
    """Variables without a time stand in a row of their own above those they have to do with."""
    wanted: list[tuple[float, str]] = []
    for variable in variables:
        if variable.time is None:
            near = [points[v.name][0] for f in factors if variable in f.scope for v in f.scope if v.name in points]
            wanted.append((float(np.mean(near)) if near else 0.0, variable.name))
    found: dict[str, Point] = {}
    free, above = -np.inf, max(y for _, y in points.values()) + 1.0
    for x, name in sorted(wanted):
        found[name] = (max(x, free), above)
        free = found[name][0] + 1.0
    return found


def _between(factors: Sequence[Factor], points: Mapping[str, Point]) -> dict[str, Point]:
    """A factor of one variable stands beside it, one of several between those of its first two."""
    found: dict[str, Point] = {}
    for factor in factors:
        (x, y), *others = (points[variable.name] for variable in factor.scope)
        aside = 0.34 if x % 1.0 else -0.34  # to the left of a column, to the right of a variable between two
        spot = ((x + others[0][0]) / 2, (y + others[0][1]) / 2) if others else (x + aside, y)
        while any(abs(spot[0] - x) + abs(spot[1] - y) < TOUCHING for x, y in found.values()):
            spot = (spot[0] + 0.17, spot[1] + 0.17)
        found[factor.label] = spot
    return found
