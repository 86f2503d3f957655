"""The agents that can be sent through a maze, by name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Protocol

import numpy as np

from ..agent import Agent, Settings
from ..baselines import FrontierAgent, RandomAgent
from ..model.errors import CogmapError
from ..worlds import GRID, Maze

AGENTS = ("cogmap", "frontier", "random")


class Walker(Protocol):
    """Whatever answers an observation with an action."""

    def step(self, observation: Mapping[str, Any]) -> int:
        """The next action."""
        ...


def check_agent(name: str) -> None:
    """Refuse an unknown agent.

    Raises:
        CogmapError: no agent has this name.
    """
    if name not in AGENTS:
        raise CogmapError(f"no agent is called {name!r}; choose one of {', '.join(AGENTS)}")


def make_walker(name: str, *, settings: Settings, seed: np.random.SeedSequence) -> Walker:
    """A new agent; `settings` matter to `cogmap` only.

    Raises:
        CogmapError: no agent has this name.
    """
    check_agent(name)
    if name == "frontier":
        return FrontierAgent(GRID, seed=seed)
    if name == "random":
        return RandomAgent(GRID, seed=seed)
    return Agent(GRID, settings=settings, seed=int(seed.generate_state(1)[0]))


def fitted(settings: Settings, maze: Maze) -> Settings:
    """The settings, with the number of rooms where static growth needs it and it was not given."""
    if settings.growth == "static" and settings.places is None:
        return replace(settings, places=len(maze.rooms))
    return settings
