"""Whom the agent is compared with: nearest-frontier search and the random walk."""

from __future__ import annotations

from .frontier import FrontierAgent
from .random_walk import RandomAgent

__all__ = ["FrontierAgent", "RandomAgent"]
