"""Hypotheses about the map: which visits were to the same place, weighed and kept while the answer is open."""

from .branches import Lead
from .hypothesis import Hypothesis
from .knowing import tracker_knowing
from .options import Change, Checkpoint, TrackerOptions
from .reading import (
    RateOf,
    indistinguishable,
    label_probabilities,
    open_probability,
    rates_of,
    readings_of,
    together,
    ways_misread,
    where_to,
    whereabouts,
)
from .records import NOWHERE, Place, Share, Way
from .scheme import Sensed, WayScheme
from .tracker import Tracker

__all__ = [
    "NOWHERE", "Change", "Checkpoint", "Hypothesis", "Lead", "Place", "RateOf", "Sensed", "Share", "Tracker",
    "TrackerOptions", "Way", "WayScheme", "indistinguishable", "label_probabilities", "open_probability", "rates_of",
    "readings_of", "together", "tracker_knowing", "ways_misread", "where_to", "whereabouts",
]  # fmt: skip
