"""Positions in the plane, or in space, as they are measured: in metres, by displacements after each move."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...changes import Store
from ...column import Column
from ...percept import Percept
from ..base import Context, Floats, Ints
from ..transition import Transition
from .base import Growing
from .none import NoPose
from .ways_between import ROUGH, between

UNKNOWN = 1e18
"""Stands for a coordinate that nobody knows."""

AXES = 3
RECENT = 4
"""Visits whose time is kept with a place."""

NEAR = 0.1
"""A place is the one that was expected if it is so near, in mean lengths of a way."""

FAR = 2.0
"""The same of a place whose ways lead as those of no other do, in a world where that tells places apart."""

LONG = 2.5
"""Standard deviations of the logarithm of lengths above the mean up to which a way that was not walked may be long."""

SPREAD, FEW = 0.5, 4
"""Standard deviation of the logarithm of lengths before any was measured, and how many measurements it counts for."""

ENOUGH = 12
"""Places that are to have been entered before bearings are thought to tell them apart."""

SHARED = 0.1
"""Share of the places with bearings like others' up to which bearings tell places apart."""


class Plane(NoPose):
    """A place lies where displacements lead to, relative to where the agent woke up.

    Observations have `displacement`, what was measured of the last move, and perhaps `bearings` (see `Bearings`). A way
    that was never walked leads to an imagined place, in the direction of its bearing and as far as ways are long on
    average; where a place that was entered lies there, and has a way that leads back, the way is one between the two.

    Which place is which follows from positions and bearings, so that no hypotheses are weighed.

    Attributes:
        where: `[S, 3]` positions; of places never entered that of `source`; `UNKNOWN` where nobody knows.
        bearings: `[S, K]` degrees of each way as it was seen; -1 where none was.
        source: `[S, 2]` the place and the action that a place was imagined behind; -1 of none.
        been: `[S, 4]` the last steps at which the agent was there; -1 of none.
        lengths: ways that were measured, the sum of the logarithms of their lengths and of the squares of these, their
            lengths in all, and the longest.
    """

    settles = True

    def attach(self, context: Context) -> None:
        """Make it part of a model."""
        super().attach(context)
        log, size = context.changes, len(context.motions)
        self.where = Column("where", np.float64, width=AXES, fill=UNKNOWN, changes=log)
        self.bearings = Column("bearings_of", np.float64, width=size, fill=-1.0, changes=log)
        self.source = Column("source", np.int64, width=2, fill=-1, changes=log)
        self.been = Column("been", np.int64, width=RECENT, fill=-1, changes=log)
        self.lengths = Column("lengths", np.float64, changes=log)
        self.lengths.resize(5)
        self._now = 0

    @property
    def stores(self) -> tuple[Store, ...]:
        """Where places are, and what is known of their ways."""
        return self.where, self.bearings, self.source, self.been, self.lengths

    def grow(self, places: int) -> None:
        """Nothing is known of new places."""
        super().grow(places)
        for column in (self.where, self.bearings, self.source, self.been):
            column.resize(places)

    def blank(self, place: int) -> None:
        """Nobody knows where it is."""
        for column, fill in ((self.where, UNKNOWN), (self.bearings, -1.0), (self.source, -1), (self.been, -1)):
            for at in range(column.values.shape[1]):
                column.set((place, at), fill)

    # -- reading -------------------------------------------------------------------------------------------

    @property
    def dimensions(self) -> int:
        """Three: what was measured in a plane lies at height 0."""
        return AXES

    @property
    def longest(self) -> float:
        """The longest way that was measured."""
        return float(self.lengths.values[4]) or 1.0

    @property
    def length(self) -> float:
        """The mean length of a way."""
        many, _, _, total, _ = self.lengths.values.tolist()
        return total / many if many else 1.0

    def position(self, place: int) -> Any:
        """Where a place is, or is imagined to be; None where nobody knows."""
        known = self.context.visits.visited.values[place]
        at = self.where.values[place] if known else self.imagined(np.array([place]))[0]
        return tuple(at.tolist()) if at[0] < UNKNOWN else None

    def imagined(self, places: Ints) -> Floats:
        """`[n, 3]` in the direction of the way that they were imagined behind, as far as ways are long on average."""
        source, action = self.source.values[places].T
        bearing = self.bearings.values[source, action]
        found = self.where.values[places].copy()
        ahead = (source >= 0) & (bearing >= 0.0) & (found[:, 0] < UNKNOWN)
        angle = np.deg2rad(bearing[ahead])
        along = self.length * np.stack([np.sin(angle), np.cos(angle), np.zeros(len(angle))], axis=1)
        found[ahead] = self.where.values[source[ahead]] + along
        return found

    def steps_in(self, place: int) -> tuple[int, ...]:
        """The last steps at which the agent was there."""
        return tuple(step for step in self.been.values[place].tolist() if step >= 0)

    # -- growing -------------------------------------------------------------------------------------------

    def imagine(self, place: int, source: int, action: int) -> None:
        """A place was imagined behind a way: it lies in the direction of its bearing."""
        self.source.set((place, 0), source)
        self.source.set((place, 1), action)
        if self.position(source) is not None:
            self._put(place, self.where.values[source])

    def arrive(self, model: Growing, place: int, percept: Percept, *, step: int) -> None:
        """Before inference: a way was walked, and measured; have it lead to the place that lies there."""
        action, measured, self._now = percept.action, percept.displacement, step
        if measured is None or action is None or action == model.motions.stay or self.position(place) is None:
            return
        ways = model.transitions
        if ways.walked.values[place, action]:
            return
        moved = np.array([*measured, 0.0, 0.0])[:AXES]
        at, target = self.where.values[place] + moved, ways.beyond(place, action)
        entered = model.visits.visited.values
        apart = np.inf if target is None else np.linalg.norm(self.where.values[target] - at)
        if target is not None and entered[target] and apart <= NEAR * self.length:
            return  # as was thought; if it looks otherwise, the agent was put elsewhere
        there = self._lies_at(model, at, percept, left=place)
        if there is None and (target is None or model.visits.visited.values[target]):
            there = model.new_place(step=step)
        if there is not None and there != target:
            ways.lead(place, action, there)
            self._forget(model, target, place, action)
        there = target if there is None else there
        if there is not None and not model.visits.visited.values[there]:
            self._put(there, at)
        self._measure(float(np.linalg.norm(moved)))
        if there is not None and model.visits.visited.values[there]:
            self._return(model, place, action, there)

    def look(self, model: Growing, place: int, percept: Percept, *, step: int) -> None:
        """The agent is in a place, as far as it is certain, and sees its ways."""
        self._now = step
        times = [*self.steps_in(place), step][-RECENT:]
        for at, time in enumerate(times):
            self.been.set((place, at), time)
        if self.position(place) is None:
            self._put(place, np.zeros(AXES))
        seen = _bearings(model, percept)
        if seen is not None and not (self.bearings.values[place] >= 0.0).any():
            for action, bearing in enumerate(seen):
                self.bearings.set((place, action), bearing)
            self._join(model, place)

    def guessed(self, ways: Transition) -> Sequence[tuple[int, int, float]]:
        """Ways between places that were entered, walked in neither direction; doubted if longer than is usual."""
        entered = self.context.visits.visited.values
        walked = ways.walked.values
        walks = {(int(place), ways.beyond(int(place), int(action))) for place, action in np.argwhere(walked)}
        found: list[tuple[int, int, float]] = []
        for place, action in np.argwhere((self.bearings.values >= 0.0) & ~walked & entered[:, None]).tolist():
            there = ways.beyond(place, action)
            if there is None or not entered[there]:
                continue
            seen = np.flatnonzero(self.bearings.values[place] >= 0.0).tolist()
            twice = sum(ways.beyond(place, other) == there for other in seen) > 1  # one of them leads elsewhere
            if twice or (there, place) not in walks:
                apart = float(np.linalg.norm(self.where.values[there] - self.where.values[place]))
                found.append((place, action, max(self._log_length(apart), 0.0)))
        return found

    def _log_length(self, length: float) -> float:
        """How long that is: standard deviations of the logarithm of lengths above their mean."""
        many, logs, squares, _, _ = self.lengths.values.tolist()
        mean = logs / max(many, 1.0)
        spread = np.sqrt((max(squares - many * mean * mean, 0.0) + FEW * SPREAD**2) / (many + FEW))
        return float((np.log(max(length, 1e-9)) - mean) / spread)

    # -- ways between places -------------------------------------------------------------------------------

    def _join(self, model: Growing, place: int) -> None:
        """Have the ways of a place that was just entered lead to places entered before, and theirs to it."""
        entered, here = model.visits.order.values, self.where.values
        others = entered[entered != place]
        apart = np.linalg.norm(here[others] - here[place], axis=1)
        leads = np.isin(others, self.source.values[place, :1])  # where it was imagined first
        near = np.array([self._log_length(each) <= LONG for each in apart.tolist()], dtype=np.bool_) | leads
        others, apart = others[near], apart[near].tolist()
        if not len(others):
            return
        found = between(here[place], self.bearings.values[place], here[others], self.bearings.values[others])
        ways, taken, met = model.transitions, set[tuple[int, int]](), set[int]()
        for pair in sorted(found, key=lambda pair: ways.beyond(int(others[pair.other]), pair.back) != place):
            mine, its, far = (place, pair.action), (int(others[pair.other]), pair.back), apart[pair.other]
            if its[0] in met or not taken.isdisjoint((mine, its)):  # two places share one way at most
                continue
            if self._free(model, mine, place, far) and self._free(model, its, place, far):
                taken |= {mine, its}
                met.add(its[0])
                self._link(model, mine, its[0])
                self._link(model, its, place)

    def _free(self, model: Growing, way: tuple[int, int], place: int, apart: float) -> bool:
        """Whether nobody knows where a way leads, or it leads to `place`, or is only thought to lead further."""
        target = model.transitions.beyond(*way)
        if target is None or target == place or not model.visits.visited.values[target]:
            return True
        known = model.transitions.walked.values
        if known[way] or any(model.transitions.beyond(target, int(a)) == way[0] for a in np.flatnonzero(known[target])):
            return False
        return float(np.linalg.norm(self.where.values[target] - self.where.values[way[0]])) > 1.001 * apart

    def _link(self, model: Growing, way: tuple[int, int], to: int) -> None:
        before = model.transitions.beyond(*way)
        if before == to:
            return
        model.transitions.lead(*way, to)
        self._forget(model, before, *way)
        if before is not None and model.visits.visited.values[before]:
            self._free_back(model, before, way[0])

    def _forget(self, model: Growing, place: int | None, source: int, action: int) -> None:
        """What was imagined behind a way that leads elsewhere is nowhere."""
        if place is None or model.visits.visited.values[place]:
            return
        if self.source.values[place].tolist() == [source, action]:
            self._put(place, np.full(AXES, UNKNOWN))

    def _return(self, model: Growing, place: int, action: int, there: int) -> None:
        """The way back from a place entered before is the one that points here, whatever was thought of it."""
        bearing = float(self.bearings.values[place, action])
        if bearing < 0.0:
            return
        apart = np.abs((self.bearings.values[there] - bearing) % 360.0 - 180.0)
        apart[self.bearings.values[there] < 0.0] = np.inf
        back = int(apart.argmin())
        if apart[back] > ROUGH or model.transitions.walked.values[there, back]:
            return
        self._link(model, (there, back), place)

    def _free_back(self, model: Growing, place: int, there: int) -> None:
        """A way that was only thought to lead from a place to another leads to nobody knows where."""
        ways = model.transitions
        for action in np.flatnonzero(self.bearings.values[place] >= 0.0).tolist():
            if ways.beyond(place, action) == there and not ways.walked.values[place, action]:
                new = model.new_place(step=self._now)
                ways.lead(place, action, new)
                self.imagine(new, place, action)

    def _lies_at(self, model: Growing, at: Floats, percept: Percept, *, left: int) -> int | None:
        """The place entered before that lies at a position, and has such ways; not the one that was left."""
        entered = model.visits.order.values
        entered = entered[entered != left]
        if not len(entered):
            return None
        apart = np.linalg.norm(self.where.values[entered] - at, axis=1)
        order = np.argsort(apart, kind="stable")[:8]
        seen, near = _bearings(model, percept), NEAR * self.length
        if seen is not None and (seen >= 0.0).sum() > 2 and self._telling(entered):
            near = FAR * self.length
        for i in order[apart[order] <= near].tolist():
            place = int(entered[i])
            if seen is None or np.array_equal(self.bearings.values[place], seen):
                return place
        return None

    def _telling(self, entered: Ints) -> bool:
        """Whether places are told apart by their bearings."""
        kinds = len(np.unique(self.bearings.values[entered], axis=0))
        return len(entered) >= ENOUGH and len(entered) - kinds <= SHARED * len(entered)

    def _put(self, place: int, at: NDArray[Any]) -> None:
        for axis, value in enumerate(at.tolist()):
            self.where.set((place, axis), value)

    def _measure(self, length: float) -> None:
        many, logs, squares, total, longest = self.lengths.values.tolist()
        log = float(np.log(max(length, 1e-9)))
        new = many + 1.0, logs + log, squares + log * log, total + length, max(longest, length)
        for at, value in enumerate(new):
            self.lengths.set(at, value)


def _bearings(model: Growing, percept: Percept) -> Floats | None:
    """`[K]` the bearing of each way as it is seen; -1 where there is none. None where no bearings are sensed."""
    reading = percept.readings.get("bearings")
    return (
        None if not isinstance(reading, int) else np.array(model.sensors["bearings"].label(reading), dtype=np.float64)
    )
