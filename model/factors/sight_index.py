"""Visited places by the sights that they have counts for, so that a sight can be looked up in a large map."""

import numpy as np

from ..arrays import Ints
from ..changes import Change, Changes
from ..column import Column
from ..dirichlet import EMPTY, SparseDirichlet
from ..visits import Visits

SETTLED = 0.5  # counts in all, from which on a place without any for a sight makes that sight improbable


class SightIndex:
    """Which visited places may show a sight; brought up to date from the log of changes when it is asked.

    Args:
        table: the counts of the sights; slots are never renamed.
        changes: the log that it writes to.
        visits: which places were entered.
    """

    __slots__ = ("_changes", "_listed", "_places", "_read", "_table", "_unsettled", "_visits")

    def __init__(self, table: SparseDirichlet, changes: Changes, visits: Visits) -> None:
        self._table, self._changes, self._visits = table, changes, visits
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
        return listed, self._table.background / SETTLED

    def _update(self) -> None:
        entries, self._read = self._changes.since(self._read)
        changed: dict[int, None] = {}
        for entry in () if entries is None else entries:
            if isinstance(entry, Change) and entry.store in (self._table, self._visits):
                gone = entry.where is None or entry.new is False or entry.new == (EMPTY, 0.0, 0.0)
                entries = None if gone or entries is None else entries
                changed.update(dict.fromkeys(entry.store.touched(entry.where) or ()))
        if entries is None:
            self._rebuild(self._visits.order.values)
        else:
            for place in changed:
                if self._visits.visited.values[place]:
                    self._take_in(place)

    def _take_in(self, place: int) -> None:
        """List the slots of a place that are not yet."""
        here = np.array([place])
        self._listed.resize(len(self._visits.order))
        keys = [key for key in self._table.keys(here)[0].tolist() if key != EMPTY]
        visit = self._visits.first.values[place]
        for key in keys[int(self._listed.values[visit]) :]:
            self._places.setdefault(key, Column("listed", np.int64)).append(place)
        self._listed.values[visit] = len(keys)
        if self._table.total(here)[0] >= SETTLED:
            self._unsettled.discard(place)
        else:
            self._unsettled.add(place)

    def _rebuild(self, visits: Ints) -> None:
        keys = self._table.keys(visits)
        used = keys != EMPTY
        places, keys = visits[np.nonzero(used)[0]], keys[used]
        order = np.argsort(keys, kind="stable")
        distinct, first = np.unique(keys[order], return_index=True)
        self._places = {}
        for key, part in zip(distinct.tolist(), np.split(places[order], first[1:]), strict=False):
            self._places[key] = _column(part)
        self._listed = _column(used.sum(axis=1))
        self._unsettled = set(visits[self._table.total(visits) < SETTLED].tolist())


def _column(numbers: Ints) -> Column:
    column = Column("listed", np.int64)
    column.resize(len(numbers))
    column.values[:] = numbers
    return column
