"""Where the places of a map are, as an array that follows the map."""

import numpy as np

from .transitions import Floats, Ints
from .view import MapView

FAR = 1e15  # beyond are no positions


class Where:
    """The position of every place of one map; costs what has changed.

    Args:
        map_: the map.
    """

    __slots__ = ("_map", "_read", "_where")

    def __init__(self, map_: MapView) -> None:
        self._map = map_
        self._read = -1  # of the log of changes
        self._where = np.full((0, map_.pose.dimensions), np.nan)

    def never_entered(self) -> tuple[Ints, Floats]:
        """The places never entered that have a position, and it, `[F, D]`."""
        places = np.flatnonzero(~self._map.visited)
        where = self.of(places)
        known = ~np.isnan(where[:, 0])
        return places[known], where[known]

    def of(self, places: Ints) -> Floats:
        """`[n, D]` of places never entered; NaN where nobody knows."""
        found = self._map.pose.imagined(places)
        return self._all[places] if found is None else np.where(found < FAR, found, np.nan)

    @property
    def _all(self) -> Floats:
        """`[S, D]` of every place; NaN where nobody knows."""
        map_, size = self._map, len(self._map.places)
        changed, self._read = map_.changed_places(self._read, *map_.pose.stores, map_.visits)
        if size != len(self._where):
            grown = np.full((size, self._where.shape[1]), np.nan)
            kept = min(size, len(self._where))
            grown[:kept] = self._where[:kept]
            self._where = grown
        for place in range(size) if changed is None else changed:
            if place < size:
                position = map_.position(place)
                self._where[place] = np.nan if position is None else position
        return self._where
