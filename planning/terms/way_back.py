"""What it spares to have been somewhere already, when all else is left to see."""

from dataclasses import dataclass

import numpy as np

from ..local import LocalModel
from .base import Term
from .plain import Step
from .rolled import Floats, Rollout


@dataclass(frozen=True, slots=True)
class WayBack(Term):
    """The way back to an unvisited place from the other unvisited places, if it is entered now."""

    name = "way_back"
    label = "way back"
    sign = -1.0
    kind = "cost"
    colour = "#0072b2"
    equation = "c E_g |x_f - x_g| / l where the step first enters an option's end f"
    meaning = "the way back later that it spares"
    cost: float = 0.5  # of a step of that way, in nats

    def gain(self, rollout: Rollout) -> Floats:
        at = rollout.belief.argmax(axis=1)
        fresh = at != at[rollout.parent]
        return self.cost * fresh * spared(rollout.model)[at]

    def plain(self, step: Step) -> float:
        before, after = (max(range(len(Q)), key=Q.__getitem__) for Q in (step.before, step.after))
        return self.cost * float(spared(step.model)[after]) if after != before else 0.0


def spared(model: LocalModel) -> Floats:
    """`[R]` steps from each end of an option to what else is left; 0 of other places."""
    back = {} if model.frontier is None else model.frontier.back
    return np.array([back.get(place, 0.0) for place in model.places.tolist()])
