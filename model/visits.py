"""Which places were ever entered, and in which order."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .changes import Change, Changes
from .column import Column
from .errors import CogmapError


class Visits:
    """The places that were entered, in the order of their first visit.

    Attributes:
        order: the visited places.
        first: for each place its index among them; -1 where it was never entered.
        visited: for each place whether it was entered.
    """

    name = "visits"

    def __init__(self, changes: Changes) -> None:
        self._changes = changes
        self.order = Column("visits.order", np.int64)
        self.first = Column("visits.first", np.int64, fill=-1)
        self.visited = Column("visits.visited", np.bool_)

    def resize(self, places: int) -> None:
        """Have so many places."""
        self.first.resize(places)
        self.visited.resize(places)

    def note(self, place: int) -> None:
        """The agent was in `place`."""
        if not self.visited.values[place]:
            self._changes.append(Change(self, place, False, True))  # first, so that what is half done can be taken back
            self.put(place, True)

    def forget(self) -> None:
        """The place that was entered last for the first time was not."""
        place = self.order.values.item(-1)
        self._changes.append(Change(self, place, True, False))  # first, as above
        self.put(place, False)

    def put(self, where: int, value: bool) -> None:
        """The last visited place, or the next one, without telling the log."""
        if value:
            self.first.put(where, self.order.append(where))
        else:
            self.order.resize(len(self.order) - 1)
            self.first.put(where, -1)
        self.visited.put(where, value)

    def undo(self, where: int, old: bool) -> None:
        """Have the place as the last visited one, or not, whether that was done or only meant."""
        last = len(self.order) and self.order.values.item(-1) == where
        if old and not last:
            self.order.append(where)
        elif last and not old:
            self.order.resize(len(self.order) - 1)

    def savepoint(self) -> int:
        """How many places there are, and in which order they were entered is in the log."""
        return len(self.visited)

    def go_back(self, point: int) -> None:
        """Have so many places, and of each whether it was entered, as the order has it."""
        self.first.resize(0)
        self.visited.resize(0)
        self.resize(point)
        order = self.order.values
        self.first.values[order] = np.arange(len(order))
        self.visited.values[order] = True

    def touched(self, where: int) -> Iterable[int]:
        """The place itself."""
        return (where,)

    def state(self) -> dict[str, NDArray[np.int64]]:
        """The places in the order of their first visit, for saving."""
        return {"order": self.order.values.copy()}

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Take over which ones of the places that there are were visited.

        Raises:
            CogmapError: one is none, or stands twice.
        """
        order = state["order"]
        fits = order.ndim == 1 and order.dtype.kind == "i" and len(np.unique(order)) == len(order)
        if not (fits and bool(((order >= 0) & (order < len(self.visited))).all())):
            raise CogmapError(f"map: visits does not fit {len(self.visited)} places; save it again")
        self.order.resize(len(order))
        self.order.values[:] = order
        self.first.values[order] = np.arange(len(order))
        self.visited.values[order] = True
