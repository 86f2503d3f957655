"""Turn habits: Rosenberg's biased walk, by turns relative to the last move."""

from ..terms import Habit
from .base import ChoiceModel

HABIT = ChoiceModel("habit", (Habit(1),))
