"""The factor graph of a window, laid out in time as partially observed Markov decision processes usually are."""

from collections.abc import Sequence
from typing import Any, Unpack

import numpy as np

from ..model import CogmapError, Factor, FactorGraph, Variable
from .axes import Axes, Where, axes_or_new, without_ticks, write_in
from .graph_layout import layout_of
from .layout import Point
from .theme import SKY, ink_on, mixed, theme_of

RADIUS = 0.17  # of a variable
HALF = 0.05  # of the side of a factor
INCHES = 1.15  # a unit is wide, in a new figure
WIDEST = 22.0  # inches of a new figure
CLEAR = 60.0  # degrees that a label keeps from the lines, if it can

_SIDES = ((0, -1), (0, 1), (1, 0), (-1, 0))  # of a factor where its label may stand: right and up


def plot_factor_graph(graph: FactorGraph, *, last: int | None = None, **where: Unpack[Where]) -> Axes:
    """Variables as circles, filled where they are observed, and factors as squares between them.

    Where variables have a time there is a column for each step, a row for each kind of latent variable, and the
    observations below with their labels. Variables that only take part in transitions, such as `moved`, stand between
    the columns. A graph without times is spread out by springs, always in the same way.

    Args:
        graph: an agent's `graph`, or any other.
        last: only the last steps, this many; factors that reach beyond are left out.

    Raises:
        CogmapError: the graph has no variables, or `last` is below 1.
    """
    from matplotlib.collections import LineCollection

    variables, factors, cut = _part(graph, last)
    layout = layout_of(graph, variables, factors)
    spots, in_time = layout.variables, bool(layout.columns)
    (low_x, high_x), (low_y, high_y) = (
        (min(part), max(part)) for part in zip(*spots.values(), *layout.factors.values(), strict=True)
    )
    limits = (low_x - 0.45, high_x + 0.45, low_y - (0.75 if in_time else 0.35), high_y + 0.4)
    width, height = limits[1] - limits[0], limits[3] - limits[2]
    inches = min(INCHES, WIDEST / max(width, height))
    ax = axes_or_new(size=(max(inches * width, 3.0), max(inches * height, 2.0) + 0.3), **where)
    without_ticks(ax, *limits)
    theme = theme_of(ax)
    lines = [[layout.factors[factor.label], spots[variable.name]] for factor in factors for variable in factor.scope]
    ax.add_collection(LineCollection(lines, colors=[theme.shade(0.55)], linewidths=1.0, zorder=1))
    for variable in variables:
        _draw_variable(ax, graph, variable, spots[variable.name], longest=0.44 if in_time else 0.8)
    for factor in factors:
        ends = [spots[variable.name] for variable in factor.scope]
        _draw_factor(ax, factor, layout.factors[factor.label], ends, in_time=in_time)
    for time, x in layout.columns.items():
        text = f"… t = {time}" if cut and time == min(layout.columns) else f"t = {time}"
        write_in(ax, x, limits[2] + 0.14, text, box=(0.8, 0.2), largest=11.0, color=theme.ink)
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
    if len(kept) < len(times):  # without those that the cut left nothing but a prior of their own
        widest, before = (
            {v.name: max((len(f.scope) for f in among if v in f.scope), default=0) for v in variables}
            for among in (factors, graph.factors)
        )
        variables = [v for v in variables if not widest[v.name] == 1 < before[v.name]] or variables
    return variables, _among(factors, variables), len(kept) < len(times)


def _among(factors: Sequence[Factor], variables: Sequence[Variable]) -> list[Factor]:
    names = {variable.name for variable in variables}
    return [factor for factor in factors if all(variable.name in names for variable in factor.scope)]


def _draw_variable(ax: Axes, graph: FactorGraph, variable: Variable, point: Point, *, longest: float) -> None:
    from matplotlib.patches import Ellipse

    theme, seen = theme_of(ax), graph.is_observed(variable)
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
    label: Any = graph.evidence.get(variable.name, variable.domain[0])
    if isinstance(label, tuple) and label and all(isinstance(part, bool) for part in label):
        return "".join("1" if part else "0" for part in label)
    return f"={label}"


def _draw_factor(ax: Axes, factor: Factor, point: Point, ends: Sequence[Point], *, in_time: bool) -> None:
    from matplotlib.patches import Rectangle

    (x, y), ink = point, theme_of(ax).ink
    ax.add_artist(Rectangle((x - HALF, y - HALF), 2 * HALF, 2 * HALF, facecolor=ink, edgecolor="none", zorder=2))
    right, up = _free_side(point, ends)
    name, bracket, action = factor.name.partition("[")
    text = f"{name}\n{action.rstrip(']')}" if bracket else name
    width = (0.19 if right else 0.3 if len(ends) == 1 else 0.6) if in_time else (0.4 if right else 0.6)
    at = (x + right * (HALF + 0.03), y + up * (HALF + 0.02))
    aligned = {"ha": ("center", "left", "right")[right], "va": ("center", "bottom", "top")[up]}
    write_in(ax, *at, text, box=(width, 0.32 if bracket else 0.17), largest=9.0, color=ink, zorder=3, **aligned)


def _free_side(point: Point, ends: Sequence[Point]) -> tuple[int, int]:
    """The first side of a factor that is clear of its lines, or the clearest one; to the left if it leans there."""
    sides = (*_SIDES[:2], *_SIDES[:1:-1]) if ends[0][0] < ends[-1][0] - 0.01 else _SIDES
    angles = np.degrees([np.arctan2(y - point[1], x - point[0]) for x, y in ends])
    apart = [np.abs(angles - np.degrees(np.arctan2(up, right))) % 360.0 for right, up in sides]
    clear = [float(np.minimum(degrees, 360.0 - degrees).min()) for degrees in apart]
    return sides[next((i for i, degrees in enumerate(clear) if degrees >= CLEAR), int(np.argmax(clear)))]
