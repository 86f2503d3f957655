"""What sensors would tell about the place."""

from dataclasses import dataclass
from math import log, prod, sqrt

import numpy as np

from ..local import LocalModel
from .base import Term
from .plain import Step, entropy, predicted_sights
from .rolled import Floats, Ints, Rollout


@dataclass(frozen=True, slots=True)
class StateInformation(Term):
    """Mutual information of what is sensed and the place (eq. 5, and eq. 8, inference), over steps that do not stay.

    To stay is to look again at what was seen. Of one sensor of labels it is exact; the multiplicity of lumped sights
    cancels. Of several sensors, and of ways, it is the bound of Kolchinsky and Tracey (Entropy 2017, 19, 361) from
    below, which multiplies over sensors: exact where any two places sense the same, or nothing alike.
    """

    name = "state_information"
    label = "state information"
    sign = -1.0
    kind = "information"
    colour = "#0072b2"
    equation = "H[P_t] - sum_s Q_t(s) H[A[:, s]], P_t = A Q_t; 0 where the step stays"
    meaning = "information about where it is"
    # whether what is sensed of ways counts while it is open where the agent is. (Of one that knows it says what
    # imagined ways would teach, which is told by another term.)
    ways: bool = True

    def gain(self, rollout: Rollout) -> Floats:
        model = rollout.model
        open_ = rollout.belief.max(axis=1) < 1.0  # of a sure place nothing is left to tell
        held = np.flatnonzero(rollout.belief[open_].any(axis=0))
        if not self._several(model):
            return ~rollout.staying * (_entropy(rollout.sights) - rollout.expected(_entropy(model.A.T)))
        told = np.zeros(len(open_))
        Q = rollout.belief[np.ix_(open_, held)]
        told[open_] = -np.einsum("ns,ns->n", Q, np.log(np.maximum(Q @ self._alike(model, held), 1e-300)))
        return ~rollout.staying * told

    def plain(self, step: Step) -> float:
        model, Q = step.model, step.after
        if step.action == model.motions.stay:
            return 0.0
        held = [s for s in range(len(Q)) if Q[s] > 0.0]
        if not self._several(model):
            ambiguity = sum(Q[s] * entropy(model, model.A[:, s].tolist()) for s in range(len(Q)))
            return entropy(model, predicted_sights(model, Q)) - ambiguity
        return -sum(Q[s] * log(sum(Q[r] * self._plain_alike(model, s, r) for r in held)) for s in held)

    def _several(self, model: LocalModel) -> bool:
        return bool(model.senses) or self._asks_ways(model)

    def _asks_ways(self, model: LocalModel) -> bool:
        return self.ways and model.looks and bool(model.belief.max() < 1.0)

    def _alike(self, model: LocalModel, held: Ints) -> Floats:
        """`[h, h]` the Bhattacharyya coefficient of what any two of these places would sense."""
        alike = np.ones((len(held), len(held)))
        ways = [np.stack([way, 1.0 - way]) for way in model.blocked[held].T] if self._asks_ways(model) else []
        for A in (model.A[:, held], *(A[:, held] for A in model.senses), *ways):
            root = np.sqrt(A)
            alike *= root.T @ root
        return alike

    def _plain_alike(self, model: LocalModel, s: int, r: int) -> float:
        alike = prod(sum(sqrt(p * q) for p, q in zip(A[:, s], A[:, r], strict=True)) for A in (model.A, *model.senses))
        if self._asks_ways(model):
            blocked = zip(model.blocked[s], model.blocked[r], strict=True)
            alike *= prod(sqrt(p * q) + sqrt((1.0 - p) * (1.0 - q)) for p, q in blocked)
        return float(alike)


def _entropy(mass: Floats) -> Floats:
    """`[n]` entropy of rows `mass [n, O]`."""
    return -np.einsum("no,no->n", mass, np.log(np.maximum(mass, np.finfo(np.float64).tiny)))
