"""What sights would tell about the place."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .base import Term
from .plain import Step, entropy, predicted_sights
from .rolled import Floats, Rollout


@dataclass(frozen=True, slots=True)
class StateInformation(Term):
    """Mutual information of sight and place (eq. 5, and eq. 8, inference), over steps that do not stay.

    To stay is to look again at what was seen. The multiplicity of lumped sights cancels.
    """

    name = "state_information"
    label = "state information"
    sign = -1.0
    kind = "information"
    colour = "#0072b2"
    equation = "H[P_t] - sum_s Q_t(s) H[A[:, s]], P_t = A Q_t; 0 where the step stays"
    meaning = "information about where it is"

    def gain(self, rollout: Rollout) -> Floats:
        ambiguity = rollout.expected(_entropy(rollout.model.A.T))
        return ~rollout.staying * (_entropy(rollout.sights) - ambiguity)

    def plain(self, step: Step) -> float:
        model, Q = step.model, step.after
        if step.action == model.motions.stay:
            return 0.0
        ambiguity = sum(Q[s] * entropy(model, model.A[:, s].tolist()) for s in range(len(Q)))
        return entropy(model, predicted_sights(model, Q)) - ambiguity


def _entropy(mass: Floats) -> Floats:
    """`[n]` entropy of rows `mass [n, O]`."""
    return -np.einsum("no,no->n", mass, np.log(np.maximum(mass, np.finfo(np.float64).tiny)))
