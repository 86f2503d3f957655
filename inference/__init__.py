"""What follows from evidence: beliefs step by step, exact posteriors of factor graphs, their evidence, free energy."""

from __future__ import annotations

from .approximate import APPROXIMATIONS, Loopy, LoopyReport, Sampling, SamplingReport
from .compiled import CompiledGraph, compile_graph
from .errors import ImpossibleEvidence
from .exact import ENGINES
from .filter import advance, begin
from .free_energy import FreeEnergy, free_energy, free_energy_of, is_likelihood
from .learning import Fit, fit
from .message import Belief, FilterOptions, Message
from .posterior import MostProbable, Posterior
from .query import infer, k_most_probable, log_product, marginal_map, most_probable
from .rivals import DECISIVE, Rivals, advance_rivals, certain_of, rivals_of
from .stream import Stream

__all__ = [
    "APPROXIMATIONS",
    "DECISIVE",
    "ENGINES",
    "Belief",
    "CompiledGraph",
    "FilterOptions",
    "Fit",
    "FreeEnergy",
    "ImpossibleEvidence",
    "Loopy",
    "LoopyReport",
    "Message",
    "MostProbable",
    "Posterior",
    "Rivals",
    "Sampling",
    "SamplingReport",
    "Stream",
    "advance",
    "advance_rivals",
    "begin",
    "certain_of",
    "compile_graph",
    "fit",
    "free_energy",
    "free_energy_of",
    "infer",
    "is_likelihood",
    "k_most_probable",
    "log_product",
    "marginal_map",
    "most_probable",
    "rivals_of",
]
