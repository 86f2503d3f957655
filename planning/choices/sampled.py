"""A draw from P(policy)."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..local import LocalModel
from .base import TIE, Choice, Floats, Ints, Verdict, best_of


@dataclass(frozen=True, slots=True)
class Sampled(Choice):
    """Draws from P(policy) (eq. 6)."""

    name: ClassVar[str] = "sampled"
    how: ClassVar[str] = "drawn from P(policy)"
    by_lot: ClassVar[bool] = False

    def contenders(self, model: LocalModel, actions: Ints, G: Floats) -> Ints:
        return best_of(model, actions, G)

    def choose(self, model: LocalModel, actions: Ints, G: Floats, probability: Floats, rng: np.random.Generator) -> int:
        return int(rng.choice(len(G), p=probability))

    def passed_over(self, model: LocalModel, actions: Ints, G: Floats, chosen: int, policy: int) -> Verdict | None:
        worse = float(G[policy] - G[chosen])
        if worse > TIE:
            return None
        return Verdict("drawn", f"no worse ({worse:+.3f} nats), but the draw from P(policy) fell on another")
