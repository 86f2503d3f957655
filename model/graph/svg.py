"""A factor graph drawn as SVG, laid out in time."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import permutations, product

from ..labels import shown
from ..markup import safe
from .factors import Factor
from .structure import GraphStructure
from .variables import Variable, shortened

Point = tuple[float, float]

MOST_DRAWN = 200
"""Nodes of the largest graph that is drawn: a larger one is a tangle."""

_STEP = (110.0, 72.0)  # between columns and rows, in pixels
_OFF = 34.0  # of every other row to the right
_RADIUS, _HALF, _MARGIN = 20.0, 6.0, 48.0
_FEW = 6  # names whose orders are all tried


def graph_svg(graph: GraphStructure) -> str | None:
    """The graph as SVG: circles are variables (observed ones grey), black squares are factors.

    Variables that have a time stand in a column a time step, in the row of their name; others fill columns of
    their own, before these. Every node tells more when it is pointed at.

    Returns:
        None for an empty graph and for one of more than `MOST_DRAWN` nodes.
    """
    if not 0 < len(graph.variables) + len(graph.factors) <= MOST_DRAWN:
        return None
    where = _variables(graph)
    factors = _factors(graph, where)
    lines = [
        _line(where[variable.name], factors[factor.label]) for factor in graph.factors for variable in factor.scope
    ]
    nodes = [_circle(graph, variable, where[variable.name]) for variable in graph.variables]
    squares = [_square(factor, factors[factor.label]) for factor in graph.factors]
    return _framed([*lines, *squares, *nodes], [*where.values(), *factors.values()])


def _variables(graph: GraphStructure) -> dict[str, Point]:
    """Column and row of each variable, in pixels."""
    cells: dict[str, tuple[int, int]] = {}
    untimed = [variable for variable in graph.variables if variable.time is None]
    height = max(4, round(len(untimed) ** 0.5))
    for at, variable in enumerate(untimed):
        cells[variable.name] = divmod(at, height)
    first = -(-len(untimed) // height)
    times = sorted({variable.time for variable in graph.variables if variable.time is not None})
    rows = _rows(graph)
    taken: set[tuple[int, int]] = set()
    for variable in graph.variables:
        if variable.time is not None:
            row = rows[_stem(variable)]
            column = first + times.index(variable.time)
            while (column, row) in taken:
                row += 1
            taken.add((column, row))
            cells[variable.name] = column, row
    # rows are set off in turn, so that a line from the first to the third misses the second
    return {name: (column * _STEP[0] + _OFF * (row % 2), row * _STEP[1]) for name, (column, row) in cells.items()}


def _rows(graph: GraphStructure) -> dict[str, int]:
    """The row of each name without its time; of a few names, those that share factors stand together."""
    stems = list(dict.fromkeys(_stem(variable) for variable in graph.variables if variable.time is not None))
    shared = Counter(frozenset(_stem(v) for v in factor.scope if v.time is not None) for factor in graph.factors)
    orders = permutations(stems) if len(stems) <= _FEW else [stems]

    def length(order: Sequence[str]) -> int:
        at = {stem: row for row, stem in enumerate(order)}
        spans = ((max(rows) - min(rows), many) for group, many in shared.items() if (rows := [at[s] for s in group]))
        return sum(many * span**2 for span, many in spans)

    best = min(orders, key=length)
    return {stem: row for row, stem in enumerate(best)}


def _stem(variable: Variable) -> str:
    """The name without its time."""
    return re.sub(rf"[_\[({{]*{variable.time}[\])}}]*$", "", variable.name) or variable.name


def _factors(graph: GraphStructure, where: Mapping[str, Point]) -> dict[str, Point]:
    """Each factor amid its variables, as near as there is room."""
    taken = [(point, _RADIUS + 2 * _HALF) for point in where.values()]
    points: dict[str, Point] = {}
    for factor in graph.factors:
        ends = [where[variable.name] for variable in factor.scope]
        x, y = (sum(end[axis] for end in ends) / len(ends) for axis in (0, 1))
        points[factor.label] = point = _free(x, y, taken)
        taken.append((point, 5 * _HALF))
    return points


def _free(x: float, y: float, taken: list[tuple[Point, float]]) -> Point:
    """The spot nearest to (x, y) that keeps its distance from all that is there."""
    spots = sorted(product(range(-14, 15), repeat=2), key=lambda spot: spot[0] ** 2 + spot[1] ** 2)
    for dx, dy in spots:
        at = x + 9.0 * dx, y + 9.0 * dy
        if all((at[0] - px) ** 2 + (at[1] - py) ** 2 >= distance**2 for (px, py), distance in taken):
            return at
    return x, y


def _line(start: Point, end: Point) -> str:
    return (
        f'<line x1="{start[0]:.1f}" y1="{start[1]:.1f}" x2="{end[0]:.1f}" y2="{end[1]:.1f}" '
        'stroke="#666" stroke-width="1"/>'
    )


def _circle(graph: GraphStructure, variable: Variable, at: Point) -> str:
    observed = graph.is_observed(variable)
    fill = "#d0d0d0" if observed else "white"
    tip = f"{variable.name} in {shortened(variable.domain)}" + (", observed" if observed else "")
    text = [_text(shown(variable.name, most=8), at[0], at[1] + 4)]
    if variable.name in graph.evidence or (variable.observed and variable.cardinality == 1):
        label = graph.evidence.get(variable.name, variable.domain[0])
        text.append(_text(f"= {shown(label, most=14)}", at[0], at[1] + _RADIUS + 11, size=9))
    circle = f'<circle cx="{at[0]:.1f}" cy="{at[1]:.1f}" r="{_RADIUS:g}" fill="{fill}" stroke="black"/>'
    return f"<g><title>{safe(tip)}</title>{circle}{''.join(text)}</g>"


def _square(factor: Factor, at: Point) -> str:
    tip = " ".join(part for part in (factor.label, factor.kind, factor.equation) if part)
    side = 2 * _HALF
    square = f'<rect x="{at[0] - _HALF:.1f}" y="{at[1] - _HALF:.1f}" width="{side:g}" height="{side:g}" fill="black"/>'
    name = _text(shown(factor.name, most=12), at[0] + _HALF + 3, at[1] - _HALF, size=9, anchor="start")
    return f"<g><title>{safe(tip)}</title>{square}{name}</g>"


def _text(text: str, x: float, y: float, *, size: int = 11, anchor: str = "middle") -> str:
    # a white rim keeps the letters apart from the lines behind them
    rim = 'paint-order="stroke" stroke="white" stroke-width="2"' if size < 11 else ""
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}" {rim}>{safe(text)}</text>'


def _framed(parts: list[str], points: list[Point]) -> str:
    left, top = (min(point[axis] for point in points) - _MARGIN for axis in (0, 1))
    width, height = (max(point[axis] for point in points) + _MARGIN - least for axis, least in ((0, left), (1, top)))
    box = f'viewBox="{left:.1f} {top:.1f} {width:.1f} {height:.1f}" width="{width:.0f}" height="{height:.0f}"'
    body = "\n".join(parts)
    return f'<svg xmlns="http://www.w3.org/2000/svg" {box} font-family="sans-serif">\n{body}\n</svg>\n'
