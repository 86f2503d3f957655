"""What baselines that reckon where they are have in common."""

from abc import ABC, abstractmethod
from collections.abc import Hashable, Mapping, Sequence
from typing import Any

import numpy as np

from ..worlds import Motions
from .reckoning import Place, Reckoner


class Explorer(ABC):
    """An agent that knows where it is by dead reckoning, and can be sent to a sight.

    Args:
        motions: the actions, such as `world.motions`.
        seed: of its random choices.
    """

    def __init__(self, motions: Motions, *, seed: int | np.random.SeedSequence | None = None) -> None:
        self._reckoner = Reckoner(motions)
        self._rng = np.random.default_rng(seed)
        self._action: int | None = None
        self._wanted: frozenset[Hashable] = frozenset()

    @property
    def position(self) -> Place:
        """Where the agent takes itself to be, relative to its start."""
        return self._reckoner.track.place

    @property
    def visited(self) -> frozenset[Place]:
        """The places entered, relative to the start."""
        return frozenset(self._reckoner.track.sights)

    @property
    def edges(self) -> Mapping[tuple[Place, int], Place]:
        """Where each action leads from each place entered, relative to the start; a wall leads back."""
        return dict(self._reckoner.track.edges)

    def prefer(self, sights: Mapping[Any, float]) -> None:
        """Stay where the best of these sights is seen, those with the highest weight; explore if there are none."""
        self._wanted = frozenset(sight for sight, weight in sights.items() if weight == max(sights.values()))

    def step(self, observation: Mapping[str, Any]) -> int:
        """The next action after `{"sight": label, "open": flag an action}`.

        Raises:
            WorldError: the observation lacks a part or has another number of actions.
        """
        is_open = self._reckoner.sense(self._action, observation)
        there = observation["sight"] in self._wanted
        self._action = self._reckoner.stay if there else self._choose(is_open)
        return self._action

    @abstractmethod
    def _choose(self, is_open: Sequence[bool]) -> int:
        """The next action where nothing preferred is seen."""
