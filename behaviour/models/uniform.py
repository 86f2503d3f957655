"""All ways alike."""

from __future__ import annotations

from .base import ChoiceModel

UNIFORM = ChoiceModel("uniform")
