"""All that the next steps of an agent depend on besides its map."""

from collections import deque
from collections.abc import Hashable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..inference import Belief
from ..model import CogmapError, Percept, Slice
from ..planning import Plan


@dataclass(frozen=True, slots=True)
class GivenPreferences:
    """Log preferences relative to all other labels, in nats, before `goal_weight`. Empty: the agent only explores."""

    sights: Mapping[Hashable, float] = field(default_factory=dict[Hashable, float])  # by label
    places: Mapping[int, float] = field(default_factory=dict[int, float])  # by number of the place in the map
    # by name of a sensor and label, of the others than the first
    sensors: Mapping[str, Mapping[Hashable, float]] = field(default_factory=dict[str, Mapping[Hashable, float]])

    def __bool__(self) -> bool:
        return bool(self.sights or self.places or self.sensors)


@dataclass(frozen=True, slots=True)
class Choice:
    """What cannot be worked out again of a choice: the preferences then in force, and how ties and draws fell."""

    preferences: GivenPreferences  # when it was made
    policy: tuple[int, ...]  # the action indices of the policy that was chosen

    def of(self, plan: Plan) -> Plan:
        """The plan with this choice. Raises CogmapError: the policy is not one of its."""
        if plan.policies.shape[1] == len(self.policy):
            found = np.flatnonzero((plan.policies == self.policy).all(axis=1))
            if len(found):
                return replace(plan, chosen=int(found[0]), action=self.policy[0])
        raise CogmapError("agent: its last plan does not come out the same with this version; call step(observation)")


@dataclass(slots=True)
class State:
    """One record of where an agent is in its life."""

    window: deque[Slice]  # the last steps as slices; as many as its length allows
    steps: int = 0  # observations taken in so far
    acted: bool = True  # whether it has answered the last of them
    action: int | None = None  # what it answered; None before the first
    # for each action whether its way was open at the last step, as far as is known; None before the first
    open: tuple[bool, ...] | None = None
    belief: Belief | None = None  # after the last observation
    preferences: GivenPreferences = field(default_factory=GivenPreferences)  # what it prefers now
    choice: Choice | None = None  # its last choice
    # what the last step brought; None before the first, and where an early version wrote the file
    percept: Percept | None = None
    begun: int = 0  # where the log of changes was when the present step began; 0 in a file, which has no log
    revised: bool = False  # whether it changed its mind at the present step: the map, or where it is in it
    told: bool = False  # it was told that it was moved, since the last step
    # by sensor, what was expected of it at the last step; None where nobody has asked yet
    expected: Mapping[str, Any] | None = None
    # by action, how often a move cost something, and how much in all
    costs: Mapping[int, tuple[int, float]] = field(default_factory=dict[int, tuple[int, float]])

    def spend(self, percept: Percept) -> None:
        """Count what a move has cost, where that was said."""
        if percept.cost is not None and percept.action is not None:
            times, total = self.costs.get(percept.action, (0, 0.0))
            self.costs = {**self.costs, percept.action: (times + 1, total + percept.cost)}

    def expected_costs(self, actions: int, *, stay: int) -> NDArray[np.float64] | None:
        """`[K]` the mean cost of each action so far, None where none was said.

        One of which none was said costs what all do on average, but for one that stays, which costs nothing.
        """
        times, total = (sum(parts) for parts in zip((0, 0.0), *self.costs.values(), strict=True))
        if not times:
            return None
        means = {stay: 0.0} | {action: spent / many for action, (many, spent) in self.costs.items()}
        return np.array([means.get(action, total / times) for action in range(actions)])

    def prices(self) -> NDArray[np.float64] | None:
        """`[K]` what each action is expected to cost from here, in usual moves; None where nobody says.

        A usual move is the mean of those so far, or else of those that are foreseen.
        """
        told = None if self.percept is None else self.percept.costs
        known = [cost for cost in told or () if cost]
        if told is None or not known:
            return None
        times, total = (sum(parts) for parts in zip((0, 0.0), *self.costs.values(), strict=True))
        usual = total / times if total else sum(known) / len(known)
        return np.array([1.0 if cost is None else cost / usual for cost in told])
