"""Where places lie, and what was measured of the ways between them."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...changes import Store
from ...column import Column
from ...percept import Percept
from ..base import Context, Floats, Ints, Successors
from .base import Growing
from .hidden import Hidden, evenly
from .none import NoPose
from .odometer import Odometer, direction
from .relaxing import AXES, Measured, around, drift, relaxed, straightened

UNKNOWN = 1e18
"""Stands for a coordinate that nobody knows."""

SPARE = -2  # in place of the place that one was imagined behind, if no way leads to it any more
RECENT = 4  # visits whose time is kept with a place
TOLD = 1e-4  # likelihood of what was measured where a move led elsewhere than it was found to lead
CLOSED = 1e-3  # mean lengths of a way by which a loop may be open and positions stay as they are
MOST = 400  # places that are relaxed at once, those nearest to where the loop closed

WALK = 8
"""What is kept of a walk: place, action, where it led, how often it was measured, the mean move, and the heading."""


class MetricPose(NoPose):
    """Positions in the plane, or in space, and measured ways; how they come about is `Plane`'s business.

    Attributes:
        where: `[S, 3]` positions of places that were entered; `UNKNOWN` where nobody knows.
        bearings: `[S, K]` degrees of each way as it was seen; -1 where none was.
        lengths: `[S, K]` how long each way was told to be; -1 where nobody said.
        source: `[S, 2]` the place and the action that a place was imagined behind; -1 of none, `SPARE` of one to which
            no way leads any more.
        been: `[S, 4]` the last steps at which the agent was there; -1 of none.
        walks: `[2 S, 7]` the ways that were walked; see `WALK`.
        heading: radians, anticlockwise, by which what the agent takes for north has turned, where no bearings are seen.
        odometer: how long ways are, and how far measurements err.
    """

    settles = True
    measures = True

    def attach(self, context: Context) -> None:
        """Make it part of a model."""
        super().attach(context)
        log, size = context.changes, len(context.motions)
        self.where = Column("where", np.float64, width=AXES, fill=UNKNOWN, changes=log)
        self.bearings = Column("bearings_of", np.float64, width=size, fill=-1.0, changes=log)
        self.lengths = Column("lengths_of", np.float32, width=size, fill=-1.0, changes=log)
        self.source = Column("source", np.int64, width=2, fill=-1, changes=log)
        self.been = Column("been", np.int64, width=RECENT, fill=-1, changes=log)
        self.walks = Column("walks", np.float64, width=WALK, fill=-1.0, changes=log)
        self.heading = Column("heading", np.float64, changes=log)
        self.heading.resize(1)
        self.odometer = Odometer(log)
        self.led: tuple[Percept, int, float] | None = None

    @property
    def stores(self) -> tuple[Store, ...]:
        """Where places are, and what is known of their ways."""
        places = self.where, self.bearings, self.lengths, self.source, self.been
        return *places, self.walks, self.heading, self.odometer.noted

    def grow(self, places: int) -> None:
        """Nothing is known of new places."""
        super().grow(places)
        for column in (self.where, self.bearings, self.lengths, self.source, self.been):
            column.resize(places)
        self.walks.resize(2 * places)

    def blank(self, place: int) -> None:
        """Nobody knows where it is."""
        told = (self.bearings, -1.0), (self.lengths, -1.0)
        for column, none in ((self.where, UNKNOWN), *told, (self.source, -1), (self.been, -1)):
            fill(column, place, [none] * column.values.shape[1])
        for at in np.flatnonzero((self.walks.values[:, [0, 2]] == place).any(axis=1)).tolist():
            fill(self.walks, at, [-1.0] * WALK)

    # -- reading -------------------------------------------------------------------------------------------

    @property
    def dimensions(self) -> int:
        """Three: what was measured in a plane lies at height 0."""
        return AXES

    @property
    def longest(self) -> float:
        """The longest way that was measured."""
        return self.odometer.longest

    @property
    def length(self) -> float:
        """The mean length of a way."""
        return self.odometer.length

    def position(self, place: int) -> Any:
        """Where a place is, or is imagined to be; None where nobody knows."""
        known = self.context.visits.visited.values[place]
        at = self.where.values[place] if known else self.imagined(np.array([place]))[0]
        return tuple(at.tolist()) if at[0] < UNKNOWN else None

    def imagined(self, places: Ints) -> Floats:
        """`[n, 3]` in the direction of the way that they were imagined behind, as far as it is told, or as ways are."""
        source, action = self.source.values[places].T
        bearing = self.bearings.values[source, action]
        found = np.where((source >= 0)[:, None], self.where.values[source], self.where.values[places])
        ahead = (source >= 0) & (bearing >= 0.0) & (found[:, 0] < UNKNOWN)
        found[ahead] += self.long(source[ahead], action[ahead])[:, None] * direction(bearing[ahead])
        return found

    def long(self, places: Ints, actions: Ints) -> Floats:
        """`[n]` how long ways that were not walked are: as they are told, or as ways are long on average."""
        told = self.lengths.values[places, actions]
        return np.where(told < 0.0, self.length, told)

    def lengths_to(self, place: int, others: Ints) -> Floats:
        """`[n]` straight on, in mean lengths of a way; one where nobody knows."""
        entered = self.context.visits.visited.values[others]
        where = np.where(entered[:, None], self.where.values[others], self.imagined(others))
        apart = np.linalg.norm(where - self.where.values[place], axis=1) / self.length
        return np.where(where[:, 0] < UNKNOWN, apart, 1.0)

    def leading(self, ahead: Successors, percept: Percept) -> Successors:
        """The place that `arrive` found, where it found one, is more probable than others, by `TOLD`."""
        if self.led is None or self.led[0] is not percept:
            return ahead
        _, there, factor = self.led
        return replace(ahead, coupling=ahead.coupling * np.where(ahead.places == there, factor, TOLD))

    def steps_in(self, place: int) -> tuple[int, ...]:
        """The last steps at which the agent was there."""
        return tuple(step for step in self.been.values[place].tolist() if step >= 0)

    def walked(self) -> Measured:
        """All that was measured of ways that were walked."""
        rows = self.walks.values
        rows = rows[rows[:, 0] >= 0.0]
        place, action, there = rows[:, :3].astype(np.int64).T
        return self.odometer.weighed(
            np.stack([place, there], axis=1), rows[:, 4:7], rows[:, 3], self.bearings.values[place, action]
        )

    def hidden(self) -> Hidden:
        """Whether places lie hidden on ways between others."""
        walks, some = self.walks.values, evenly(self.context.visits.order.values)
        lengths = np.linalg.norm(walks[evenly(np.flatnonzero(walks[:, 3] > 0.0)), 4:7], axis=1)
        where = self.where.values[some]
        apart = np.linalg.norm(where[:, None] - where, axis=2).mean()
        return Hidden(lengths, self.bearings.values[some], float(apart) / self.length)

    def spare(self) -> int | None:
        """See `Joining.forget`."""
        spare = np.flatnonzero((self.source.values[:, 0] == SPARE) & ~self.context.visits.visited.values)
        return int(spare[0]) if len(spare) else None

    def imagine(self, place: int, source: int, action: int) -> None:
        """A place was imagined behind a way: it lies in the direction of its bearing."""
        if self.position(source) is not None:
            fill(self.source, place, [source, action])

    # -- measurements --------------------------------------------------------------------------------------

    def note(
        self, place: int, action: int, there: int | None, move: Floats, *, measured: bool = True, roams: bool = False
    ) -> None:
        """Keep what was measured of a way; of one that was walked before its mean, and how far measurements err.

        Of an agent that `roams` every walk is kept, with the heading that it believed to have.
        """
        rows = self.walks.values
        key = np.array([place, action, -1 if there is None else there], dtype=np.float64)
        known = np.flatnonzero(rows[:, 0] == key[0])
        known = known[(rows[known, :3] == key).all(axis=1)]
        if len(known) and not roams:
            at, many = int(known[0]), float(rows[known[0], 3])
            if many and measured:
                mean = rows[at, 4:7].copy()
                self.odometer.learn(move - mean, float(np.square(mean).sum()) * (1.0 + 1.0 / many))
                fill(self.walks, at, [*key.tolist(), many + 1.0, *(mean + (move - mean) / (many + 1.0)).tolist(), 0.0])
            return
        free = np.flatnonzero(rows[:, 0] < 0.0)
        if len(free) and there is not None:
            fill(
                self.walks,
                int(free[0]),
                [*key.tolist(), float(measured), *move.tolist(), float(self.heading.values[0])],
            )

    def apart(self, place: int, at: Floats) -> float:
        """How far a place lies from a position, in mean lengths of a way."""
        return float(np.linalg.norm(self.where.values[place] - at)) / self.length

    def loop(self, place: int, there: int, at: Floats, *, roams: bool = False) -> None:
        """A loop closed: positions relax, if they do not fit; of an agent that `roams` the heading drifts as well."""
        if self.apart(there, at) <= CLOSED:
            return
        measured, size = self.walked(), len(self.where)
        off = self.where.values[there] - at
        before = measured.among(~((measured.ends == (place, there)).all(axis=1)))
        spread = drift(before, place, np.array([there]), size)[0]
        if np.isfinite(spread):
            self.odometer.learn(off, float(np.square(spread / self.odometer.rate)))
        origin = self.context.visits.order.values[0]
        free = around(measured, np.array([place, there]), MOST, size)
        free = free[free != origin]
        if roams:
            rows = np.flatnonzero(self.walks.values[:, 0] >= 0.0)
            positions, heading = straightened(self.where.values, measured, self.walks.values[rows, 7], free)
            for row, turn in zip(rows.tolist(), heading.tolist(), strict=True):
                self.walks.set((row, 7), turn)
            self.heading.set(0, float(heading[-1]))
        else:
            positions = relaxed(self.where.values, measured, free)
        for one, position in zip(free.tolist(), positions.tolist(), strict=True):
            fill(self.where, one, position)


def seen_bearings(model: Growing, percept: Percept) -> Floats | None:
    """`[K]` the bearing of each way as it is seen; -1 where there is none. None where no bearings are sensed."""
    reading = percept.readings.get("bearings")
    known = isinstance(reading, int)
    return np.array(model.sensors["bearings"].label(reading), dtype=np.float64) if known else None


def fill(column: Column, row: int, values: Sequence[Any] | NDArray[Any]) -> None:
    """Write a row."""
    for at, value in enumerate(values):
        column.set((row, at), value)
