"""The cognitive map: places, positions and sights, and the tables that tie them together."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .changes import Change, Changes, Store
from .column import Column
from .dirichlet import EMPTY, SparseDirichlet
from .domain import Domain
from .errors import CogmapError
from .growth_event import GrowthEvent, GrowthKind
from .motions import Motions, Position
from .sight_index import SightIndex
from .visits import Visits

if TYPE_CHECKING:
    from networkx import MultiDiGraph
    from pandas import DataFrame

    from .graph import LabelledTable

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ELSEWHERE = -1
"""Successor that is no place of the map yet."""

UNKNOWN, OPEN, BLOCKED = 0, 1, 2
"""What was last sensed of a door."""


@dataclass(frozen=True, slots=True)
class Priors:
    """Concentrations before any evidence.

    Attributes:
        sight: of each sight in a column of A_o. Small: a room has one sight, it is only unknown which; after
            one look the probability of another sight is about this, so that one contradiction is telling.
        position: of a place's own position in A_p; every other position has none.
        transition: of each way a door can turn out (blocked, or the place beyond) in B_s. Well below one, since a
            door is either open or not; how far below matters little (docs/decisions).
        door_floor: a door is never believed open or blocked beyond `1 - door_floor`.
    """

    sight: float = 1e-9
    position: float = 1.0
    transition: float = 1e-6
    door_floor: float = 1e-6


class CognitiveMap:
    """What the agent believes the world to be; it grows, and takes back only what it grew by mistake.

    Places are numbered as they are imagined. `sights` and `positions` are labelled domains. The tables hold
    sparse Dirichlet counts: `A_o` P(o | s) and `A_p` P(p | s), a row a place; `B_s` P(s' | s, a), row
    `place * len(motions) + action`. `A()`, `positions_given_places()` and `B()` give them as dense arrays.
    The motion model B_p is not learned: `position_beyond` is p + displacement(a).
    """

    name = "places"

    def __init__(self, motions: Motions, *, priors: Priors | None = None) -> None:
        self.motions = motions
        self.priors = priors or Priors()
        self.sights = Domain("sights")
        self.positions = Domain("positions")
        self.changes = log = Changes()
        size = len(motions)
        self.A_o = SparseDirichlet(name="A_o", slots=1, background=self.priors.sight, outcomes=1, changes=log)
        self.A_p = SparseDirichlet(name="A_p", slots=1, changes=log)
        self.B_s = SparseDirichlet(name="B_s", slots=2, rows_each=size, changes=log)
        self.growth: list[GrowthEvent] = []
        self.visits = Visits(log)
        self._position_of = Column("position_of", np.int64, fill=-1, changes=log)
        self._place_at = Column("place_at", np.int64, fill=-1, changes=log)
        self._beyond = Column("beyond", np.int64, width=size, fill=-1)
        self._sensed = Column("sensed", np.int8, width=size, changes=log)
        self._walked = Column("walked", np.bool_, width=size, changes=log)
        self._by_sight = SightIndex(self)

    # -- reading -------------------------------------------------------------------------------------------

    @property
    def places(self) -> range:
        """The places, by number."""
        return range(len(self.A_o))

    @property
    def visited(self) -> NDArray[np.bool_]:
        """`[S]` whether each place was ever entered."""
        return self.visits.visited.values

    @property
    def visited_places(self) -> Ints:
        """The places ever entered, in the order of their first visit."""
        return self.visits.order.values

    @property
    def first_visit(self) -> Ints:
        """`[S]` index of each place in `visited_places`; -1 where it was never entered."""
        return self.visits.first.values

    @property
    def sensed(self) -> NDArray[np.int8]:
        """`[S, K]` what was last sensed of each door: `UNKNOWN`, `OPEN` or `BLOCKED`."""
        return self._sensed.values

    @property
    def walked(self) -> NDArray[np.bool_]:
        """`[S, K]` whether each transition was ever walked."""
        return self._walked.values

    @property
    def position_index(self) -> Ints:
        """`[S]` the number of each place's position; -1 for a place that has none yet."""
        return self._position_of.values

    @property
    def position_beyond(self) -> Ints:
        """`[P, K]` B_p: the number of the position that each motion leads to; -1 where it has none yet."""
        return self._beyond.values

    @property
    def stores(self) -> tuple[Store, ...]:
        """All that the log of changes speaks of."""
        tables = self.A_o, self.A_p, self.B_s
        return (*tables, self, self.visits, self._position_of, self._place_at, self._sensed, self._walked)

    @property
    def columns(self) -> dict[str, Column]:
        """What is kept a place and a position besides the tables, by name."""
        return {
            "position_of": self._position_of,
            "place_at": self._place_at,
            "beyond": self._beyond,
            "visited": self.visits.visited,
            "visits": self.visits.order,
            "sensed": self._sensed,
            "walked": self._walked,
        }

    def position(self, place: int) -> Position | None:
        """Position of `place` relative to the start; None for a place that has none yet.

        Raises:
            CogmapError: there is no such place.
        """
        self._check(place)
        index = int(self.position_index[place])
        return None if index < 0 else self.positions[index]  # type: ignore[return-value]

    def place_at(self, position: Hashable) -> int | None:
        """The place at `position`, or None."""
        index = self.positions.find(position)
        if index is None or self._place_at.values[index] < 0:
            return None
        return int(self._place_at.values[index])

    def visited_with(self, sight: int) -> tuple[Ints, float]:
        """The visited places that have counts for `sight`, or hardly any, and a bound on A_o[sight, s] elsewhere.

        The bound is for the visited places besides.
        """
        return self._by_sight.places(sight)

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

    def row(self, place: int, action: int) -> int:
        """Row of `B_s` for `place` under `action`."""
        return place * len(self.motions) + action

    def rows(self, places: Ints, action: int) -> Ints:
        """Rows of `B_s` for `places` under `action`."""
        return places * len(self.motions) + action

    def rows_of(self, places: Ints) -> Ints:
        """Rows of `B_s` for `places` under every action, place by place."""
        size = len(self.motions)
        return (places[:, None] * size + np.arange(size)).ravel()

    def blocked(self, places: Ints) -> Floats:
        """`[n, K]` P(blocked | s, a) = B_s[s, s, a], within the floor of the doors; zero for `stay`."""
        size, floor = len(self.motions), self.priors.door_floor
        p = self.B_s.probability(places.repeat(size), self.rows_of(places)).reshape(-1, size)
        np.minimum(np.maximum(p, floor, out=p), 1.0 - floor, out=p)
        p[:, self.motions.stay] = 0.0
        return p

    def doors_likelihood(self, places: Ints, open_: Sequence[bool]) -> Floats:
        """`[n]` c(s) = P(doors as sensed | s), for each of `places`."""
        p = self.blocked(places)
        np.subtract(1.0, p, out=p, where=np.array(open_, dtype=np.bool_))
        p[:, self.motions.stay] = 1.0
        return np.multiply.reduce(p, axis=1)

    def transition(self, next_place: int, place: int, action: int) -> float:
        """P(s' = next_place | s = place, a)."""
        return float(self.B_s.probability(next_place, np.array([self.row(place, action)]))[0])

    def beyond(self, place: int, action: int) -> int | None:
        """The place that `action` most probably leads to from `place` if it is not blocked; None if none is known."""
        alpha = self.B_s.concentrations(self.row(place, action))
        others = [(a, -k, k) for k, a in alpha.items() if k >= 0 and k != place]
        return max(others)[2] if others else None

    def A(self) -> Floats:
        """A_o as an array `[O + 1, S]`; the last row is "a sight never met"."""
        return self.A_o.dense(len(self.sights))

    def positions_given_places(self) -> Floats:
        """A_p as an array `[P + 1, S]`; the last row is "no position yet"."""
        return self.A_p.dense(len(self.positions))

    def B(self) -> Floats:
        """B_s as an array `[S + 1, S, K]` (next, previous, action); the last row is "a place never imagined"."""
        size = len(self.places)
        return self.B_s.dense(size).reshape(size + 1, size, len(self.motions))

    def to_networkx(self) -> MultiDiGraph[Any]:
        """The map as a graph: places with what is known of them, transitions with action and probability."""
        from .map_graph import map_graph

        return map_graph(self)

    def to_dot(self) -> str:
        """The map as Graphviz source; see `map_graph.map_dot`."""
        from .map_graph import map_dot

        return map_dot(self)

    def to_json(self, *, indent: int | None = None) -> str:
        """The map as JSON, in networkx' node-link layout; see `map_graph.map_node_link`."""
        from .map_graph import map_json

        return map_json(self, indent=indent)

    def table(
        self, name: str, *, action: str | int | None = None, places: Sequence[int] | None = None
    ) -> DataFrame | LabelledTable:
        """`A_o`, `A_p`, or `B_s` of one action, with labels on both axes; see `map_tables.map_table`."""
        from .graph import table
        from .map_tables import map_table

        return table(map_table(self, name, action=action, places=places))

    def __repr__(self) -> str:
        seen = int(self.visited.sum())
        return (
            f"CognitiveMap({len(self.places)} places, {seen} visited, "
            f"{len(self.positions)} positions, {len(self.sights)} sights)"
        )

    # -- growing -------------------------------------------------------------------------------------------

    def new_sight(self, label: Hashable, *, step: int) -> int:
        """The number of a sight; the domain of o grows where it was never met."""
        known = self.sights.find(label)
        if known is not None:
            return known
        index = self.sights.add(label)
        self.A_o.outcomes = len(self.sights) + 1
        self._log(step, "sight", index, label)
        return index

    def new_position(self, position: Position, *, step: int) -> int:
        """The number of a position; the domain of p, and B_p, grow where it is new."""
        known = self.positions.find(position)
        if known is not None:
            return known
        index = self.positions.add(position)
        self._place_at.resize(index + 1)
        self._beyond.resize(index + 1)
        for action in range(len(self.motions)):
            there = self.positions.find(self.motions.move(position, action))
            if there is not None:
                self._beyond.values[index, action] = there
                self._beyond.values[there, self.motions.inverse[action]] = index
        self._log(step, "position", index, position)
        return index

    def new_place(
        self, position: Position | None, *, step: int, source: int | None = None, action: int | None = None
    ) -> int:
        """Append a place: a value of s, uniform in A_o, one-hot in A_p, its doors unknown in B_s."""
        if position is not None and self.place_at(position) is not None:
            raise CogmapError(f"map: position {position} has place {self.place_at(position)} already; use place_at")
        place = len(self.places)
        self.put(place, True)
        self.changes.append(Change(self, place, False, True))
        self._log(step, "place", place, position, source, action)
        if position is not None:
            self._settle(place, position, step)
        return place

    def bind(
        self, place: int, position: Position, *, step: int, source: int | None = None, action: int | None = None
    ) -> None:
        """Give a place that had none its position (static growth)."""
        self._check(place)
        if self.position_index[place] >= 0:
            raise CogmapError(f"map: place {place} has position {self.position(place)} already")
        self._settle(place, position, step)
        self._log(step, "bind", place, position, source, action)

    def _settle(self, place: int, position: Position, step: int) -> None:
        index = self.new_position(position, step=step)
        self._position_of.set(place, index)
        self._place_at.set(index, place)
        self.A_p.expect(place, index, self.priors.position)
        for action, neighbour in self._neighbours(index):
            self._link(place, action, neighbour)
            self._link(neighbour, self.motions.inverse[action], place)

    def _neighbours(self, index: int) -> list[tuple[int, int]]:
        """The actions that lead from a position to one that has a place, and that place."""
        ahead = [(action, there) for action, there in enumerate(self.position_beyond[index].tolist()) if there >= 0]
        places = [(action, int(self._place_at.values[there])) for action, there in ahead]
        return [(action, place) for action, place in places if action != self.motions.stay and place >= 0]

    def _link(self, place: int, action: int, neighbour: int) -> None:
        """What lies beyond a door has become a place of the map: its slot gets the name."""
        self.B_s.rename(self.row(place, action), ELSEWHERE, neighbour)

    def put(self, where: int, value: bool) -> None:
        """Append the next place, or drop the last one, without telling the log."""
        places, size = where + value, len(self.motions)
        for table in (self.A_o, self.A_p):
            table.resize(places)
        self.B_s.resize(places * size)
        for column in (self.visits, self._position_of, self._sensed, self._walked):
            column.resize(places)
        if value:
            keys, prior = np.full((size, 2), ELSEWHERE), np.full((size, 2), self.priors.transition)
            keys[:, 0], keys[self.motions.stay, 1], prior[self.motions.stay, 1] = where, EMPTY, 0.0
            self.B_s.begin(slice(where * size, places * size), keys, prior)

    def value(self, numbers: Sequence[float]) -> bool:
        """Whether it exists, from a file."""
        return bool(numbers[0])

    def touched(self, where: int) -> Iterable[int]:
        """The place itself."""
        return (where,)

    def take_back(self, mark: int, *, step: int) -> None:
        """Undo everything since `mark`; sights and positions that were met stay in their domains.

        Raises:
            CogmapError: that is longer ago than the log can undo.
        """
        entries, _ = self.changes.since(mark)
        before = len(self.places)
        grown = [entry for entry in entries or () if isinstance(entry, GrowthEvent) and entry.index < before]
        bound = [
            event.index for event in reversed(grown) if event.kind in ("bind", "place") and event.label is not None
        ]
        lost = [(place, self.position(place)) for place in dict.fromkeys(bound)]
        self.changes.undo(mark)
        for place, position in lost:
            if position is not None:
                self._log(step, "unbind", place, position)
        self._log(step, "retract", before - len(self.places))

    def mark_visited(self, place: int) -> None:
        """Note that the agent was in `place`."""
        self.visits.note(place)

    def note_door(self, place: int, action: int, sensed: int, *, walked: bool = False) -> None:
        """Note what was last sensed of a door, and whether it was walked through now."""
        self._sensed.set((place, action), sensed)
        if walked:
            self._walked.set((place, action), True)

    def restore_columns(self, columns: Mapping[str, NDArray[Any]]) -> None:
        """Take over the values of `columns`, by name."""
        for name, column in self.columns.items():
            if column not in (self.visits.visited, self.visits.order):
                column.restore(columns[name])
        self.visits.restore(columns["visits"], len(columns["visited"]))

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
        event = GrowthEvent(step, kind, index, label, source, action)
        self.growth.append(event)
        self.changes.append(event)

    def _check(self, place: int) -> None:
        if not 0 <= place < len(self.places):
            raise CogmapError(f"map: there is no place {place!r}; places are 0 to {len(self.places) - 1}")
