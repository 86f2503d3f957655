"""The number of places is known beforehand, nothing else (figure on internal map layouts, a)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..cognitive_map import CognitiveMap
from ..errors import CogmapError


class StaticGrowth:
    """Starts with every place, none of them connected; entering gives the next one its position."""

    def begin(self, map_: CognitiveMap, *, places: int | None, step: int) -> list[int]:
        """All places; the first is where the agent wakes up.

        Raises:
            CogmapError: the number of places is not given.
        """
        if places is None or places < 1:
            raise CogmapError("growth: static growth needs the size of the world; set Settings.places to 1 or more")
        new = [map_.new_place(None, step=step) for _ in range(places)]
        map_.bind(new[0], (0,) * len(map_.motions.displacements[0]), step=step)
        return new

    def enter(self, map_: CognitiveMap, place: int, action: int, *, step: int) -> list[int]:
        """Gives the place behind the door that was taken its position.

        Raises:
            CogmapError: every place has a position already.
        """
        here = map_.position(place)
        if here is None or map_.beyond(place, action) is not None:
            return []
        there = map_.motions.move(here, action)
        if map_.place_at(there) is not None:
            return []
        free = np.flatnonzero(map_.position_index < 0)
        if not len(free):
            size = len(map_.places)
            raise CogmapError(
                f"growth: the world is larger than its {size} places; raise Settings.places or grow otherwise"
            )
        map_.bind(int(free[0]), there, step=step, source=place, action=action)
        return [int(free[0])]

    def look(self, map_: CognitiveMap, place: int, open_: Sequence[bool], *, step: int) -> list[int]:
        """Nothing: the map cannot tell which of its places lies behind a door."""
        return []
