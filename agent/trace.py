"""What happened at every step, light enough to keep."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass

from ..model.growth_event import GrowthEvent
from ..model.updates import ParameterUpdate
from ..planning import Term


@dataclass(frozen=True, slots=True)
class StepRecord:
    """One step of the agent.

    Attributes:
        step: the time step, from 0.
        sight: label of what was seen.
        open: for each action, whether its way was sensed open.
        places: Q(s_t), the most probable first.
        certainty: the first of them.
        doubt: probability that the belief went astray at an earlier step.
        certain: whether learning and growth went on.
        moved: P(moved_t).
        dropped: posterior mass left out, at most.
        evidence: log P(o_t, c_t | the past), in nats.
        complexity: first part of F, in nats.
        accuracy: second part of F, in nats.
        grown: what was added to the model.
        learned: which counts changed.
        policy: the chosen policy, by action index.
        probability: its P(policy).
        G: its expected free energy, term by term, and their sum under `G`, in nats.
        terms: what G is the sum of.
        policies: how many policies were considered.
        action: the action taken.
        retracted: the step since which it found to have been elsewhere, taking back what it had learned; or None.
    """

    step: int
    sight: Hashable
    open: tuple[bool, ...]
    places: dict[int, float]
    certainty: float
    doubt: float
    certain: bool
    moved: float
    dropped: float
    evidence: float
    complexity: float
    accuracy: float
    grown: tuple[GrowthEvent, ...]
    learned: tuple[ParameterUpdate, ...]
    policy: tuple[int, ...]
    probability: float
    G: dict[str, float]
    terms: tuple[Term, ...]
    policies: int
    action: int
    retracted: int | None = None

    @property
    def free_energy(self) -> float:
        """F = complexity - accuracy (eq. 3), in nats."""
        return self.complexity - self.accuracy
