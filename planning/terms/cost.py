"""What moves cost."""

from dataclasses import dataclass

import numpy as np

from ...model import CogmapError
from .base import Term
from .plain import Step
from .rolled import Floats, Rollout


@dataclass(frozen=True, slots=True)
class Cost(Term):
    """Expected cost of the actions, as observations have reported it so far (ours). It is not among `TERMS`.

    Raises:
        CogmapError: the price is negative, or not finite.
    """

    name = "cost"
    label = "cost"
    sign = 1.0
    kind = "cost"
    colour = "#8c564b"
    equation = "price E[cost | a_t]"
    meaning = "what its moves cost"
    price: float = 0.01  # nats that one unit of cost is worth

    def __post_init__(self) -> None:
        if not 0.0 <= self.price < np.inf:
            raise CogmapError(f"cost: price is {self.price}; give a finite number, 0 or more")

    def gain(self, rollout: Rollout) -> Floats:
        costs = rollout.model.costs
        return np.zeros(len(rollout.action)) if costs is None else self.price * costs[rollout.action]

    def plain(self, step: Step) -> float:
        costs = step.model.costs
        return 0.0 if costs is None else self.price * float(costs[step.action])
