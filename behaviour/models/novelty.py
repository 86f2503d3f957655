"""Places that were visited less draw more."""

from __future__ import annotations

from ..terms import Novelty
from .base import ChoiceModel

NOVELTY = ChoiceModel("novelty", (Novelty(),))
