"""What the way to somewhere costs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .base import Term
from .plain import Step
from .rolled import Floats, Rollout


@dataclass(frozen=True, slots=True)
class WayThere(Term):
    """Each step that does not stay, while anything is unknown.

    Attributes:
        cost: of a step, in nats.
    """

    name = "way_there"
    label = "way there"
    sign = 1.0
    kind = "cost"
    colour = "#d55e00"
    equation = "c where the step does not stay; of the first step what it costs here"
    meaning = "the way there"
    cost: float = 1.0

    def gain(self, rollout: Rollout) -> Floats:
        moved = np.where(rollout.staying, 0.0, self.cost)
        moved[0] = 0.0  # of the empty prefix
        if rollout.model.prices is not None and rollout.levels:
            begin, end = rollout.levels[0]
            moved[begin:end] *= rollout.model.prices[rollout.action[begin:end]]
        return moved

    def plain(self, step: Step) -> float:
        prices = step.model.prices if len(step.path) == 1 else None
        return self.cost * (step.action != step.model.motions.stay) * (1.0 if prices is None else prices[step.action])
