"""What every factor of the generative model offers."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from numpy.typing import NDArray

from ..arrays import Floats, Ints
from ..changes import Changes, Store
from ..dirichlet import SparseDirichlet
from ..errors import CogmapError
from ..growth_event import GrowthEvent
from ..growth_log import GrowthLog
from ..information import KnownInformation
from ..motions import Motions
from ..percept import Percept
from ..rates import Priors, Rates
from ..visits import Visits


@dataclass(frozen=True, slots=True)
class Context:
    """What the factors of one model share."""

    motions: Motions  # the actions
    priors: Priors  # concentrations before evidence
    rates: Rates  # counts that a piece of evidence adds
    changes: Changes  # the log that every factor writes to
    growth: GrowthLog  # what was added to the model
    visits: Visits  # which places were entered
    slip: float  # probability of a slip for poses that are given none
    # what n more observations of a row of counts would teach, looked up where it was met before
    information: KnownInformation = field(default_factory=KnownInformation, compare=False)

    def grown(self, event: GrowthEvent) -> None:
        """Log something that was added."""
        self.growth.append(event)
        self.changes.append(event)

    def forgotten(self, kind: str, sensor: str | None, labels: Sequence[Hashable]) -> None:
        """Labels of a sensor, or positions, are not known any more."""
        self.growth.forget(kind, sensor, labels)


@dataclass(frozen=True, slots=True)
class Successors:
    """The places to which an action may have led from each of `n` places, `[n, slots]`."""

    places: Ints  # s'; negative where a slot is unused, or leads out of the map
    probability: Floats  # B_s[a](s', s)
    coupling: Floats  # what the factors of this step are multiplied by besides, given what is sensed now

    def of(self, rows: Ints) -> Successors:
        """Those of some of the places."""
        return Successors(self.places[rows], self.probability[rows], self.coupling[rows])


@dataclass(frozen=True, slots=True)
class Support:
    """What the factors of one time step are tabulated over: the places and positions that hold mass."""

    step: int  # the time step t
    percept: Percept  # what it brought
    places: Ints  # `[n]` domain of s_t
    positions: Ints  # `[m]` domain of p_t
    before: tuple[Ints, Ints] | None  # the domains of s_t-1 `[n']` and p_t-1 `[m']`; None where the window begins
    likelihoods: Mapping[str, Floats]  # by name of the sensor, `[n]` P(reading | s_t), of all together up to one factor
    arrival: Floats | None  # `[n]` P(s_t | moved_t); None in a model without displacement
    examined: bool  # whether the filter looked at displacement at all
    ahead: Successors | None  # where the action may have led from each of the places before, as the filter had it

    def scope(self, name: str) -> tuple[str, ...]:
        """`name` at t and at t-1, and whether the agent was moved in between where the model has that."""
        now, before = f"{name}{self.step}", f"{name}{self.step - 1}"
        return (now, before) if self.arrival is None else (now, before, f"moved{self.step}")


@dataclass(frozen=True, slots=True)
class Table:
    """A factor of one time step, for the graph of the window."""

    name: str  # its symbol
    scope: tuple[str, ...]  # names of its variables, one an axis
    # the factor itself, or what works it out when it is asked for; must not read what may change
    values: Floats | Callable[[], Floats]
    kind: str  # `sight`, `walls`, `transition`, …, as in `Factor`
    equation: str  # what it says
    observed: tuple[Hashable, ...] = ()  # label of the first variable of its scope, if that is observed
    domain: tuple[Hashable, ...] = ()  # values of the first variable of its scope, if that is a latent of its own

    @property
    def array(self) -> Floats:
        """The factor itself."""
        return self.values() if callable(self.values) else self.values


class ModelFactor:
    """One factor of the generative model (eq. 1), with everything that filter, learning, planning and files need of it.

    A factor belongs to one model from the moment it is attached.

    Attributes:
        name: unique in its model.
        context: what it shares with the others.
    """

    name: str
    _context: Context | None = None

    def attach(self, context: Context) -> None:
        """Make it part of a model. Raises CogmapError: it is part of one already."""
        if self._context is not None:
            raise CogmapError(f"{self.name}: this {type(self).__name__} belongs to another agent; make one for each")
        self._context = context

    @property
    def context(self) -> Context:
        """What it shares with the other factors of its model. Raises CogmapError: it belongs to no model yet."""
        if self._context is None:
            raise CogmapError(f"{self.name}: it belongs to no model yet; give it to an Agent or a CognitiveMap")
        return self._context

    @property
    def stores(self) -> tuple[Store, ...]:
        """What the log of changes may speak of."""
        return ()

    @property
    def options(self) -> dict[str, Any]:
        """What it was made with, as plain JSON values: its class called with them makes another."""
        return {}

    def grow(self, places: int) -> None:
        """Have room for so many places: new ones are appended, or the last are dropped."""

    def blank(self, place: int) -> None:
        """Know nothing of a place any more, as if it was just appended."""
        for store in self.stores:
            if isinstance(store, SparseDirichlet):
                for row in range(place * store.rows_each, (place + 1) * store.rows_each):
                    store.clear(row)

    def savepoint(self) -> Any:
        """What `go_back` needs of it besides its stores. Attributes of a class of your own are copied without it."""
        return None

    def go_back(self, point: Any) -> None:
        """Be as it was, once its stores are."""

    def state(self) -> dict[str, Any]:
        """What a file needs of it besides its stores, as plain JSON values."""
        return {}

    def restore(self, state: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]], places: int) -> None:
        """Take over what `state` gave, and the arrays of its stores (`name.part`), for so many places.

        Raises:
            CogmapError, KeyError: they do not fit.
        """
        self.grow(places)
        for store in self.stores:
            store.restore(parts_of(store, arrays))

    def tables(self, support: Support) -> Iterable[Table]:
        """Its factors at one time step of the window's graph."""
        return ()


def parts_of(store: Store, arrays: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """The state of a store among the arrays of a file."""
    return {part: arrays[f"{store.name}.{part}"] for part in store.state()}
