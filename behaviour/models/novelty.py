"""Places that were visited less draw more."""

from ..terms import Novelty
from .base import ChoiceModel

NOVELTY = ChoiceModel("novelty", (Novelty(),))
