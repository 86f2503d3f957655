"""Charts that close on themselves: positions in Z^n modulo a lattice of periods."""

from collections.abc import Sequence

from .motions import Position

Periods = tuple[Position, ...]
"""Rows in Hermite form: the first entry that is not zero of each is positive and further right than that before."""


def reduced(position: Sequence[int], periods: Periods) -> Position:
    """The one representative of a position modulo the periods."""
    x = list(position)
    for row in periods:
        pivot = _pivot(row)
        times = x[pivot] // row[pivot]
        if times:
            x = [a - times * b for a, b in zip(x, row, strict=True)]
    return tuple(x)


def with_period(periods: Periods, vector: Sequence[int]) -> Periods:
    """The lattice that `vector` is a period of as well (Euclid's algorithm on the rows)."""
    rows = [list(row) for row in periods] + [list(vector)]
    done: list[list[int]] = []
    for column in range(len(vector)):
        here = [row for row in rows if row[column]]
        rest = [row for row in rows if not row[column]]
        while len(here) > 1:
            here.sort(key=lambda row, c=column: abs(row[c]))
            least = here[0]
            others = [_minus(row, least, row[column] // least[column]) for row in here[1:]]
            rest += [row for row in others if not row[column]]
            here = [least, *(row for row in others if row[column])]
        if here:
            done.append(here[0] if here[0][column] > 0 else [-x for x in here[0]])
        rows = rest
    return tuple(tuple(row) for row in done)


def _minus(row: list[int], other: list[int], times: int) -> list[int]:
    return [a - times * b for a, b in zip(row, other, strict=True)]


def _pivot(row: Position) -> int:
    return next(column for column, x in enumerate(row) if x)
