"""What is sensed on the way would tell about the map as a whole."""

from dataclasses import dataclass

import numpy as np

from ...model import CogmapError
from ..local import Structure
from .base import Term
from .plain import Step
from .rolled import Floats, Rollout, Staying


@dataclass(frozen=True, slots=True)
class StructureInformation(Term):
    """Expected information about which hypothesis about the map is right.

    The hypotheses walk side by side, and what they expect to sense divides them into classes that only grow apart, so
    each difference counts once. To stay tells nothing. With one hypothesis it is 0.

    Raises:
        CogmapError: the weight is negative, or not finite.
    """

    name = "structure"
    label = "map structure"
    sign = -1.0
    kind = "information"
    colour = "#7a7a7a"
    equation = "w (H[classes of hypotheses, t] - H[classes of hypotheses, t-1])"
    meaning = "information about the map's structure"
    # how often a nat about the map counts: what is learned anywhere is worth little while it is open which
    # place that is
    weight: float = 10.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.weight < np.inf:
            raise CogmapError(f"structure: weight is {self.weight}; give a finite number, 0 or more")

    def gain(self, rollout: Rollout) -> Floats:
        structure = rollout.model.structure
        if structure is None:
            return np.zeros(len(rollout.parent))
        told = np.array(_told(structure, rollout))
        return self.weight * (told - told[rollout.parent])

    def staying(self, ends: Staying, steps: int) -> Floats:
        return np.zeros(len(ends.parent))

    def plain(self, step: Step) -> float:
        structure = step.model.structure
        if structure is None:
            return 0.0
        before = state = structure.start
        for action in step.path:
            before = state
            state = state if action == step.model.motions.stay else structure.walk(state, action)
        return self.weight * (structure.told(state[1]) - structure.told(before[1]))


def _told(structure: Structure, rollout: Rollout) -> list[float]:
    """`[N]` nats that are told up to the end of each prefix."""
    stay, states = rollout.model.motions.stay, [structure.start]
    for parent, action in zip(rollout.parent.tolist()[1:], rollout.action.tolist()[1:], strict=True):
        state = states[parent]
        states.append(state if action == stay else structure.walk(state, action))
    return [structure.told(classes) for _, classes in states]
