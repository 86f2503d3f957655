"""The last choice of an agent, as a header of its file: what was hoped for, and the policy that was taken."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..model.errors import CogmapError
from ..model.labels import decode, encode
from ..planning import Plan


@dataclass(frozen=True, slots=True)
class Wishes:
    """Log preferences over all others, in nats (before `goal_weight`); none explores.

    Attributes:
        sights: by label.
        places: by number of the place in the map.
    """

    sights: Mapping[Hashable, float]
    places: Mapping[int, float]


@dataclass(frozen=True, slots=True)
class Choice:
    """What cannot be worked out again of a choice: the wishes then in force, and how ties and draws fell.

    Attributes:
        wishes: when it was made.
        policy: the action indices of the policy that was chosen.
    """

    wishes: Wishes
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


def choice_state(choice: Choice | None) -> dict[str, Any] | None:
    """The choice as plain JSON values."""
    if choice is None:
        return None
    return {
        "sights": [[encode(label), value] for label, value in choice.wishes.sights.items()],
        "places": [[int(place), value] for place, value in choice.wishes.places.items()],
        "policy": list(choice.policy),
    }


def restore_choice(header: Mapping[str, Any] | None) -> Choice | None:
    """The choice that `choice_state` took apart.

    Raises:
        KeyError, TypeError, ValueError: a part is missing or of a wrong kind.
    """
    if header is None:
        return None
    sights = {decode(label): float(value) for label, value in header["sights"]}
    places = {int(place): float(value) for place, value in header["places"]}
    return Choice(Wishes(sights, places), tuple(int(action) for action in header["policy"]))
