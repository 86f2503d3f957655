"""What the way to somewhere costs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .base import Term
from .plain import Step
from .rolled import Floats, Rollout


@dataclass(frozen=True, slots=True)
class WayThere(Term):
    """Each step that does not stay, or its length where ways are measured in metres, while anything is unknown.

    Attributes:
        cost: of a step, in nats.
    """

    name = "way_there"
    label = "way there"
    sign = 1.0
    kind = "cost"
    colour = "#d55e00"
    equation = "c |step| where the step does not stay"
    meaning = "the way there"
    cost: float = 1.0

    def gain(self, rollout: Rollout) -> Floats:
        moved = np.where(rollout.staying, 0.0, self.cost)
        moved[0] = 0.0  # of the empty prefix
        costs = rollout.model.frontier.costs if rollout.model.frontier is not None else {}
        if costs:
            before = rollout.model.places[rollout.belief.argmax(axis=1)[rollout.parent]].tolist()
            moved *= [costs.get(way, 1.0) for way in zip(before, rollout.action.tolist(), strict=True)]
        return moved

    def plain(self, step: Step) -> float:
        before = int(step.model.places[max(range(len(step.before)), key=step.before.__getitem__)])
        costs = step.model.frontier.costs if step.model.frontier is not None else {}
        return self.cost * (step.action != step.model.motions.stay) * costs.get((before, step.action), 1.0)
