"""Where places lie, and what was measured of the ways between them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...changes import Store
from ...column import Column
from ..base import Context, Floats, Ints
from .none import NoPose
from .odometer import Odometer, direction
from .relaxing import AXES, Measured

UNKNOWN = 1e18
"""Stands for a coordinate that nobody knows."""

RECENT = 4
"""Visits whose time is kept with a place."""

WALK = 7
"""What is kept of a way that was walked: place, action, where it led, how often it was measured, the mean move."""


class MetricPose(NoPose):
    """Positions in the plane, or in space, and measured ways; how they come about is `Plane`'s business.

    Attributes:
        where: `[S, 3]` positions of places that were entered; `UNKNOWN` where nobody knows.
        bearings: `[S, K]` degrees of each way as it was seen; -1 where none was.
        source: `[S, 2]` the place and the action that a place was imagined behind; -1 of none.
        been: `[S, 4]` the last steps at which the agent was there; -1 of none.
        walks: `[2 S, 7]` the ways that were walked; see `WALK`.
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
        self.source = Column("source", np.int64, width=2, fill=-1, changes=log)
        self.been = Column("been", np.int64, width=RECENT, fill=-1, changes=log)
        self.walks = Column("walks", np.float64, width=WALK, fill=-1.0, changes=log)
        self.odometer = Odometer(log)

    @property
    def stores(self) -> tuple[Store, ...]:
        """Where places are, and what is known of their ways."""
        return self.where, self.bearings, self.source, self.been, self.walks, self.odometer.noted

    def grow(self, places: int) -> None:
        """Nothing is known of new places."""
        super().grow(places)
        for column in (self.where, self.bearings, self.source, self.been):
            column.resize(places)
        self.walks.resize(2 * places)

    def blank(self, place: int) -> None:
        """Nobody knows where it is."""
        for column, none in ((self.where, UNKNOWN), (self.bearings, -1.0), (self.source, -1), (self.been, -1)):
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
        """`[n, 3]` in the direction of the way that they were imagined behind, as far as ways are long on average."""
        source, action = self.source.values[places].T
        bearing = self.bearings.values[source, action]
        found = np.where((source >= 0)[:, None], self.where.values[source], self.where.values[places])
        ahead = (source >= 0) & (bearing >= 0.0) & (found[:, 0] < UNKNOWN)
        found[ahead] += self.length * direction(bearing[ahead])
        return found

    def lengths_to(self, place: int, others: Ints) -> Floats:
        """`[n]` straight on, in mean lengths of a way; one where nobody knows."""
        entered = self.context.visits.visited.values[others]
        where = np.where(entered[:, None], self.where.values[others], self.imagined(others))
        apart = np.linalg.norm(where - self.where.values[place], axis=1) / self.length
        return np.where(where[:, 0] < UNKNOWN, apart, 1.0)

    def steps_in(self, place: int) -> tuple[int, ...]:
        """The last steps at which the agent was there."""
        return tuple(step for step in self.been.values[place].tolist() if step >= 0)

    def walked(self) -> Measured:
        """All that was measured of ways that were walked."""
        rows = self.walks.values
        rows = rows[rows[:, 0] >= 0.0]
        place, action, there = rows[:, :3].astype(np.int64).T
        return self.odometer.weighed(
            np.stack([place, there], axis=1), rows[:, 4:], rows[:, 3], self.bearings.values[place, action]
        )

    def imagine(self, place: int, source: int, action: int) -> None:
        """A place was imagined behind a way: it lies in the direction of its bearing."""
        if self.position(source) is not None:
            fill(self.source, place, [source, action])


def fill(column: Column, row: int, values: Sequence[Any] | NDArray[Any]) -> None:
    """Write a row."""
    for at, value in enumerate(values):
        column.set((row, at), value)
