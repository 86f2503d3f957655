"""The agents that can be sent through a maze, by name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Protocol

import numpy as np

from ..agent import Agent, Settings
from ..baselines import CscgAgent, CscgSettings, FrontierAgent, RandomAgent
from ..model.errors import CogmapError
from ..worlds import GRID, Maze, Position

CSCG = {
    "cscg": (False, "viterbi"),
    "cscg_pose": (True, "viterbi"),
    "cscg_random": (False, "random"),
    "cscg_pose_random": (True, "random"),
}
"""The four variants of the paper: whether it is given its position, and how it moves."""

AGENTS = ("cogmap", "frontier", "random", *CSCG)


class Walker(Protocol):
    """Whatever answers an observation with an action."""

    def step(self, observation: Mapping[str, Any]) -> int:
        """The next action."""
        ...


class Seeker(Walker, Protocol):
    """A walker that can be sent to a sight."""

    def prefer(self, sights: Mapping[Any, float]) -> None:
        """Prefer these sights from now on, by log preferences; it stays where it believes to see the best."""
        ...


def check_agent(name: str) -> None:
    """Refuse an unknown agent.

    Raises:
        CogmapError: no agent has this name.
    """
    if name not in AGENTS:
        raise CogmapError(f"no agent is called {name!r}; choose one of {', '.join(AGENTS)}")


def make_walker(
    name: str,
    maze: Maze,
    *,
    seed: np.random.SeedSequence,
    settings: Settings | None = None,
    cscg: CscgSettings | None = None,
) -> Seeker:
    """A new agent that knows of the maze only what its kind must be told.

    Args:
        name: one of `AGENTS`.
        maze: gives the number of rooms to static growth, and the number of sights (or rooms, if it is given
            positions) to a clone-structured graph.
        seed: of the agent.
        settings: of `cogmap`.
        cscg: of the clone-structured graphs.

    Raises:
        CogmapError: no agent has this name.
    """
    check_agent(name)
    if name == "frontier":
        return FrontierAgent(GRID, seed=seed)
    if name == "random":
        return RandomAgent(GRID, seed=seed)
    if name in CSCG:
        positions, navigation = CSCG[name]
        observations = len(maze.rooms) if positions else len(set(maze.sights.values()))
        return CscgAgent(
            GRID, observations=observations, positions=positions, navigation=navigation, settings=cscg, seed=seed
        )
    return Agent(GRID, settings=fitted(settings or Settings(), maze), seed=int(seed.generate_state(1)[0]))


def sensed(walker: Walker, observation: Mapping[str, Any], position: Position) -> Mapping[str, Any]:
    """What the walker is given to see: its true position as well, if it is of the kind that is told."""
    if isinstance(walker, CscgAgent) and walker.positions:
        return {**observation, "position": position}
    return observation


def settings_of(
    agent: str, maze: Maze, settings: Settings | None = None, cscg: CscgSettings | None = None
) -> dict[str, Any]:
    """The settings that the agent goes by, as plain JSON values; none for a baseline that has none."""
    if agent == "cogmap":
        return fitted(settings or Settings(), maze).to_dict()
    return (cscg or CscgSettings()).to_dict() if agent in CSCG else {}


def fitted(settings: Settings, maze: Maze) -> Settings:
    """The settings, with the number of rooms where static growth needs it and it was not given."""
    if settings.growth == "static" and settings.places is None:
        return replace(settings, places=len(maze.rooms))
    return settings
