"""Products and sums of tables without loss: plain numbers while every entry fits a float, logs where one might not.

A table is as large as its bounds say: no entry above 0 is below exp(low), none above exp(high). Bounds are added up
along a product, which costs nothing; only where they say that an entry might under- or overflow are the true ones
looked up, the table rescaled, and the product taken in logs if it must be.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...model import FloatArray, log_bounds

LIMIT = 600.0  # nats from 1 within which products are taken in plain numbers; a float reaches 708


class Table(NamedTuple):
    """A table, times exp(offset).

    Attributes:
        values: entries, or their logs.
        low: no entry above 0 has a smaller log.
        high: no entry has a larger log.
        offset: log of the factor to multiply by.
        logs: whether `values` are logs, with -inf for 0.
    """

    values: FloatArray
    low: float = 0.0
    high: float = 0.0
    offset: float = 0.0
    logs: bool = False

    def refined(self) -> Table:
        """The same with true bounds, scaled to a largest entry of 1, in plain numbers if these can hold it."""
        values, offset = self.values, self.offset
        if self.logs:
            finite = values[np.isfinite(values)]
            if not finite.size:
                return Table(np.zeros_like(values))
            high = float(finite.max())
            low, values = float(finite.min()) - high, values - high
            if low < -LIMIT:
                return Table(values, low, 0.0, offset + high, True)
            return Table(np.exp(values), low, 0.0, offset + high)
        low, high = log_bounds(values)
        if high == -math.inf:
            return Table(values)
        if low - high < -LIMIT:
            return Table(in_logs(values) - high, low - high, 0.0, offset + high, True)
        # a subnormal scale would lose digits: the two halves do not
        half = math.exp(-high / 2)
        return Table(values * half * half, low - high, 0.0, offset + high)

    def log_values(self) -> FloatArray:
        """Logs of the entries, without the offset."""
        return self.values if self.logs else in_logs(self.values)

    def holding(self, values: FloatArray) -> Table:
        """The same bounds for other values, which are among these."""
        return Table(values, self.low, self.high, self.offset, self.logs)


def in_logs(values: FloatArray) -> FloatArray:
    """log of the entries, -inf for 0."""
    with np.errstate(divide="ignore"):
        return np.log(values)


def times(one: Table, other: Table) -> Table:
    """The product, broadcast."""
    low, high = one.low + other.low, one.high + other.high
    if one.logs or other.logs or low < -LIMIT or high > LIMIT:
        one, other = one.refined(), other.refined()
        low, high = one.low + other.low, one.high + other.high
        if one.logs or other.logs or low < -LIMIT:
            return Table(one.log_values() + other.log_values(), low, high, one.offset + other.offset, True)
    return Table(one.values * other.values, low, high, one.offset + other.offset)


def product(tables: Sequence[Table], shape: tuple[int, ...]) -> Table:
    """The product of tables that broadcast to `shape`."""
    if not tables:
        return Table(np.ones(shape))
    result = tables[0]
    for table in tables[1:]:
        result = times(result, table)
    if result.values.shape != shape:
        result = result.holding(np.broadcast_to(result.values, shape))
    return result


def eliminated(table: Table, *, maximum: bool = False) -> tuple[FloatArray, FloatArray, Table]:
    """Sum (or maximise) over the first axis.

    Returns:
        `over`, `by` and the message: over / by is P(x | rest), with the columns' own scale; the message is the sum.
    """
    reduce_ = np.maximum.reduce if maximum else np.add.reduce
    if not table.logs and table.high + math.log(len(table.values)) > LIMIT:
        table = table.refined()
    values, low, high, offset, logs = table
    if not logs:
        summed = np.asarray(reduce_(values, axis=0))
        grown = high if maximum else high + math.log(len(values))
        return values, summed, Table(summed, low, grown, offset)
    top = np.asarray(np.maximum.reduce(values, axis=0))
    top = np.where(np.isfinite(top), top, 0.0)
    over = np.exp(values - top)
    by = np.asarray(reduce_(over, axis=0))
    message = Table(in_logs(by) + top, low, high + math.log(len(values)), offset, True)
    return over, by, message
