"""All that the next steps of an agent depend on besides its map."""

from __future__ import annotations

from collections import deque
from collections.abc import Hashable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from ..inference import Belief, Rivals
from ..model import STEPS, CogmapError, Percept, Slice
from ..planning import Plan


@dataclass(frozen=True, slots=True)
class GivenPreferences:
    """Log preferences over all others, in nats (before `goal_weight`); none explores.

    Attributes:
        sights: by label.
        places: by number of the place in the map.
    """

    sights: Mapping[Hashable, float] = field(default_factory=dict[Hashable, float])
    places: Mapping[int, float] = field(default_factory=dict[int, float])


@dataclass(frozen=True, slots=True)
class Choice:
    """What cannot be worked out again of a choice: the preferences then in force, and how ties and draws fell.

    Attributes:
        preferences: when it was made.
        policy: the action indices of the policy that was chosen.
    """

    preferences: GivenPreferences
    policy: tuple[int, ...]

    def of(self, plan: Plan) -> Plan:
        """The plan with this choice.

        Raises:
            CogmapError: the policy is not one of its.
        """
        if plan.policies.shape[1] == len(self.policy):
            found = np.flatnonzero((plan.policies == self.policy).all(axis=1))
            if len(found):
                return replace(plan, chosen=int(found[0]), action=self.policy[0])
        raise CogmapError("agent: its last plan does not come out the same with this version; call step(observation)")


@dataclass(frozen=True, slots=True)
class Moment:
    """A time step that can be taken back.

    Attributes:
        step: the time step.
        mark: of the log of changes, before anything was learned from it.
        visits: number of visited places then.
        percept: what it brought.
    """

    step: int
    mark: int
    visits: int
    percept: Percept


@dataclass(slots=True)
class State:
    """One record of where an agent is in its life.

    Attributes:
        rivals: of its belief.
        window: the last steps as slices; as many as its length allows.
        steps: observations taken in so far.
        acted: whether it has answered the last of them.
        action: what it answered; None before the first.
        open: for each action whether its way may be open by what the last step sensed; None where nothing was sensed.
        pending: steps that wait to be learned from.
        belief: after the last observation.
        preferences: what it prefers now.
        choice: its last choice.
        recent: the steps that can be taken back.
        begun: where the log of changes was when the present step began.
        retracted: the step since which it found at the present one to have been elsewhere; or None.
    """

    rivals: Rivals
    window: deque[Slice]
    steps: int = 0
    acted: bool = True
    action: int | None = None
    open: tuple[bool, ...] | None = None
    pending: int = 0
    belief: Belief | None = None
    preferences: GivenPreferences = field(default_factory=GivenPreferences)
    choice: Choice | None = None
    recent: deque[Moment] = field(default_factory=lambda: deque[Moment](maxlen=STEPS))
    begun: int = 0
    retracted: int | None = None
