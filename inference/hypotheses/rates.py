"""The rates under which places are recognised: conjugate priors, their counts, and what is expected of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from math import exp, lgamma, log


@dataclass(frozen=True, slots=True)
class RatePrior:
    """A rate that is learned: a mixture of Beta distributions before anything was counted.

        P(rate) = Σ_k w_k Beta(yes_k, no_k),   P(k | counts) ∝ w_k B(yes_k + n_yes, no_k + n_no) / B(yes_k, no_k)

    Attributes:
        name: what it is called.
        meaning: what it is the rate of.
        parts: (w_k, yes_k, no_k); a second part lets a world be calm or not, as the counts will have it.
        priors: log w_k - log B(yes_k, no_k).
    """

    name: str
    meaning: str
    parts: tuple[tuple[float, float, float], ...]
    priors: tuple[float, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        logs = tuple(log(w) + lgamma(a + b) - lgamma(a) - lgamma(b) for w, a, b in self.parts)
        object.__setattr__(self, "priors", logs)

    def mean(self, yes: float, no: float) -> float:
        """E[rate | counts]."""
        if len(self.parts) == 1:
            _, a, b = self.parts[0]
            return (a + yes) / (a + b + yes + no)
        return sum(weight * mean for weight, mean in self.posterior(yes, no))

    def posterior(self, yes: float, no: float) -> tuple[tuple[float, float], ...]:
        """(P(part | counts), E[rate | part, counts]) of each part."""
        logs = self._logs(yes, no)
        weights = [exp(min(value - logs[0], 500.0)) for value in logs]
        total = sum(weights)
        means = ((a + yes) / (a + b + yes + no) for _, a, b in self.parts)
        return tuple((weight / total, mean) for weight, mean in zip(weights, means, strict=True))

    def log_evidence(self, yes: float, no: float) -> float:
        """log ∫ rate^yes (1 - rate)^no P(rate) d rate."""
        logs = self._logs(yes, no)
        if len(logs) == 1:
            return logs[0]
        most = max(logs)
        return most + log(sum([exp(value - most) for value in logs]))

    def _logs(self, yes: float, no: float) -> list[float]:
        return [
            lgamma(a + yes) + lgamma(b + no) - lgamma(a + b + yes + no) + prior
            for (_, a, b), prior in zip(self.parts, self.priors, strict=True)
        ]


def _beta(name: str, yes: float, no: float, meaning: str) -> RatePrior:
    return RatePrior(name, meaning, ((1.0, yes, no),))


CALM_OR_NOT = ((0.9, 0.5, 500.0), (0.09, 0.5, 20.0), (0.01, 0.5, 2.0))
"""It hardly ever happens, or else often enough, or else very often."""

LEFT_ALONE = ((0.98, 0.5, 500.0), (0.0199, 0.5, 20.0), (0.0001, 0.5, 2.0))
"""The same of what hardly any world does, and some do at every step."""

READ = ((0.9, 0.5, 500.0), (0.09, 0.5, 20.0), (0.01, 6.0, 14.0))
"""The same of a reading, which is right more often than not, or any map whatever would do, misread over and over."""

RATE_PRIORS = (
    _beta("open", 1.0, 1.0, "a way is open"),
    RatePrior("sight_misread", "a sight is read as another", READ),
    RatePrior("way_misread", "an open way is read as blocked, or a blocked one as open", READ),
    RatePrior("fails", "a move through an open way fails", CALM_OR_NOT),
    RatePrior("astray", "another action is carried out than the one given", CALM_OR_NOT),
    RatePrior("moved", "the agent is moved without a word", LEFT_ALONE),
    _beta("elsewhere", 0.25, 4.0, "a way leads where the pose does not say"),
    RatePrior("undone", "the reverse of an action leads back", ((0.98, 20.0, 0.5), (0.02, 0.5, 0.5))),
    _beta("changed", 0.5, 500.0, "a way opens or closes between two looks"),
    _beta("beside", 1.0, 1.0, "a way between places found beside each other is open"),
    _beta("new", 1.0, 1.0, "a way that was never walked leads to a place never seen (without poses)"),
    _beta(
        "relinked", 0.5, 24.5, "a way that was walked once leads elsewhere after all; by walks squared less for more"
    ),
    _beta("meeting", 0.5, 9.5, "one action leads from two places into one (where it is not known what undoes what)"),
    _beta("square", 0.5, 0.5, "two actions lead to the same place in either order (without poses)"),
    _beta("alike", 0.5, 1.5, "a way of a place never seen is as that of the place it was entered from"),
)
"""Every rate, in the order of `RateCounts`; behind them stand two rows of other counts."""

OPEN, SIGHT_MISREAD, WAY_MISREAD, FAILS, ASTRAY, MOVED, ELSEWHERE = range(7)
UNDONE, CHANGED, BESIDE, NEW, RELINKED, MEETING, SQUARE, ALIKE = range(7, len(RATE_PRIORS))

STAYED, BLAMED = len(RATE_PRIORS), len(RATE_PRIORS) + 1
"""Moves through open ways that did not lead on (and, as `no`, the share of other actions that would not have either,
summed over these moves); and the share of them that failed (as `yes`), as is expected."""

ROWS = len(RATE_PRIORS) + 2
"""Rows of counts."""

CONCENTRATIONS = (0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 1000.0)
"""Concentrations of the Chinese restaurant process that are weighed against each other, evenly before any place."""


SPLITS = tuple(k / 12.0 for k in range(13))
"""Shares of moves that did not lead on that are weighed."""

TRACE = 1e-6
"""Counts below this are what is left of others by rounding."""


class RateCounts:
    """How often each rate was found true or false; soft counts are posterior probabilities.

    Of a move that did not lead on nothing says whether it failed or another action was carried out. Such moves are
    counted apart, and with each of them all are shared out anew by what is known of both rates by then: shared out once
    as they happen, they would stay with the rate that was thought of first.
    """

    __slots__ = ("no", "yes")

    def __init__(self, yes: Sequence[float] | None = None, no: Sequence[float] | None = None) -> None:
        self.yes = list(yes) if yes is not None else [0.0] * ROWS
        self.no = list(no) if no is not None else [0.0] * ROWS

    def copy(self) -> RateCounts:
        """Counts of their own."""
        return RateCounts(self.yes, self.no)

    def mean(self, rate: int) -> float:
        """Posterior mean of one rate."""
        return _mean(rate, *self.of(rate))

    def of(self, rate: int) -> tuple[float, float]:
        """How often a rate was found true, and false."""
        yes, no = self.yes[rate], self.no[rate]
        if rate == FAILS:
            yes += self.yes[STAYED] * self.yes[BLAMED]
        elif rate == ASTRAY:
            yes += self.yes[STAYED] * (1.0 - self.yes[BLAMED])
            no += self.yes[STAYED] * self.yes[BLAMED]
        return max(yes, 0.0), max(no, 0.0)

    def blame(self) -> None:
        """Share out the moves that did not lead on, by what all of them, and all others, say of both rates.

            P(k of n failed) ∝ (n over k) s^(n - k) P(k fails, other moves) P(n - k astray, other moves)

        where s is the share of other actions that would not have led on. A few k stand for all.
        """
        n, fails, astray = self.yes[STAYED], RATE_PRIORS[FAILS], RATE_PRIORS[ASTRAY]
        if n < TRACE:
            return
        yes, no = (
            (max(self.yes[FAILS], 0.0), max(self.yes[ASTRAY], 0.0)),
            (max(self.no[FAILS], 0.0), max(self.no[ASTRAY], 0.0)),
        )
        other = log(self.no[STAYED] / n)
        logs = [
            (n - k) * other - lgamma(k + 1.0) - lgamma(n - k + 1.0)
            + fails.log_evidence(yes[0] + k, no[0]) + astray.log_evidence(yes[1] + n - k, no[1] + k)
            for k in (share * n for share in SPLITS)
        ]  # fmt: skip
        most = max(logs)
        weights = [exp(value - most) for value in logs]
        self.yes[BLAMED] = sum(share * w for share, w in zip(SPLITS, weights, strict=True)) / sum(weights)


@lru_cache(maxsize=1 << 12)
def _mean(rate: int, yes: float, no: float) -> float:
    """`RatePrior.mean` of one rate: hypotheses of one step have most counts in common."""
    return RATE_PRIORS[rate].mean(yes, no)


@lru_cache(maxsize=1 << 12)
def crp_evidence(kinds: int, places: int) -> float:
    """log Σ_α P(α) α^kinds Γ(α) / Γ(α + places): the part of a seating's probability that depends on α.

    With Σ_l lgamma(n_l) of the tables it is the Chinese restaurant process's log probability of the sights of
    `places` places, of which `kinds` differ.
    """
    logs = [kinds * log(a) + lgamma(a) - lgamma(a + places) for a in CONCENTRATIONS]
    most = max(logs)
    return most + log(sum(exp(value - most) for value in logs) / len(logs))


def crp_predictive(alike: int, kinds: int, places: int) -> float:
    """P(the next new place shows a sight that `alike` places show); of a sight never shown where `alike` is zero."""
    if alike:
        return alike * exp(crp_evidence(kinds, places + 1) - crp_evidence(kinds, places))
    return exp(crp_evidence(kinds + 1, places + 1) - crp_evidence(kinds, places))
