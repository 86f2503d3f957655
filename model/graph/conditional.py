"""Conditionals whose values are learned: what a table must offer, and a plain Dirichlet table."""

from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from ..errors import CogmapError
from .factors import FloatArray


@runtime_checkable
class LearnableTable(Protocol):
    """A conditional probability table that learns: axes `[outcome, *parents]`."""

    def mean(self) -> FloatArray:
        """P(outcome | parents), `[outcome, *parents]`; columns over the outcome sum to 1."""
        ...

    def learn(self, expected_counts: FloatArray, rate: float = 1.0) -> None:
        """Add `rate * expected_counts`, `[outcome, *parents]`."""
        ...


class ConditionalTable:
    """Dirichlet counts of one conditional, `counts[outcome, *parents]`.

    Counts never fall below the prior, whatever the rate.

    Args:
        prior: prior concentrations, positive, `[outcome, *parents]`.

    Raises:
        CogmapError: a concentration is not finite and positive, or there is no outcome axis.
    """

    def __init__(self, prior: ArrayLike) -> None:
        self.prior: FloatArray = np.array(prior, dtype=float)
        if self.prior.ndim < 1 or self.prior.size == 0:
            raise CogmapError("conditional table: give prior counts with axes [outcome, *parents]")
        if not (np.isfinite(self.prior).all() and (self.prior > 0).all()):
            raise CogmapError("conditional table: prior counts must be finite and above 0")
        self.counts: FloatArray = self.prior.copy()

    def mean(self) -> FloatArray:
        """Expected P(outcome | parents) = counts / sum of counts over the outcome."""
        return self.counts / self.counts.sum(axis=0, keepdims=True)

    def learn(self, expected_counts: ArrayLike, rate: float = 1.0) -> None:
        """counts <- max(prior, counts + rate * expected_counts); a negative rate unlearns.

        Raises:
            CogmapError: the shape is not that of the table, or a number is not finite.
        """
        evidence = np.asarray(expected_counts, dtype=float)
        if evidence.shape != self.counts.shape:
            raise CogmapError(
                f"conditional table: expected counts have shape {evidence.shape}, the table {self.counts.shape}"
            )
        updated = self.counts + rate * evidence
        if not np.isfinite(updated).all():
            raise CogmapError("conditional table: expected counts and rate must be finite")
        self.counts = np.maximum(self.prior, updated)
