"""How sure a figure is: 95 % intervals of means, of ratios of totals, and of shares."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import stats

LEVEL = 0.95
RESAMPLES = 2000


@dataclass(frozen=True, slots=True)
class Interval:
    """A mean, or a ratio of totals, and its bootstrap interval."""

    value: float
    low: float  # end of the interval
    high: float  # the other end
    count: int  # runs that it is from


@dataclass(frozen=True, slots=True)
class Share:
    """A count out of a number, and Wilson's interval (1927) of its share."""

    count: int
    of: int
    low: float  # end of the interval
    high: float  # the other end
    share: float  # from 0 to 1; 0 out of none

    @property
    def value(self) -> float:
        """The share."""
        return self.share


def bootstrap(values: Sequence[float], over: Sequence[float] | None = None) -> Interval | None:
    """The mean of `values`, one a run, or their total over the total of `over`, with its percentile bootstrap interval.

    None of no runs, and where `over` adds up to 0; a resample in which it does is left out.
    """
    over = [1.0] * len(values) if over is None else over
    if not sum(over):
        return None
    value = float(sum(values) / sum(over))
    if len(values) == 1:  # scipy wants two
        return Interval(value, value, value, 1)
    how: dict[str, Any] = {"paired": True, "vectorized": True, "n_resamples": RESAMPLES, "method": "percentile"}
    with warnings.catch_warnings():  # of resamples that are left out
        warnings.simplefilter("ignore", stats.DegenerateDataWarning)
        drawn = stats.bootstrap((values, over), _ratio, rng=np.random.default_rng(0), **how).bootstrap_distribution
    low, high = np.nanquantile(drawn, [(1.0 - LEVEL) / 2.0, (1.0 + LEVEL) / 2.0])
    return Interval(value, float(low), float(high), len(values))


def wilson(count: int, of: int) -> Share:
    """The share of `count` out of `of`, single cases taken as independent; from 0 to 1 out of none."""
    if of == 0:
        return Share(count, of, 0.0, 1.0, 0.0)
    ends, share = stats.binomtest(count, of).proportion_ci(LEVEL, method="wilson"), count / of
    return Share(count, of, min(float(ends.low), share), max(float(ends.high), share), share)


def total_variation(first: Sequence[int], second: Sequence[int]) -> float:
    """Half the sum of the differences of the shares, from 0 (equal) to 1; 1 if either has no counts."""
    if not (sum(first) and sum(second)):
        return 1.0
    return sum(abs(a / sum(first) - b / sum(second)) for a, b in zip(first, second, strict=True)) / 2.0


def _ratio(values: NDArray[np.float64], over: NDArray[np.float64], axis: int = -1) -> NDArray[np.float64]:
    top, bottom = np.sum(values, axis, dtype=float), np.sum(over, axis, dtype=float)
    return np.divide(top, bottom, out=np.full_like(top, np.nan), where=bottom > 0.0)
