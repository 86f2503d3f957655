"""The number of places is known beforehand, nothing else (figure on internal map layouts, a)."""

from typing import Any

import numpy as np

from ..errors import CogmapError
from ..generative import GenerativeModel
from ..rates import is_whole
from .base import Growth, Whereabouts

MOST = 10_000_000  # places that can be known beforehand


class StaticGrowth(Growth):
    """Starts with all places, unconnected. Entering a new one gives it its position.

    Args:
        places: how many places the world has.

    Raises:
        CogmapError: that is no whole number of 1 or more, or above `MOST`.
    """

    name = "static"

    def __init__(self, places: int) -> None:
        if not is_whole(places, 1, MOST):
            raise CogmapError(
                f"growth: static growth cannot have {places!r} places; give the size of the world, {MOST:,} at most"
            )
        self.places = places

    @property
    def options(self) -> dict[str, Any]:
        return {"places": self.places}

    def begin(self, map_: GenerativeModel, *, step: int) -> list[int]:
        """All places; the first is where the agent wakes up. Raises CogmapError: places have no positions."""
        origin = map_.pose.origin
        if origin is None:
            raise CogmapError("growth: static growth tells places apart by their positions; give the agent a Lattice()")
        new = [map_.new_place(step=step) for _ in range(self.places)]
        map_.bind(new[0], origin, step=step)
        return new

    def enter(self, map_: GenerativeModel, belief: Whereabouts, action: int, *, step: int) -> list[int]:
        """Gives the place behind the door that was taken its position.

        Raises:
            CogmapError: every place has a position already.
        """
        here = belief.place
        position, there = map_.pose.ahead(here, action)
        if position is None or there is not None or map_.transitions.beyond(here, action) is not None:
            return []
        free = np.flatnonzero(map_.pose.of(np.arange(len(map_.places))) < 0).tolist()
        if not free and len(map_.places) < self.places:  # a map that was built anew without the place it began with
            free = [map_.new_place(step=step)]
        if not free:
            raise CogmapError(
                f"growth: the world is larger than its {self.places} places; give static growth more, or grow otherwise"
            )
        map_.bind(free[0], position, step=step, source=here, action=action)
        return [free[0]]
