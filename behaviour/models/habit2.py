"""Turn habits that depend on the turn before."""

from __future__ import annotations

from ..terms import Habit
from .base import ChoiceModel

HABIT2 = ChoiceModel("habit2", (Habit(2),))
