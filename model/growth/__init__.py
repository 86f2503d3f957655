"""The three ways to grow, compared in the paper's figure on internal map layouts."""

from .base import Growth, Whereabouts, place_beyond
from .observed import ObservedGrowth
from .predicted import PredictedGrowth
from .static import StaticGrowth

GROWTHS: dict[str, type[Growth]] = {
    "static": StaticGrowth,
    "observed": ObservedGrowth,
    "predicted": PredictedGrowth,
}
"""Growth rules by name."""

__all__ = ["GROWTHS", "Growth", "ObservedGrowth", "PredictedGrowth", "StaticGrowth", "Whereabouts", "place_beyond"]
