"""The random walk."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from typing import Any

import numpy as np

from ..worlds import Motions
from .reckoning import Place, Reckoner, best


class RandomAgent:
    """Takes any open way but `stay`, uniformly; stays where there is none, or where it sees what it prefers.

    Args:
        motions: the actions, such as `world.motions`.
        seed: of the random choices.
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
        """Stay where the best of these sights is seen, those with the highest weight; nothing is preferred if empty."""
        self._wanted = best(sights)

    def step(self, observation: Mapping[str, Any]) -> int:
        """The next action after `{"sight": label, "open": flag an action}`.

        Raises:
            WorldError: the observation lacks a part or has another number of actions.
        """
        is_open = self._reckoner.sense(self._action, observation)
        if observation["sight"] in self._wanted:
            self._action = self._reckoner.stay
            return self._action
        ways = [action for action, free in enumerate(is_open) if free and action != self._reckoner.stay]
        self._action = ways[int(self._rng.integers(len(ways)))] if ways else self._reckoner.stay
        return self._action
