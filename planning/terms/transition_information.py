"""What visits and steps teach about B_s."""

from dataclasses import dataclass

import numpy as np

from .learned import Learned
from .plain import Step
from .rolled import Floats, Rollout


@dataclass(frozen=True, slots=True)
class TransitionInformation(Learned):
    """Information gain about B_s (eq. 8, learning).

    Where no look at a place tells whether a way is open, the first step along it does: H[open] nats, once in a rollout,
    times the probability that it is taken there.
    """

    name = "transition_information"
    label = "transition information"
    colour = "#009e73"
    table = "transition"
    equation = "sum_s C_s(t) - C_s(t-1), C_s = q_s I_s(v_s / q_s)"
    meaning = "information about transitions (B_s)"

    def gain(self, rollout: Rollout) -> Floats:
        learned, untried = Learned.gain(self, rollout), rollout.model.untried
        if untried is None:
            return learned
        place, action = np.nonzero(untried)
        told = rollout.tried(place, action) @ untried[place, action]
        return learned + told - told[rollout.parent]

    def plain(self, step: Step) -> float:
        learned, untried = Learned.plain(self, step), step.model.untried
        if untried is None:
            return learned
        more = {way: p - step.tried_before.get(way, 0.0) for way, p in step.tried.items()}
        return learned + sum(p * float(untried[way]) for way, p in more.items())
