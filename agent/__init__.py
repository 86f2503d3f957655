"""The loop that joins model, inference and planning: perceive, infer, learn, grow, plan, act."""

from __future__ import annotations

from .agent import Agent
from .settings import Settings
from .storage import read_header
from .trace import StepRecord

__all__ = ["Agent", "Settings", "StepRecord", "read_header"]
