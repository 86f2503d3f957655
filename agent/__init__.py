"""The loop that joins model, inference and planning: perceive, plan, act."""

from __future__ import annotations

from .agent import Agent
from .settings import Settings
from .state import GivenPreferences
from .storage import read_header
from .trace import StepRecord

__all__ = ["Agent", "GivenPreferences", "Settings", "StepRecord", "read_header"]
