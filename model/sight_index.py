"""Visited places by the sights that they have counts for, so that a sight can be looked up in a large map."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .changes import Change
from .column import Column
from .dirichlet import EMPTY

if TYPE_CHECKING:
    from .cognitive_map import CognitiveMap

Ints = NDArray[np.int64]

SETTLED = 0.5
"""Counts in all, from which on a place without any for a sight makes that sight improbable."""


class SightIndex:
    """Which visited places may show a sight; brought up to date from the log of changes when it is asked.

    Args:
        map_: the map; slots of its `A_o` are never renamed.
    """

    __slots__ = ("_listed", "_map", "_places", "_read", "_unsettled")

    def __init__(self, map_: CognitiveMap) -> None:
        self._map = map_
        self._read = -1
        self._places: dict[int, Column] = {}
        self._listed = Column("listed", np.int64)  # how many slots of a place are in `_places`, in the order of visits
        self._unsettled: set[int] = set()

    def places(self, sight: int) -> tuple[Ints, float]:
        """The visited places that may show `sight`, and a bound on P(sight | s) of every visited place besides."""
        self._update()
        column = self._places.get(sight)
        listed = np.zeros(0, dtype=np.int64) if column is None else column.values
        if self._unsettled:
            listed = np.union1d(listed, np.array(sorted(self._unsettled), dtype=np.int64))
        return listed, self._map.A_o.background / SETTLED

    def _update(self) -> None:
        entries, self._read = self._map.changes.since(self._read)
        changed: dict[int, None] = {}
        for entry in () if entries is None else entries:
            if isinstance(entry, Change) and entry.store in (self._map.A_o, self._map.visits):
                gone = entry.where is None or entry.new is False or entry.new == (EMPTY, 0.0, 0.0)
                entries = None if gone or entries is None else entries
                changed.update(dict.fromkeys(entry.store.touched(entry.where) or ()))
        if entries is None:
            self._rebuild(self._map.visited_places)
        else:
            for place in changed:
                if self._map.visited[place]:
                    self._take_in(place)

    def _take_in(self, place: int) -> None:
        """List the slots of a place that are not yet."""
        here = np.array([place])
        self._listed.resize(len(self._map.visited_places))
        keys = [key for key in self._map.A_o.keys(here)[0].tolist() if key != EMPTY]
        visit = self._map.first_visit[place]
        for key in keys[int(self._listed.values[visit]) :]:
            self._places.setdefault(key, Column("listed", np.int64)).append(place)
        self._listed.values[visit] = len(keys)
        if self._map.A_o.total(here)[0] >= SETTLED:
            self._unsettled.discard(place)
        else:
            self._unsettled.add(place)

    def _rebuild(self, visits: Ints) -> None:
        keys = self._map.A_o.keys(visits)
        used = keys != EMPTY
        places, keys = visits[np.nonzero(used)[0]], keys[used]
        order = np.argsort(keys, kind="stable")
        distinct, first = np.unique(keys[order], return_index=True)
        self._places = {}
        for key, part in zip(distinct.tolist(), np.split(places[order], first[1:]), strict=False):
            self._places[key] = Column("listed", np.int64)
            self._places[key].restore(part)
        self._listed.restore(used.sum(axis=1))
        self._unsettled = set(visits[self._map.A_o.total(visits) < SETTLED].tolist())
