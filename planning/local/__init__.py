"""The local model of a plan: the tables of the map, cut to the places that policies can lead to, and their cache."""

from .cache import LocalCache
from .cut import Surroundings, local_model
from .frontier import Frontier
from .model import LocalModel
from .preferences import Preferences
from .structure import MapHypotheses, State, Structure
from .transitions import Transitions
from .view import MapView

__all__ = [
    "Frontier", "LocalCache", "LocalModel", "MapHypotheses", "MapView", "Preferences", "State", "Structure",
    "Surroundings", "Transitions", "local_model",
]  # fmt: skip
