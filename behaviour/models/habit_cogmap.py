"""Habits and the map together: the whole model. Which terms it has was decided by held-out likelihood."""

from ..terms import Habit, Home, Value
from .base import ChoiceModel

HABIT_COGMAP = ChoiceModel("habit+cogmap", (Habit(3), Value(), Home()))
