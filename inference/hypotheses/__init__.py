"""Hypotheses about the map: which visits were to the same place, weighed and kept while the answer is open."""

from .hypothesis import Hypothesis
from .records import NOWHERE, Place, Way
from .scheme import Sensed, WayScheme
from .tracker import Tracker, TrackerOptions

__all__ = ["NOWHERE", "Hypothesis", "Place", "Sensed", "Tracker", "TrackerOptions", "Way", "WayScheme"]
