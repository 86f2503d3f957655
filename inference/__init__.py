"""What follows from evidence: beliefs step by step, exact posteriors of factor graphs, their evidence, free energy."""

from __future__ import annotations

from .compiled import CompiledGraph, compile_graph
from .errors import ImpossibleEvidence
from .exact import ENGINES
from .filter import advance, begin
from .free_energy import FreeEnergy, free_energy, free_energy_of
from .message import Belief, FilterOptions, Message
from .posterior import MostProbable, Posterior
from .query import infer, k_most_probable, log_product, marginal_map, most_probable
from .rivals import DECISIVE, Rivals, advance_rivals, certain_of, rivals_of

__all__ = [
    "DECISIVE",
    "ENGINES",
    "Belief",
    "CompiledGraph",
    "FilterOptions",
    "FreeEnergy",
    "ImpossibleEvidence",
    "Message",
    "MostProbable",
    "Posterior",
    "Rivals",
    "advance",
    "advance_rivals",
    "begin",
    "certain_of",
    "compile_graph",
    "free_energy",
    "free_energy_of",
    "infer",
    "k_most_probable",
    "log_product",
    "marginal_map",
    "most_probable",
    "rivals_of",
]
