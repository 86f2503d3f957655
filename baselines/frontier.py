"""Nearest-frontier search (Yamauchi 1997, A frontier-based approach for autonomous exploration)."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from typing import Any

import numpy as np

from ..worlds import Motions
from .reckoning import Place, Reckoner, best


class FrontierAgent:
    """Goes by a shortest known way to the nearest place seen through a door but not entered.

    Draws are settled at random, alike for each pair of nearest place and first action towards it. Stays
    when there is nothing left to enter, or no open way to it. With a preference it goes to the nearest place where it
    has seen what it prefers, and stays; while it knows of none it explores.

    Args:
        motions: the actions, such as `world.motions`.
        seed: of the draws.
    """

    def __init__(self, motions: Motions, *, seed: int | np.random.SeedSequence | None = None) -> None:
        self._reckoner = Reckoner(motions)
        self._actions = range(len(motions.names))
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
        """Seek the best of these sights, those with the highest weight; explore if there are none."""
        self._wanted = best(sights)

    def step(self, observation: Mapping[str, Any]) -> int:
        """The next action after `{"sight": label, "open": flag an action}`.

        Raises:
            WorldError: the observation lacks a part or has another number of actions.
        """
        self._reckoner.sense(self._action, observation)
        ways = [] if observation["sight"] in self._wanted else self._ways()
        self._action = ways[int(self._rng.integers(len(ways)))][1] if ways else self._reckoner.stay
        return self._action

    def _ways(self) -> list[tuple[Place, int]]:
        sights = self._reckoner.track.sights
        to_goal = self._nearest(lambda place: sights.get(place) in self._wanted) if self._wanted else []
        return to_goal or self._nearest(lambda place: place not in sights)

    def _nearest(self, sought: Callable[[Place], bool]) -> list[tuple[Place, int]]:
        """Each nearest place that is sought with each first action on a shortest way to it."""
        track = self._reckoner.track
        level: dict[Place, set[int]] = {track.place: set()}
        seen = {track.place}
        while level:
            ahead: dict[Place, set[int]] = {}
            for place, firsts in level.items():
                for action in self._actions:
                    other = track.edges[place, action]
                    if other not in seen:
                        ahead.setdefault(other, set()).update(firsts or {action})
            ways = [(place, first) for place in ahead if sought(place) for first in ahead[place]]
            if ways:
                return sorted(ways)
            seen.update(ahead)
            level = {place: firsts for place, firsts in ahead.items() if place in track.sights}
        return []
