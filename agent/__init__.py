"""The loop that joins model, inference and planning: perceive, plan, act."""

from .agent import Agent
from .following import Followed, follow
from .pomdp import Pomdp
from .settings import Settings
from .state import GivenPreferences
from .storage import read_header
from .trace import StepRecord
from .trace_table import trace_table
from .turning import TurningAgent

__all__ = [
    "Agent", "Followed", "GivenPreferences", "Pomdp", "Settings", "StepRecord", "TurningAgent", "follow", "read_header",
    "trace_table",
]  # fmt: skip
