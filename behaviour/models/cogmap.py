"""Expected free energy on a cognitive map, and nothing else."""

from __future__ import annotations

from ..terms import Value
from .base import ChoiceModel

COGMAP = ChoiceModel("cogmap", (Value(),))
