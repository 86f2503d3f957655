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
    equation = "c where the step does not stay"
    meaning = "the way there"
    cost: float = 1.0

    def gain(self, rollout: Rollout) -> Floats:
        moved = np.where(rollout.staying, 0.0, self.cost)
        moved[0] = 0.0  # of the empty prefix
        return moved

    def plain(self, step: Step) -> float:
        return self.cost * (step.action != step.model.motions.stay)
