"""The layout of a maze: rooms on a grid, a sight in each, a door between adjacent rooms unless a wall stands there."""

from __future__ import annotations

import operator
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from itertools import chain
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from .errors import WorldError
from .motions import GRID, Motions

if TYPE_CHECKING:
    import networkx as nx

Position = tuple[int, int]
Label = int | str
Door = tuple[Position, Position]

LARGEST_LABEL = 2**31 - 1


@dataclass(frozen=True, slots=True)
class Maze:
    """An immutable maze.

    Attributes:
        name: what the maze is called in results and errors.
        sights: the label seen in each room, by (row, column); all whole numbers >= 0 or all words.
        walls: the pairs of adjacent rooms that have no door, in row-major order.
        rooms: the rooms in row-major order.

    Raises:
        WorldError: no rooms, rooms that cannot be reached from one another (`UnreachableError`), bad positions or
            labels, walls that are not between adjacent rooms.
    """

    name: str
    sights: Mapping[Position, Label]
    walls: frozenset[Door] = frozenset()
    rooms: tuple[Position, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        if not self.sights:
            raise WorldError(f"maze {self.name!r} has no rooms; give at least one")
        sights = _labels(self.name, _positions(self.name, self.sights))
        object.__setattr__(self, "sights", MappingProxyType(sights))
        object.__setattr__(self, "rooms", tuple(sorted(sights)))
        object.__setattr__(self, "walls", _walls(self.name, self.walls, sights))
        if lost := _unreachable(self.rooms, self.walls):
            raise UnreachableError(f"maze {self.name!r}", lost)

    def __hash__(self) -> int:
        return hash((self.name, tuple(self.sights[room] for room in self.rooms), self.rooms, self.walls))

    def __reduce__(self) -> tuple[type[Maze], tuple[str, dict[Position, Label], frozenset[Door]]]:
        # a MappingProxyType cannot be pickled
        return Maze, (self.name, dict(self.sights), self.walls)

    @property
    def motions(self) -> Motions:
        """The actions of an agent there: `GRID`."""
        return GRID

    @property
    def places(self) -> tuple[Position, ...]:
        """The rooms, as charts call them."""
        return self.rooms

    @property
    def positions(self) -> Mapping[Position, tuple[float, ...]]:
        """Each room at (column, -row), so that `up` is up."""
        return {(row, column): (float(column), -float(row)) for row, column in self.rooms}

    def find(self, place: Any) -> Position:
        """`place` as a room of this maze.

        Raises:
            WorldError: no such room.
        """
        try:
            row, column = place
            room = (int(row), int(column))
        except (TypeError, ValueError, OverflowError) as error:
            raise WorldError(f"{place!r} is no room; use (row, column)") from error
        if room != (row, column) or room not in self.sights:
            raise WorldError(f"maze {self.name!r} has no room at {(row, column)}; see maze.rooms")
        return room

    def exits(self, place: Position) -> dict[str, Position | None]:
        """The room that each action leads to; None where a wall is.

        Raises:
            WorldError: there is no such room.
        """
        if place not in self.sights:
            raise WorldError(f"maze {self.name!r} has no room at {place}; see maze.rooms")
        row, column = place
        found: dict[str, Position | None] = {}
        for name, (down, right) in zip(GRID.names, GRID.displacements, strict=True):
            ahead = (row + down, column + right)
            found[name] = ahead if ahead in self.sights and not self.walled(place, ahead) else None
        return found

    def successors(self, place: Position) -> dict[str, Position]:
        """The room that each action leads to; walls lead back.

        Raises:
            WorldError: there is no such room.
        """
        return {name: place if room is None else room for name, room in self.exits(place).items()}

    def length(self, place: Position, way: str) -> float:
        """1 of a way to another room, 0 of any other action."""
        return float(self.exits(place)[way] not in (None, place))

    def walled(self, a: Position, b: Position) -> bool:
        """Whether a wall stands between rooms `a` and `b`, which lie side by side."""
        return bool(self.walls) and ((a, b) if a < b else (b, a)) in self.walls

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of the grid that holds every room."""
        return max(row for row, _ in self.rooms) + 1, max(column for _, column in self.rooms) + 1

    @property
    def doors(self) -> tuple[Door, ...]:
        """Every door once, as a pair of rooms in row-major order."""
        pairs = ((a, b) for a in self.rooms for b in _around(a) if a < b and b in self.sights)
        return tuple(pair for pair in pairs if pair not in self.walls)

    def neighbours(self, room: Position) -> tuple[Position, ...]:
        """The rooms behind the doors of `room`, in the order up, down, left, right.

        Raises:
            WorldError: there is no such room.
        """
        return tuple(other for other in self.exits(room).values() if other not in (None, room))

    def to_networkx(self) -> nx.Graph[Position]:
        """An undirected graph: a node a room with attribute `sight`, an edge a door."""
        import networkx as nx

        graph: nx.Graph[Position] = nx.Graph(name=self.name)
        graph.add_nodes_from((room, {"sight": self.sights[room]}) for room in self.rooms)
        graph.add_edges_from(self.doors)
        return graph


class UnreachableError(WorldError):
    """Some rooms cannot be reached from the rest.

    Attributes:
        rooms: those outside the largest connected part, in row-major order.
    """

    def __init__(self, where: str, rooms: tuple[Position, ...]) -> None:
        super().__init__(where, rooms)
        self.where, self.rooms = where, rooms

    def __str__(self) -> str:
        return f"{self.where}: {_name_rooms(self.rooms)} cannot be reached from the rest; join or remove them"


def _unreachable(rooms: tuple[Position, ...], walls: frozenset[Door]) -> tuple[Position, ...]:
    """The rooms outside the largest connected part, in row-major order."""
    left = set(rooms)
    parts = [_part(left, walls, start) for start in rooms if start in left]
    parts.sort(key=len, reverse=True)
    return tuple(sorted(room for part in parts[1:] for room in part))


def _name_rooms(rooms: tuple[Position, ...], *, most: int = 8) -> str:
    """'room (0, 1)' or 'rooms (0, 1), (0, 2), ... and 3 more', for messages."""
    named = ", ".join(str(room) for room in rooms[:most])
    more = f" and {len(rooms) - most} more" if len(rooms) > most else ""
    return f"room{'s' if len(rooms) > 1 else ''} {named}{more}"


def _around(room: Position) -> tuple[Position, ...]:
    row, column = room
    return tuple((row + down, column + right) for down, right in GRID.displacements if down or right)


def _part(left: set[Position], walls: frozenset[Door], start: Position) -> list[Position]:
    """The rooms connected with `start`, which are taken out of `left`."""
    left.discard(start)
    found = [start]
    for at in found:  # grows while it is read
        row, column = at
        for room in ((row - 1, column), (row + 1, column), (row, column - 1), (row, column + 1)):
            if room in left and not (walls and ((at, room) if at < room else (room, at)) in walls):
                left.discard(room)
                found.append(room)
    return found


def _walls(name: str, walls: Iterable[Any], sights: Mapping[Position, Any]) -> frozenset[Door]:
    found: set[Door] = set()
    for wall in walls:
        rooms = sorted(_position(name, room) for room in wall)
        if len(rooms) != 2 or not sights.keys() >= set(rooms) or rooms[1] not in _around(rooms[0]):
            raise WorldError(f"maze {name!r}: {wall!r} is no wall; give two adjacent rooms (row, column)")
        found.add((rooms[0], rooms[1]))
    return frozenset(found)


def _positions(name: str, sights: Mapping[Any, Any]) -> dict[Position, Any]:
    plain = set(map(type, sights)) == {tuple} and set(map(len, sights)) == {2}
    if plain and set(map(type, chain.from_iterable(sights))) == {int} and min(chain.from_iterable(sights)) >= 0:
        return dict(sights)  # as they should be: a million are checked in a second
    return {_position(name, room): label for room, label in sights.items()}


def _position(name: str, room: Any) -> Position:
    try:
        row, column = (operator.index(x) for x in room)
    except (TypeError, ValueError) as error:
        raise WorldError(f"maze {name!r}: {room!r} is no position; use (row, column), whole numbers") from error
    if row < 0 or column < 0:
        raise WorldError(f"maze {name!r}: room {room} lies off the grid; rows and columns count from 0")
    return row, column


def _labels(name: str, sights: dict[Position, Any]) -> dict[Position, Label]:
    kinds = set(map(type, sights.values()))
    if kinds == {int} and min(sights.values()) >= 0 and max(sights.values()) <= LARGEST_LABEL:
        return sights
    if all(issubclass(kind, str) for kind in kinds):
        bad = {label for label in set(sights.values()) if not _is_word(label)}
        for room, label in sights.items() if bad else ():
            if label in bad:
                raise WorldError(f"maze {name!r}: label {label!r} of room {room} is no word; use one without spaces")
        return sights
    return {room: _number(name, room, label) for room, label in sights.items()}


def _is_word(label: str) -> bool:
    return bool(label) and label.isprintable() and len(label.split()) == 1 and label == label.strip()


def _number(name: str, room: Position, label: Any) -> int:
    try:
        number = -1 if isinstance(label, bool) else operator.index(label)
    except TypeError:
        number = -1
    if not 0 <= number <= LARGEST_LABEL:
        raise WorldError(
            f"maze {name!r}: label {label!r} of room {room} does not fit; "
            f"use whole numbers from 0 to {LARGEST_LABEL} in every room, or a word in every room"
        )
    return number
