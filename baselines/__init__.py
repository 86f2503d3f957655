"""Whom the agent is compared with: nearest-frontier search, habit without a map, and the random walk."""

from __future__ import annotations

from .frontier import FrontierAgent
from .habit import HabitAgent
from .random_walk import RandomAgent

__all__ = ["FrontierAgent", "HabitAgent", "RandomAgent"]
