"""What follows from evidence: beliefs step by step, exact posteriors of factor graphs, their evidence, free energy."""

from .approximate import APPROXIMATIONS, Loopy, LoopyReport, Sampling, SamplingReport
from .compiled import CompiledGraph, compile_graph
from .errors import ImpossibleEvidence
from .exact import ENGINES
from .filter import advance, begin
from .free_energy import FreeEnergy, free_energy, free_energy_of, is_likelihood
from .hypotheses import (
    NOWHERE,
    Hypothesis,
    Place,
    RateOf,
    Sensed,
    Share,
    Tracker,
    TrackerOptions,
    Way,
    WayScheme,
    indistinguishable,
    label_probabilities,
    open_probability,
    rates_of,
    readings_of,
    together,
    tracker_knowing,
    ways_misread,
    whereabouts,
)
from .learning import Fit, fit
from .message import Belief, FilterOptions, Message
from .posterior import MostProbable, Posterior
from .query import infer, k_most_probable, log_product, marginal_map, most_probable
from .stream import Stream

__all__ = [
    "APPROXIMATIONS", "ENGINES", "NOWHERE", "Belief", "CompiledGraph", "FilterOptions", "Fit", "FreeEnergy",
    "Hypothesis", "ImpossibleEvidence", "Loopy", "LoopyReport", "Message", "MostProbable", "Place", "Posterior",
    "RateOf", "Sampling", "SamplingReport", "Sensed", "Share", "Stream", "Tracker", "TrackerOptions", "Way",
    "WayScheme", "advance", "begin", "compile_graph", "fit", "free_energy", "free_energy_of", "indistinguishable",
    "infer", "is_likelihood", "k_most_probable", "label_probabilities", "log_product", "marginal_map", "most_probable",
    "open_probability", "rates_of", "readings_of", "together", "tracker_knowing", "ways_misread", "whereabouts",
]  # fmt: skip
