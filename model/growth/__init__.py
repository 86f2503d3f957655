"""The three ways to grow, compared in the paper's figure on internal map layouts."""

from __future__ import annotations

from ..errors import CogmapError
from .base import Growth
from .observed import ObservedGrowth
from .predicted import PredictedGrowth
from .static import StaticGrowth

GROWTHS: dict[str, type[Growth]] = {
    "static": StaticGrowth,
    "observed": ObservedGrowth,
    "predicted": PredictedGrowth,
}
"""Growth strategies by name."""


def growth_named(name: str) -> Growth:
    """The growth strategy of that name.

    Raises:
        CogmapError: there is none.
    """
    if name not in GROWTHS:
        raise CogmapError(f"growth: {name!r} is unknown; choose one of {', '.join(GROWTHS)}")
    return GROWTHS[name]()


__all__ = ["GROWTHS", "Growth", "ObservedGrowth", "PredictedGrowth", "StaticGrowth", "growth_named"]
