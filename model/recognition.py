"""The rates under which places are recognised: conjugate priors, their counts, and what is expected of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import exp, lgamma, log


@dataclass(frozen=True, slots=True)
class RatePrior:
    """A rate that is learned: Beta(yes, no) before anything was counted.

    Its mean after counting is E = (yes + n_yes) / (yes + no + n_yes + n_no).
    """

    name: str
    yes: float
    no: float
    meaning: str


RATE_PRIORS = (
    RatePrior("open", 1.0, 1.0, "a way is open"),
    RatePrior("sight_misread", 0.5, 20.0, "a sight is read as another"),
    RatePrior("way_misread", 0.5, 20.0, "an open way is read as blocked, or a blocked one as open"),
    RatePrior("fails", 0.5, 20.0, "a move through an open way fails"),
    RatePrior("astray", 0.5, 20.0, "another action is carried out than the one given"),
    RatePrior("moved", 0.5, 500.0, "the agent is moved without a word"),
    RatePrior("elsewhere", 0.25, 4.0, "a way leads where the pose does not say"),
    RatePrior("undone", 20.0, 0.5, "the reverse of an action leads back"),
    RatePrior("changed", 0.5, 500.0, "a way opens or closes between two looks"),
    RatePrior("beside", 1.0, 1.0, "a way between places found beside each other is open"),
    RatePrior("new", 1.0, 1.0, "a way that was never walked leads to a place never seen (without poses)"),
)
"""Every rate, in the order of `RateCounts`."""

OPEN, SIGHT_MISREAD, WAY_MISREAD, FAILS, ASTRAY, MOVED, ELSEWHERE, UNDONE, CHANGED, BESIDE, NEW = range(len(RATE_PRIORS))

CONCENTRATIONS = (0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 1000.0)
"""Concentrations of the Chinese restaurant process that are weighed against each other, evenly before any place."""


class RateCounts:
    """How often each rate was found true or false; soft counts are posterior probabilities."""

    __slots__ = ("no", "yes")

    def __init__(self, yes: Sequence[float] | None = None, no: Sequence[float] | None = None) -> None:
        self.yes = list(yes) if yes is not None else [0.0] * len(RATE_PRIORS)
        self.no = list(no) if no is not None else [0.0] * len(RATE_PRIORS)

    def copy(self) -> RateCounts:
        """Counts of their own."""
        return RateCounts(self.yes, self.no)

    def mean(self, rate: int, priors: Sequence[RatePrior] = RATE_PRIORS) -> float:
        """Posterior mean of one rate."""
        prior = priors[rate]
        yes = prior.yes + max(self.yes[rate], 0.0)
        return yes / (yes + prior.no + max(self.no[rate], 0.0))

    def log_evidence(self, rate: int, priors: Sequence[RatePrior] = RATE_PRIORS) -> float:
        """log ∫ p^yes (1 - p)^no Beta(p) dp of what was counted of one rate."""
        prior = priors[rate]
        return log_beta_evidence(prior.yes, prior.no, self.yes[rate], self.no[rate])


def log_beta_evidence(a: float, b: float, yes: float, no: float) -> float:
    """log B(a + yes, b + no) - log B(a, b)."""
    before = lgamma(a) + lgamma(b) - lgamma(a + b)
    return lgamma(a + yes) + lgamma(b + no) - lgamma(a + b + yes + no) - before


@lru_cache(maxsize=1 << 16)
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
