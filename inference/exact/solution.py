"""What an engine leaves behind."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from ...model import Factor, FloatArray, IntArray


class Solution(Protocol):
    """It answers any joint over the variables of its graph."""

    @property
    def log_evidence(self) -> float:
        """log Z."""
        ...

    def joint(self, names: Sequence[str]) -> FloatArray:
        """P(names | evidence), one axis a name."""
        ...

    def entropy(self) -> float:
        """Entropy of the posterior over all variables, in nats."""
        ...

    def sample(self, count: int, rng: np.random.Generator) -> IntArray:
        """`[variables, count]` indices of labels, drawn from the posterior."""
        ...

    def standard_error(self, names: Sequence[str]) -> FloatArray:
        """Standard error of each entry of `joint`."""
        ...

    def entries(self, factor: Factor) -> tuple[IntArray, FloatArray] | None:
        """Of a large sparse factor the entries `[k, n]` that agree with the evidence, and P of each; else None."""
        ...
