"""Whom the agent is compared with: clone-structured graphs, nearest-frontier search, habit alone, random walk."""

from __future__ import annotations

from .cscg import CscgAgent, CscgSettings
from .frontier import FrontierAgent
from .habit import HabitAgent
from .random_walk import RandomAgent

__all__ = ["CscgAgent", "CscgSettings", "FrontierAgent", "HabitAgent", "RandomAgent"]
