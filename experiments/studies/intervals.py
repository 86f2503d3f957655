"""How sure a mean is: bootstrap intervals (Efron 1979, Bootstrap methods: another look at the jackknife)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np

RESAMPLES = 2000
LEVEL = 0.95


@dataclass(frozen=True, slots=True)
class Interval:
    """A mean, or a ratio of totals, and the percentile bootstrap interval that holds it at `LEVEL`.

    Attributes:
        value: of the runs as they were.
        low: end of the interval.
        high: the other end.
        count: runs that it is from.
    """

    value: float
    low: float
    high: float
    count: int

    def to_dict(self) -> dict[str, float]:
        """The fields as plain JSON values."""
        return asdict(self)


def bootstrap(
    values: Sequence[float], over: Sequence[float] | None = None, *, seed: int = 0, resamples: int = RESAMPLES
) -> Interval | None:
    """The mean of `values`, or their total over the total of `over`, run by run; None where that is 0 or of nothing.

    Args:
        values: one a run.
        over: one a run; a resample in which all are 0 is left out.
        seed: of the resampling.
        resamples: drawn with replacement, each as large as `values`.
    """
    top = np.asarray(values, dtype=np.float64)
    bottom = np.ones_like(top) if over is None else np.asarray(over, dtype=np.float64)
    if not bottom.sum():
        return None
    drawn = np.random.default_rng(seed).integers(len(top), size=(resamples, len(top)))
    tops, bottoms = top[drawn].sum(axis=1), bottom[drawn].sum(axis=1)
    ratios = tops[bottoms > 0.0] / bottoms[bottoms > 0.0]
    low, high = np.quantile(ratios, [(1.0 - LEVEL) / 2.0, (1.0 + LEVEL) / 2.0])
    return Interval(float(top.sum() / bottom.sum()), float(low), float(high), len(top))
