"""Whether two ways that point at each other are one, or there is a place between them that nobody has seen."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .ways_between import ROUGH

Floats = NDArray[np.float64]

SAMPLE = 64  # ways that were walked, and places, that are looked at, spread evenly over all
FEW = 4  # ways walked before which nobody says that a place is hidden
BROAD = 2.0  # ways that the broad density of lengths counts for, beside those that were measured

SPREAD, SPREADS = 0.5, 4.0
"""Standard deviation of the logarithm of lengths before any was measured, and how many measurements it counts for."""

LEAST_WIDTH = 0.08  # of the kernel about the logarithm of a length
SHORT = 0.1  # mean lengths of a way that one counts for at least: some places have one position

MISS, MISS_HIDDEN = 0.06, 0.5
"""Probability that a way misses the place that it leads to, as far as whole degrees tell; and one beyond a third."""

LEAST_SPARED = 0.1  # steps that it spares to have looked for a place, at least, for each in vain
TINY = 1e-12  # A density that is never fallen short of
STRAIGHT, NOT = 0.5, 9.5  # beta counts of how often a way goes straight on in another at its end


class Hidden:
    """Log odds that a place nobody has entered lies on what may be one way between two that were.

    log odds = log P(straight on) + log P(length | two ways) - log P(length | one) + the same of how well they point

    Densities of the logarithm of a length are kernels on ways that were walked, and on sums of two.

    Args:
        lengths: `[n]` of some ways that were walked; what follows grows with its square.
        bearings: `[m, K]` degrees of the ways of some places that were entered, -1 of none.
        back: steps from one place to another, on average: what it costs to come back later.
    """

    def __init__(self, lengths: Floats, bearings: Floats, back: float) -> None:
        self._least = SHORT * float(lengths.mean()) if len(lengths) else 1.0
        lengths = np.maximum(lengths, self._least)
        self._one = np.log(lengths)
        self._two = np.log(np.add.outer(lengths, lengths)[np.triu_indices(len(lengths))])
        self._straight, alone = _straight(bearings)
        self._least_odds = -float(np.log(max(back * alone, LEAST_SPARED)))

    def likely(self, length: float, *, rough: bool | None) -> bool:
        """Whether it is worth to look for one.

        A step now spares a long way back later where the two ways are all that lead there.
        """
        return self.odds(length, rough=rough) > self._least_odds

    def odds(self, length: float, *, rough: bool | None) -> float:
        """Of one so long; `rough` if its ends point past each other by more than rounding does, None if unknown."""
        n = len(self._one)
        if n < FEW:
            return -np.inf
        spread = float(np.sqrt((self._one.var() * n + SPREADS * SPREAD**2) / (n + SPREADS)))
        log, width = float(np.log(max(length, self._least))), max(LEAST_WIDTH, spread / np.sqrt(n))
        one, two = (self._density(log, of, spread, width) for of in (self._one, self._two))
        points = 0.0
        if rough is not None:
            points = np.log(MISS_HIDDEN / MISS if rough else (1.0 - MISS_HIDDEN) / (1.0 - MISS))
        return float(np.log(self._straight * two / one) + points)

    def _density(self, log: float, of: Floats, spread: float, width: float) -> float:
        near = np.exp(-0.5 * np.square((log - of) / width)).mean() / width
        broad = np.exp(-0.5 * ((log - of.mean()) / spread) ** 2) / spread
        return float((len(self._one) * near + BROAD * broad) / (len(self._one) + BROAD)) + TINY


def evenly(rows: NDArray[Any]) -> NDArray[Any]:
    """At most `SAMPLE` of them."""
    return rows if len(rows) <= SAMPLE else rows[np.linspace(0, len(rows) - 1, SAMPLE).astype(np.int64)]


def _straight(bearings: Floats) -> tuple[float, float]:
    """How often a way has another of the same place opposite; and how often such a place has no others."""
    apart = np.abs((bearings[:, :, None] - bearings[:, None, :]) % 360.0 - 180.0)
    known = bearings >= 0.0
    opposite = ((apart <= ROUGH) & known[:, None, :]).any(axis=2) & known
    through = opposite.any(axis=1)
    alone = through & (known.sum(axis=1) == 2)
    often = (float(opposite.sum()) + STRAIGHT) / (float(known.sum()) + STRAIGHT + NOT)
    return often, (float(alone.sum()) + 0.5) / (float(through.sum()) + 4.0)
