"""The generative model (eq. 1) as a list of factors over places that come as they are imagined."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .arrays import Floats, Ints
from .changes import Change, Changes, Store
from .dirichlet import SparseDirichlet
from .errors import CogmapError
from .factors import Displacement, Lattice, ModelFactor, NoPose, Pose, Sensor, Sight, Transition, Ways
from .factors.base import Context
from .growth_event import GrowthEvent, GrowthKind
from .growth_log import GrowthLog
from .motions import Motions, Position
from .percept import Percept
from .rates import Priors, Rates
from .visits import Visits


class GenerativeModel:
    """The generative model of eq. 1: its factors, and the places that they share.

    Args:
        motions: the actions.
        sensors: what is sensed in a place; `Sight("sight")` and `Ways()` unless given.
        pose: how places lie to each other; `Lattice()` unless given.
        priors: concentrations before evidence.
        rates: counts that a piece of evidence adds.
        displacement: P(moved_t), that the agent was put elsewhere; None for a model in which that cannot be.
        slip: probability of a slip, for a pose that has none of its own.

    Attributes:
        motions, pose: as given.
        sensors: by name, in order.
        sights_sensed: those of them that see labels.
        transitions: where ways lead.
        displacement: the factor of being moved, or None.
        changes: the log of all that is written.
        growth: everything that was ever added, in order; see `GrowthLog.keep`.
        visits: which places were entered.
        A_o: counts of the first sensor that sees labels; every place shows the same where none does.
        A_p: counts of positions; empty where places have none.
        B_s: counts of transitions.

    Raises:
        CogmapError: two sensors of one name, or a part that belongs to another model.
    """

    name = "places"

    def __init__(
        self,
        motions: Motions,
        *,
        sensors: Iterable[Sensor] | None = None,
        pose: Pose | None = None,
        priors: Priors | None = None,
        rates: Rates | None = None,
        displacement: float | None = 1e-4,
        slip: float = 1e-4,
    ) -> None:
        self.motions = motions
        self.changes = Changes()
        self.growth = GrowthLog()
        self.visits = Visits(self.changes)
        self.transitions = Transition()
        self.pose = pose or (Lattice() if motions.placed else NoPose())
        if isinstance(self.pose, Lattice) and not motions.placed:
            raise CogmapError("pose: these actions have no displacements, so places have no positions; give NoPose()")
        self.displacement = None if displacement is None else Displacement(displacement)
        given = [Sight(), Ways()] if sensors is None else list(sensors)
        self.sensors = {sensor.name: sensor for sensor in given}
        if len(self.sensors) < len(given):
            raise CogmapError("sensors: two have the same name; give each its own key in observations")
        self.sights_sensed = tuple(sensor for sensor in given if isinstance(sensor, Sight))
        self._context = context = Context(
            motions, priors or Priors(), rates or Rates(), self.changes, self.growth, self.visits, slip
        )
        for factor in (self.displacement, self.transitions, self.pose):
            if factor is not None:
                factor.attach(context)
        for sensor in given:
            sensor.join(context, self.transitions)
        blank = SparseDirichlet(name="A_o", slots=1, background=1.0, outcomes=1)
        self.A_o = self.sights_sensed[0].table if self.sights_sensed else blank
        self.A_p, self.B_s = self.pose.table, self.transitions.table
        self._size = 0

    @property
    def priors(self) -> Priors:
        """Concentrations before evidence."""
        return self._context.priors

    @property
    def rates(self) -> Rates:
        """Counts that a piece of evidence adds."""
        return self._context.rates

    @property
    def factors(self) -> tuple[ModelFactor, ...]:
        """All of eq. 1, in the order in which the window's graph has them."""
        moved = () if self.displacement is None else (self.displacement,)
        return (*moved, self.transitions, self.pose, *self.sensors.values())

    @property
    def places(self) -> range:
        """The places, by number."""
        return range(self._size)

    def likelihoods(self, places: Ints, percept: Percept) -> Floats:
        """`[n, F]` P(reading | s) of each sensor that sensed something, in order."""
        told = np.empty((len(places), len(percept.readings)))
        for at, (name, reading) in enumerate(percept.readings.items()):
            told[:, at] = self.sensors[name].likelihood(places, reading)
        return told

    def log_likelihood(self, places: Ints, percept: Percept) -> Floats:
        """`[n]` log P(readings | s), in nats."""
        told = (self.sensors[name].log_likelihood(places, reading) for name, reading in percept.readings.items())
        return sum(told, np.zeros(len(places)))

    def log_predictive(self, percept: Percept) -> float:
        """Log P(readings) in a place of which nothing is known, in nats."""
        return sum(self.sensors[name].log_predictive(reading) for name, reading in percept.readings.items())

    def candidates(self, percept: Percept) -> tuple[Ints, float] | None:
        """The visited places that may show what is sensed, and a bound on its probability in each besides.

        As the sensor that has the fewest of them says; None where no sensor can tell.
        """
        told = (self.sensors[name].candidates(reading) for name, reading in percept.readings.items())
        return min((found for found in told if found is not None), key=lambda found: len(found[0]), default=None)

    # -- growing -------------------------------------------------------------------------------------------

    def new_place(
        self, position: Position | None = None, *, step: int, source: int | None = None, action: int | None = None
    ) -> int:
        """Append a place: a value of s of which nothing is known but its position, or the way from `source` to it.

        One that was imagined, and to which no way leads any more, is taken first.

        Raises:
            CogmapError: there is a place at that position already.
        """
        if position is not None and self.pose.place_at(position) is not None:
            there = self.pose.place_at(position)
            raise CogmapError(f"map: position {position} has place {there} already; use place_at")
        spare = self.pose.spare() if position is None and source is not None else None
        place = self._size if spare is None else spare
        if spare is None:
            self.changes.append(Change(self, place, False, True))  # first, so that what is half done can be undone
            self.put(place, True)
            shown = position if position is None or len(position) == len(self.motions.displacements[0]) else None
            self._log(step, "place", place, shown, source, action)
        if position is not None:
            self._settle(place, position, step)
        elif source is not None and action is not None:
            self.transitions.link(source, action, place)
            if self.motions.inverse[action] >= 0:
                self.transitions.link(place, self.motions.inverse[action], source)
            self.pose.imagine(place, source, action)
        return place

    def bind(
        self, place: int, position: Position, *, step: int, source: int | None = None, action: int | None = None
    ) -> None:
        """Give a place that had none its position (static growth).

        Raises:
            CogmapError: there is no such place, or it has a position.
        """
        self.check_place(place)
        if (known := self.pose.position(place)) is not None:
            raise CogmapError(f"map: place {place} has position {known} already")
        self._settle(place, position, step)
        self._log(step, "bind", place, position, source, action)

    def _settle(self, place: int, position: Position, step: int) -> None:
        self.pose.settle(place, position, step=step)
        for action, neighbour in self.pose.neighbours(place):
            self.transitions.link(place, action, neighbour)
            self.transitions.link(neighbour, self.motions.inverse[action], place)

    def unsensed_ways(self) -> Ways:
        """What teaches the transitions which ways are open, where no sensor of the model does."""
        ways = Ways()
        ways.join(self._context, self.transitions)
        return ways

    def mark_visited(self, place: int) -> None:
        """Note that the agent was in `place`."""
        self.visits.note(place)

    def grow_time(self, *, step: int) -> None:
        """Log that the variables and factors of a time step were added."""
        self._log(step, "time", step)

    def _log(
        self,
        step: int,
        kind: GrowthKind,
        index: int,
        label: Hashable = None,
        source: int | None = None,
        action: int | None = None,
    ) -> None:
        self._context.grown(GrowthEvent(step, kind, index, label, source, action))

    def check_place(self, place: int) -> None:
        """Raise `CogmapError` where there is no such place."""
        if place not in self.places:
            raise CogmapError(f"map: there is no place {place!r}; places are 0 to {self._size - 1}")

    # -- learning ------------------------------------------------------------------------------------------

    def learn(self, place: int, readings: Mapping[str, Any], weight: float) -> None:
        """What was sensed in `place`, as far as the agent is certain (`weight`)."""
        for name, reading in readings.items():
            self.sensors[name].learn(place, reading, weight)
        self.pose.learn(place, weight)

    def recall(self, places: Sequence[int]) -> None:
        """What is known of new places from elsewhere."""
        for place in places:
            for sensor in self.sensors.values():
                sensor.recall(place)

    # -- the log of changes --------------------------------------------------------------------------------

    @property
    def stores(self) -> tuple[Store, ...]:
        """All that the log of changes may speak of."""
        return (self, self.visits, *(store for factor in self.factors for store in factor.stores))

    def put(self, where: int, value: bool) -> None:
        """Append the next place, or drop the last one, without telling the log."""
        self.resize(where + value)
        for factor in self.factors:
            factor.grow(self._size)

    def resize(self, places: int) -> None:
        """Have so many places; its factors have been grown already."""
        self._size = places
        self.visits.resize(places)
        if not self.sights_sensed:
            self.A_o.resize(places)

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Nothing: see `state`."""

    def state(self) -> dict[str, NDArray[Any]]:
        """Nothing: how many places there are is known from the factors."""
        return {}

    def touched(self, where: int) -> Iterable[int]:
        """The place itself."""
        return (where,)

    def changed_places(self, cursor: int, *stores: Store) -> tuple[set[int] | None, int]:
        """The places of which something has changed since `cursor`, None for any of them, and the cursor to go on from.

        Args:
            cursor: what the last call gave; -1 at first.
            stores: only what changed in these, such as `map.B_s`, and places that came or went.
        """
        entries, cursor = self.changes.since(cursor)
        changed: set[int] = set()
        for entry in entries or ():
            if isinstance(entry, Change) and (not stores or entry.store in stores or entry.store is self):
                of = entry.store.touched(entry.where)
                if of is None:
                    return None, cursor
                changed.update(of)
        return (None if entries is None else changed), cursor

    def blank(self, place: int) -> None:
        """Know nothing of a place any more but that it exists, and where."""
        for factor in self.factors:
            if factor is not self.pose:
                factor.blank(place)

    def clear(self, *, step: int, first: int = 0) -> None:
        """Take all places from `first` on away; labels and positions that were met stay in their domains.

        Those of them that were visited have to be the last that were.
        """
        before = self._size
        while len(self.visits.order) and self.visits.order.values[-1] >= first:
            self.visits.forget()
        for place in reversed(range(first, before)):
            self.blank(place)
            self.pose.blank(place)
            self.changes.append(Change(self, place, True, False))
            self.put(place, False)
        self._log(step, "retract", before - first)
