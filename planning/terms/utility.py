"""What is preferred."""

from dataclasses import dataclass

from .base import Term
from .plain import Step, predicted_sights
from .rolled import Floats, Rollout


@dataclass(frozen=True, slots=True)
class Utility(Term):
    """Expected log preference of sights and places (eq. 5)."""

    name = "utility"
    label = "utility"
    sign = -1.0
    kind = "preference"
    colour = "#56b4e9"
    equation = "sum_o P_t(o) log C[o] + sum_s Q_t(s) log C[s]"
    meaning = "utility"

    def gain(self, rollout: Rollout) -> Floats:
        return rollout.expected(rollout.model.utility)

    def plain(self, step: Step) -> float:
        model, Q = step.model, step.after
        sights = sum(mass * float(model.log_C[o]) for o, mass in enumerate(predicted_sights(model, Q)))
        return sights + sum(Q[s] * float(model.log_C_place[s]) for s in range(len(Q)))
