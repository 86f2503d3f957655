"""What staying for a long time is worth, in closed form."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def geometric(ratio: float, terms: Floats | float) -> Floats:
    """1 + ratio + ... of so many terms, ratio above 0, at most 1."""
    many = np.asarray(terms, dtype=np.float64)
    if ratio == 1.0:
        return many
    return np.expm1(many * np.log(ratio)) / np.expm1(np.log(ratio))


def staying_teaches(
    tables: Sequence[Floats], belief: Floats, visits: Floats, reached: Floats, *, steps: int, discount: float
) -> Floats:
    """Discounted information of `steps` more steps that stay, if staying leaves the belief as it is.

    With x_j = (visits + j belief) / reached it is sum_j discount^(j-1) sum_s reached (I_s(x_j) - I_s(x_{j-1})). I is
    piecewise linear, hence a sum of c_m min(x, m) over its knots m, and each of these grows by r = belief / reached a
    step until it is full: a geometric sum.

    Args:
        tables: `T` tables `[R, N + 1]` of information from 0..N visits, zero in column 0, constant beyond N.
        belief: `[n, R]` Q(s) while staying.
        visits: `[n, R]` expected visits so far.
        reached: `[n, R]` probability of any visit so far, at least `belief`.
        steps: how many, 0 or more.
        discount: weight of each step relative to the one before.

    Returns:
        `[T, n]` nats.
    """
    total = np.zeros((len(tables), len(belief)))
    row, place = np.nonzero(belief > 0.0)
    any_visit = reached[row, place]
    start, rate = visits[row, place] / any_visit, belief[row, place] / any_visit
    # a table that is not longer than another has no knots beyond its end
    for m in range(1, max(table.shape[1] for table in tables)):
        room = np.maximum(m - start, 0.0)
        whole = np.minimum(np.floor(room / rate), steps)
        rest = np.where(whole < steps, room - whole * rate, 0.0)
        grown = any_visit * (rate * geometric(discount, whole) + rest * discount**whole)
        for table, into in zip(tables, total, strict=True):
            if m < table.shape[1]:
                into += np.bincount(row, weights=grown * _bend(table, m)[place], minlength=len(belief))
    return total


def _bend(table: Floats, m: int) -> Floats:
    """`[R]` c_m: by how much the slope falls at knot `m`."""
    before = table[:, m] - table[:, m - 1]
    return before - (table[:, m + 1] - table[:, m]) if m + 1 < table.shape[1] else before
