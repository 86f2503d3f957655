"""Turn habits that depend on the turn before."""

from ..terms import Habit
from .base import ChoiceModel

HABIT2 = ChoiceModel("habit2", (Habit(2),))
