"""Habit alone: tabular Q-learning, an agent without a map."""

from collections.abc import Hashable, Mapping
from typing import Any

import numpy as np

from ..worlds import Motions
from .reckoning import Place, Reckoner


class HabitAgent:
    """Tabular Q-learning: it learns from reward which action pays in which place, and has no map.

    Watkins' Q-learning (1989): choosing to stay where the goal is seen pays 1, and all else nothing. Where it is it
    knows by dead reckoning from the start of the run, and it is told when a run starts: more than an agent with a map
    gets. Doors that are shut it does not try.

    Args:
        motions: the actions, such as `world.motions`.
        goal: what is seen where staying pays.
        rate: alpha, share of the error that one experience corrects.
        discount: gamma, worth of a reward one step later.
        explore: epsilon, probability of any open action instead of the best.
        seed: of the random choices.

    Attributes:
        explore: the same; it may be changed at any time.
    """

    def __init__(
        self,
        motions: Motions,
        *,
        goal: Hashable,
        rate: float = 0.5,
        discount: float = 0.9,
        explore: float = 0.1,
        seed: int | np.random.SeedSequence | None = None,
    ) -> None:
        self._motions, self._goal = motions, goal
        self._rate, self._discount, self.explore = rate, discount, explore
        self._rng = np.random.default_rng(seed)
        self._values: dict[tuple[Place, int], float] = {}
        self._last: tuple[Place, int, bool] | None = None
        self.restart()

    def restart(self) -> None:
        """Take note that a new run starts, from where the first one did."""
        self._reckoner = Reckoner(self._motions)
        self._last = None

    def value(self, place: Place, action: int) -> float:
        """Q(place, action): the return that it is used to; `place` is relative to the start."""
        return self._values.get((place, action), 0.0)

    def step(self, observation: Mapping[str, Any]) -> int:
        """The next action after `{"sight": label, "open": flag an action}`.

        Raises:
            WorldError: the observation lacks a part or has another number of actions.
        """
        before = None if self._last is None else self._last[1]
        ways = [action for action, free in enumerate(self._reckoner.sense(before, observation)) if free]
        place = self._reckoner.track.place
        values = np.array([self.value(place, action) for action in ways])
        self._learn(float(values.max()))
        best = np.flatnonzero(values == values.max()) if self._rng.random() >= self.explore else np.arange(len(ways))
        action = ways[int(self._rng.choice(best))]
        self._last = (place, action, action == self._reckoner.stay and observation["sight"] == self._goal)
        return action

    def _learn(self, ahead: float) -> None:
        """Correct the value of the last action, after which the best is worth `ahead`."""
        if self._last is None:
            return
        place, action, paid = self._last
        target = 1.0 if paid else self._discount * ahead  # what is paid ends the run as far as it can tell
        error = target - self.value(place, action)
        self._values[place, action] = self.value(place, action) + self._rate * error
