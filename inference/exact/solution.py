"""What an engine leaves behind."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from ...model import CogmapError, Factor, FloatArray, IntArray


class Solution(ABC):
    """It answers joints over the variables of its graph; whatever else an engine can, it overrides.

    Attributes:
        log_evidence: log Z.
        instead: what to do where it has no answer, for errors.
    """

    __slots__ = ()
    log_evidence: float
    instead: ClassVar[str] = "use an exact engine"

    @abstractmethod
    def joint(self, names: Sequence[str]) -> FloatArray:
        """P(names | evidence), one axis a name."""

    def standard_error(self, names: Sequence[str]) -> FloatArray:
        """Standard error of each entry of `joint`: 0, as it is exact."""
        return np.zeros_like(self.joint(names))

    def entries(self, factor: Factor) -> tuple[IntArray, FloatArray] | None:
        """Of a large sparse factor the entries `[k, n]` that agree with the evidence, and P of each; else None."""
        return None

    def entropy(self) -> float:
        """Entropy of the posterior over all variables, in nats."""
        raise CogmapError(f"posterior: the entropy of all variables is not known; {self.instead}")

    def sample(self, count: int, rng: np.random.Generator) -> IntArray:
        """`[variables, count]` indices of labels, drawn from the posterior."""
        raise CogmapError(f"posterior: there are no samples of all variables; {self.instead}")
