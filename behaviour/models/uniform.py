"""All ways alike."""

from .base import ChoiceModel

UNIFORM = ChoiceModel("uniform")
