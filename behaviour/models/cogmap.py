"""Expected free energy on a cognitive map, and nothing else."""

from ..terms import Value
from .base import ChoiceModel

COGMAP = ChoiceModel("cogmap", (Value(),))
