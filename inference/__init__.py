"""What follows from evidence: exact posteriors of factor graphs, their evidence and free energy."""

from __future__ import annotations

from .errors import ImpossibleEvidence
from .exact import ENGINES
from .free_energy import FreeEnergy, free_energy, free_energy_of
from .posterior import MostProbable, Posterior
from .query import infer, log_product, most_probable

__all__ = [
    "ENGINES",
    "FreeEnergy",
    "ImpossibleEvidence",
    "MostProbable",
    "Posterior",
    "free_energy",
    "free_energy_of",
    "infer",
    "log_product",
    "most_probable",
]
