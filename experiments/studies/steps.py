"""Steps until something happened, where some runs never got there: none is dropped, a mean of the others is marked.

A run that gave up after the cap would have needed more steps than that. Counted at the cap it makes the mean over all
runs a lower bound of the true one (the mean is censored).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .intervals import Interval, bootstrap
from .report import NONE, Value

MARK = "†"
"""Behind a mean over runs of which some did not get there."""
LEGEND = f"{MARK} lower bound: runs that gave up are counted at the cap"


@dataclass(frozen=True, slots=True)
class Steps:
    """What some runs come to.

    Attributes:
        values: by run, those that gave up at the cap.
        got: how many got there.
        mean: over those that got there; None where none did.
        std: standard deviation (population) of the same.
        bound: mean over all runs, those that gave up at the cap, and its interval; the mean itself if all got there.
    """

    values: tuple[int, ...]
    got: int
    mean: float | None
    std: float | None
    bound: Interval

    @classmethod
    def of(cls, steps: Sequence[int | None], cap: int) -> Steps:
        """From steps by run, None for one that gave up after `cap`; one run or more."""
        there = [value for value in steps if value is not None]
        values = tuple(cap if value is None else value for value in steps)
        mean, std = (float(np.mean(there)), float(np.std(there))) if there else (None, None)
        bound = bootstrap(values) or Interval(0.0, 0.0, 0.0, len(values))  # a maze of one room takes no step
        return cls(values, len(there), mean, std, bound)

    @property
    def runs(self) -> int:
        """How many there are."""
        return len(self.values)

    @property
    def censored(self) -> bool:
        """Whether some did not get there."""
        return self.got < self.runs

    def over(self, other: Steps) -> Interval | None:
        """Total of these steps over that of the other's, run by run with the same seeds."""
        return bootstrap(self.values, other.values)

    def mean_text(self) -> str:
        """`14.7 ± 1.0`, or where some gave up `≥ 412.0† (360.0 ± 12.0 over 5 of 20)`."""
        own = f"{self.mean:.1f} ± {self.std:.1f}" if self.mean is not None else ""
        if not self.censored:
            return own
        few = f"{own} over " if own else ""
        return f"≥ {self.bound.value:.1f}{MARK} ({few}{self.got} of {self.runs})"

    def interval_text(self) -> str:
        """The 95 % interval of `bound`."""
        return f"{self.bound.low:.1f} to {self.bound.high:.1f}" + (MARK if self.censored else "")

    def count_text(self) -> str:
        """How many got there of how many."""
        return f"{self.got}/{self.runs}"

    def text(self) -> str:
        """Mean, interval and count in one cell."""
        own = self.mean_text() if self.censored else f"{self.mean_text()} ({self.count_text()})"
        return f"{own} [{self.bound.low:.1f}, {self.bound.high:.1f}]"

    def to_dict(self) -> dict[str, Value]:
        """The figures without the single runs, as plain JSON values."""
        return {
            "runs": self.runs,
            "got_there": self.got,
            "censored": self.censored,
            "mean": self.mean,
            "std": self.std,
            "bound": self.bound.value,
            "low": self.bound.low,
            "high": self.bound.high,
        }


def factor_text(ratio: Interval | None, *, censored: bool) -> str:
    """A ratio of means and its interval, marked as a lower bound where the upper mean is one."""
    if ratio is None:
        return NONE
    before, after = ("≥ ", MARK) if censored else ("", "")
    return f"{before}{ratio.value:.1f}{after} [{ratio.low:.1f}, {ratio.high:.1f}]"
