"""What follows from evidence: exact posteriors of factor graphs, their evidence and free energy."""

from __future__ import annotations

from .approximate import APPROXIMATIONS, Loopy, LoopyReport, Sampling, SamplingReport
from .compiled import CompiledGraph, compile_graph
from .errors import ImpossibleEvidence
from .exact import ENGINES
from .free_energy import FreeEnergy, free_energy, free_energy_of
from .learning import Fit, fit
from .posterior import MostProbable, Posterior
from .query import infer, k_most_probable, log_product, marginal_map, most_probable
from .stream import Stream

__all__ = [
    "APPROXIMATIONS",
    "ENGINES",
    "CompiledGraph",
    "Fit",
    "FreeEnergy",
    "ImpossibleEvidence",
    "Loopy",
    "LoopyReport",
    "MostProbable",
    "Posterior",
    "Sampling",
    "SamplingReport",
    "Stream",
    "compile_graph",
    "fit",
    "free_energy",
    "free_energy_of",
    "infer",
    "k_most_probable",
    "log_product",
    "marginal_map",
    "most_probable",
]
