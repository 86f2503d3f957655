"""P(moved_t): the agent was put into some visited place without being told."""

from collections.abc import Iterable

import numpy as np

from ..errors import CogmapError
from ..percept import Percept
from .base import Floats, Ints, ModelFactor, Support, Table


class Displacement(ModelFactor):
    """The prior of silent displacement: with a small probability the agent is in any visited place, uniformly.

    Args:
        probability: P(moved_t).

    Raises:
        CogmapError: it is no probability.
    """

    name = "displacement"

    def __init__(self, probability: float = 1e-4) -> None:
        if not 0.0 <= probability <= 1.0:
            raise CogmapError(f"displacement: {probability!r} is no probability; use a number from 0 to 1")
        self.probability = probability

    @property
    def options(self) -> dict[str, float]:
        return {"probability": self.probability}

    def prior(self, percept: Percept) -> float:
        """P(moved_t), or one where the agent is told that it was."""
        return 1.0 if percept.moved else self.probability

    def arrival(self, places: Ints) -> Floats:
        """`[n]` P(s_t | moved_t)."""
        visits = self.context.visits
        return visits.visited.values[places] / max(len(visits.order), 1)

    def tables(self, support: Support) -> Iterable[Table]:
        """P(moved_t): zero where the filter did not look, since it would have dropped all of it."""
        if support.before is not None:
            moved = self.prior(support.percept)
            p = np.array([1.0 - moved, moved * support.examined])
            yield Table("M", (f"moved{support.step}",), p, "displacement", "P(moved_t)")
