"""What the way to somewhere costs."""

from dataclasses import dataclass

import numpy as np

from .base import Term
from .plain import Step
from .rolled import Floats, Rollout


@dataclass(frozen=True, slots=True)
class WayThere(Term):
    """Each step that does not stay, or its length where ways are measured in metres, while anything is unknown."""

    name = "way_there"
    label = "way there"
    sign = 1.0
    kind = "cost"
    colour = "#d55e00"
    equation = "c |step| where the step does not stay; of the first step what it costs here"
    meaning = "the way there"
    cost: float = 1.0  # of a step, in nats

    def gain(self, rollout: Rollout) -> Floats:
        moved = np.where(rollout.staying, 0.0, self.cost)
        moved[0] = 0.0  # of the empty prefix
        costs = rollout.model.frontier.costs if rollout.model.frontier is not None else {}
        if costs:
            before = rollout.model.places[rollout.belief.argmax(axis=1)[rollout.parent]].tolist()
            moved *= [costs.get(way, 1.0) for way in zip(before, rollout.action.tolist(), strict=True)]
        elif rollout.model.prices is not None and rollout.levels:
            begin, end = rollout.levels[0]
            moved[begin:end] *= rollout.model.prices[rollout.action[begin:end]]
        return moved

    def plain(self, step: Step) -> float:
        before = int(step.model.places[max(range(len(step.before)), key=step.before.__getitem__)])
        costs = step.model.frontier.costs if step.model.frontier is not None else {}
        prices = step.model.prices if len(step.path) == 1 and not costs else None
        price = costs.get((before, step.action), 1.0) if prices is None else float(prices[step.action])
        return self.cost * (step.action != step.model.motions.stay) * price
