"""Shares of counts, how sure they are, and how far apart two sets of them lie."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from math import sqrt

Z = 1.959963984540054
"""Of a two-sided interval of 95 %."""


@dataclass(frozen=True, slots=True)
class Share:
    """A count out of a number, and the interval of its share.

    Attributes:
        count: how many.
        of: out of how many.
        low: end of the 95 % interval of the share.
        high: the other end.
    """

    count: int
    of: int
    low: float
    high: float

    @property
    def share(self) -> float:
        """From 0 to 1; 0 out of none."""
        return self.count / self.of if self.of else 0.0

    def to_dict(self) -> dict[str, float]:
        """The fields and the share as plain JSON values."""
        return {**asdict(self), "share": self.share}


def wilson(count: int, of: int) -> Share:
    """The share with Wilson's interval (1927), from 0 to 1 out of none; it takes the single cases as independent."""
    if of == 0:
        return Share(count, of, 0.0, 1.0)
    p, squared = count / of, Z * Z / of
    middle = (p + squared / 2.0) / (1.0 + squared)
    half = Z / (1.0 + squared) * sqrt(p * (1.0 - p) / of + squared / (4.0 * of))
    # of none or all the end is exact, but for rounding
    return Share(count, of, max(0.0, min(p, middle - half)), min(1.0, max(p, middle + half)))


def total_variation(first: Sequence[int], second: Sequence[int]) -> float:
    """Half the sum of the differences of the shares, from 0 (equal) to 1; 1 if either has no counts."""
    of_first, of_second = sum(first), sum(second)
    if not (of_first and of_second):
        return 1.0
    return sum(abs(a / of_first - b / of_second) for a, b in zip(first, second, strict=True)) / 2.0
