"""What follows from evidence: exact posteriors of factor graphs, their evidence and free energy."""

from __future__ import annotations

from .compiled import CompiledGraph, compile_graph
from .errors import ImpossibleEvidence
from .exact import ENGINES
from .free_energy import FreeEnergy, free_energy, free_energy_of
from .posterior import MostProbable, Posterior
from .query import infer, k_most_probable, log_product, marginal_map, most_probable

__all__ = [
    "ENGINES",
    "CompiledGraph",
    "FreeEnergy",
    "ImpossibleEvidence",
    "MostProbable",
    "Posterior",
    "compile_graph",
    "free_energy",
    "free_energy_of",
    "infer",
    "k_most_probable",
    "log_product",
    "marginal_map",
    "most_probable",
]
