"""Hypotheses about the map: which visits were to the same place, weighed and kept while the answer is open."""

from .hypothesis import Hypothesis
from .records import NOWHERE, Place, Way
from .scheme import Percept, WayScheme
from .tracker import Tracker, TrackerOptions

__all__ = ["NOWHERE", "Hypothesis", "Percept", "Place", "Tracker", "TrackerOptions", "Way", "WayScheme"]
