"""The risk of running into a wall."""

from dataclasses import dataclass

from .base import Term
from .plain import Step
from .rolled import Floats, Rollout


@dataclass(frozen=True, slots=True)
class Collision(Term):
    """Expected risk of collision (eq. 8)."""

    name = "collision"
    label = "collision"
    sign = 1.0
    kind = "cost"
    colour = "#d55e00"
    equation = "-log P(c = 1) sum_s Q_{t-1}(s) P(blocked | s, a_t)"
    meaning = "risk of collision"

    def gain(self, rollout: Rollout) -> Floats:
        model = rollout.model
        risk = rollout.expected(model.collision_cost * model.blocked)
        return risk[rollout.parent, rollout.action]

    def plain(self, step: Step) -> float:
        model, Q = step.model, step.before
        return model.collision_cost * sum(Q[s] * float(model.blocked[s, step.action]) for s in range(len(Q)))
