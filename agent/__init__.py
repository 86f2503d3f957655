"""The loop that joins model, inference and planning: perceive, plan, act."""

from __future__ import annotations

from .agent import Agent
from .following import Followed, follow
from .settings import Settings
from .state import GivenPreferences
from .storage import read_header
from .trace import StepRecord

__all__ = ["Agent", "Followed", "GivenPreferences", "Settings", "StepRecord", "follow", "read_header"]
