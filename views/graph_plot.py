"""The factor graph of a window, laid out in time as partially observed Markov decision processes usually are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..model import CogmapError, Factor, FactorGraph, Variable
from .axes import axes_or_new, without_ticks, write_in
from .colours import SKY, ink_on, mixed
from .graph_layout import GraphLayout, layout_of
from .layout import Point
from .theme import Theme, theme_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

RADIUS = 0.17  # of a variable
HALF = 0.05  # of the side of a factor
INCHES = 1.15  # a unit is wide, in a new figure
WIDEST = 22.0  # inches of a new figure
CLEAR = 60.0  # degrees that a label keeps from the lines, if it can

_SIDES: tuple[tuple[Point, str, str], ...] = (
    ((0.0, -1.0), "center", "top"),
    ((0.0, 1.0), "center", "bottom"),
    ((1.0, 0.0), "left", "center"),
    ((-1.0, 0.0), "right", "center"),
)
"""Sides of a factor where its label may stand, and how it is aligned there."""


def plot_factor_graph(
    graph: FactorGraph, *, last: int | None = None, title: str | None = None, ax: Axes | None = None
) -> Axes:
    """Variables as circles, filled where they are observed, and factors as squares between them.

    Where variables have a time there is a column for each step, a row for each kind of latent variable, and the
    observations below with their labels. Variables that only take part in transitions, such as `moved`, stand between
    the columns. A graph without times is spread out by springs, always in the same way.

    Args:
        graph: an agent's `graph`, or any other.
        last: only the last steps, this many; factors that reach beyond are left out.
        title: above the plot.
        ax: axes to draw on; new ones, wide enough for all columns, unless given.

    Raises:
        CogmapError: the graph has no variables, or `last` is below 1.
    """
    variables, factors, cut = _part(graph, last)
    layout = layout_of(graph, variables, factors)
    points = [*layout.variables.values(), *layout.factors.values()]
    (low_x, high_x), (low_y, high_y) = ((min(part), max(part)) for part in zip(*points, strict=True))
    below = 0.75 if layout.columns else 0.35
    limits = (low_x - 0.45, high_x + 0.45, low_y - below, high_y + 0.4)
    ax = axes_or_new(ax, title, size=_size(limits))
    without_ticks(ax, *limits)
    theme = theme_of(ax)
    _draw_edges(ax, factors, layout, theme)
    in_time = bool(layout.columns)
    for variable in variables:
        _draw_variable(ax, graph, variable, layout.variables[variable.name], theme, longest=0.44 if in_time else 0.8)
    for factor in factors:
        ends = [layout.variables[variable.name] for variable in factor.scope]
        _draw_factor(ax, factor, layout.factors[factor.label], ends, theme, in_time=in_time)
    _draw_times(ax, layout.columns, limits[2] + 0.14, cut, theme)
    return ax


def _part(graph: FactorGraph, last: int | None) -> tuple[list[Variable], list[Factor], bool]:
    """The variables and factors that are drawn, and whether steps before them are left out."""
    if last is not None and last < 1:
        raise CogmapError(f"plot_factor_graph: last is {last}; use 1 or more steps")
    if not graph.variables:
        raise CogmapError("plot_factor_graph: the graph has no variables; declare some first")
    times = sorted({variable.time for variable in graph.variables if variable.time is not None})
    kept = set(times if last is None else times[-last:])
    variables = [variable for variable in graph.variables if variable.time is None or variable.time in kept]
    factors = _among(graph.factors, variables)
    if len(kept) < len(times):
        variables = [variable for variable in variables if not _bereft(graph, factors, variable)] or variables
    return variables, _among(factors, variables), len(kept) < len(times)


def _among(factors: Sequence[Factor], variables: Sequence[Variable]) -> list[Factor]:
    names = {variable.name for variable in variables}
    return [factor for factor in factors if all(variable.name in names for variable in factor.scope)]


def _bereft(graph: FactorGraph, factors: Sequence[Factor], variable: Variable) -> bool:
    """Whether the cut took all that tied the variable to others and left only a prior of its own."""
    left = [len(factor.scope) for factor in factors if variable in factor.scope]
    before = [len(factor.scope) for factor in graph.factors if variable in factor.scope]
    return bool(left) and max(left) == 1 < max(before)


def _size(limits: tuple[float, float, float, float]) -> tuple[float, float]:
    width, height = limits[1] - limits[0], limits[3] - limits[2]
    inches = min(INCHES, WIDEST / max(width, height))
    return max(inches * width, 3.0), max(inches * height, 2.0) + 0.3


def _draw_edges(ax: Axes, factors: Sequence[Factor], layout: GraphLayout, theme: Theme) -> None:
    from matplotlib.collections import LineCollection

    lines = [[layout.factors[f.label], layout.variables[v.name]] for f in factors for v in f.scope]
    ax.add_collection(LineCollection(lines, colors=[theme.shade(0.55)], linewidths=1.0, zorder=1))


def _draw_variable(
    ax: Axes, graph: FactorGraph, variable: Variable, point: Point, theme: Theme, *, longest: float
) -> None:
    from matplotlib.patches import Ellipse

    seen = graph.is_observed(variable)
    width = min(2 * RADIUS * max(len(variable.name) / 4, 1.0), longest)
    face = mixed(SKY, theme.paper, 0.75) if seen else theme.paper
    ax.add_artist(Ellipse(point, width, 2 * RADIUS, facecolor=face, edgecolor=theme.ink, linewidth=1.2, zorder=2))
    ink = ink_on(face) if seen else theme.ink
    write_in(ax, *point, variable.name, box=(0.87 * width, RADIUS), largest=10.0, color=ink, zorder=3)
    if seen and (text := _label_seen(graph, variable)):
        under = (point[0], point[1] - RADIUS - 0.02)
        write_in(ax, *under, text, box=(0.42, 0.17), largest=9.0, color=theme.ink, va="top", zorder=3)


def _label_seen(graph: FactorGraph, variable: Variable) -> str:
    """What was observed: `=label`; doors as a row of ones (open) and zeros."""
    if variable.name not in graph.evidence and variable.cardinality > 1:
        return ""
    label = graph.evidence.get(variable.name, variable.domain[0])
    if isinstance(label, tuple) and label and all(isinstance(part, bool) for part in label):  # pyright: ignore[reportUnknownVariableType]
        return "".join("1" if part else "0" for part in label)
    return f"={label}"


def _draw_factor(ax: Axes, factor: Factor, point: Point, ends: Sequence[Point], theme: Theme, *, in_time: bool) -> None:
    from matplotlib.patches import Rectangle

    x, y = point
    ax.add_artist(Rectangle((x - HALF, y - HALF), 2 * HALF, 2 * HALF, facecolor=theme.ink, edgecolor="none", zorder=2))
    (right, up), ha, va = _free_side(point, ends)
    name, bracket, action = factor.name.partition("[")
    text = f"{name}\n{action.rstrip(']')}" if bracket else name
    width = (0.19 if right else 0.3 if len(ends) == 1 else 0.6) if in_time else (0.4 if right else 0.6)
    at = (x + right * (HALF + 0.03), y + up * (HALF + 0.02))
    style: dict[str, Any] = {"largest": 9.0, "color": theme.ink, "ha": ha, "va": va, "zorder": 3}
    write_in(ax, *at, text, box=(width, 0.32 if bracket else 0.17), **style)


def _free_side(point: Point, ends: Sequence[Point]) -> tuple[Point, str, str]:
    """The first side of a factor that is clear of its lines, or the clearest one; to the left if it leans there."""
    sides = (*_SIDES[:2], *_SIDES[:1:-1]) if ends[0][0] < ends[-1][0] - 0.01 else _SIDES
    angles = [np.arctan2(y - point[1], x - point[0]) for x, y in ends]
    clear = [min(_degrees_between(angle, np.arctan2(up, right)) for angle in angles) for (right, up), _, _ in sides]
    best = next((i for i, degrees in enumerate(clear) if degrees >= CLEAR), int(np.argmax(clear)))
    return sides[best]


def _degrees_between(one: float, other: float) -> float:
    apart = abs(np.degrees(one - other)) % 360.0
    return float(min(apart, 360.0 - apart))


def _draw_times(ax: Axes, columns: Mapping[int, float], y: float, cut: bool, theme: Theme) -> None:
    for time, x in columns.items():
        text = f"… t = {time}" if cut and time == min(columns) else f"t = {time}"
        write_in(ax, x, y, text, box=(0.8, 0.2), largest=11.0, color=theme.ink)
