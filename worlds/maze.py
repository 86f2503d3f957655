"""The layout of a maze: rooms on a grid, a sight in each, a door between adjacent rooms unless a wall stands there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from .errors import WorldError
from .maze_checks import (
    Door,
    Label,
    Position,
    UnreachableError,
    around,
    checked_labels,
    checked_positions,
    checked_walls,
    unreachable,
)
from .maze_svg import maze_svg
from .motions import GRID, Motions

if TYPE_CHECKING:
    import networkx as nx


@dataclass(frozen=True, slots=True)
class Maze:
    """An immutable maze.

    Raises:
        WorldError: no rooms, rooms that cannot be reached from one another (`UnreachableError`), bad positions or
            labels, walls that are not between adjacent rooms.
    """

    name: str  # what the maze is called in results and errors
    # the label seen in each room, by (row, column); all whole numbers >= 0 or all words
    sights: Mapping[Position, Label]
    walls: frozenset[Door] = frozenset()  # the pairs of adjacent rooms that have no door, in row-major order
    rooms: tuple[Position, ...] = field(init=False, repr=False, compare=False)  # the rooms in row-major order

    def __post_init__(self) -> None:
        if not self.sights:
            raise WorldError(f"maze {self.name!r} has no rooms; give at least one")
        sights = checked_labels(self.name, checked_positions(self.name, self.sights))
        object.__setattr__(self, "sights", MappingProxyType(sights))
        object.__setattr__(self, "rooms", tuple(sorted(sights)))
        object.__setattr__(self, "walls", checked_walls(self.name, self.walls, sights))
        if lost := unreachable(self.rooms, self.walls):
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
        """`place` as a room of this maze. Raises WorldError: no such room."""
        try:
            row, column = place
            room = (int(row), int(column))
        except (TypeError, ValueError, OverflowError) as error:
            raise WorldError(f"{place!r} is no room; use (row, column)") from error
        if room != (row, column) or room not in self.sights:
            raise WorldError(f"maze {self.name!r} has no room at {(row, column)}; see maze.rooms")
        return room

    def exits(self, place: Position) -> dict[str, Position | None]:
        """The room that each action leads to; None where a wall is. Raises WorldError: there is no such room."""
        if place not in self.sights:
            raise WorldError(f"maze {self.name!r} has no room at {place}; see maze.rooms")
        row, column = place
        found: dict[str, Position | None] = {}
        for name, (down, right) in zip(GRID.names, GRID.displacements, strict=True):
            ahead = (row + down, column + right)
            found[name] = ahead if ahead in self.sights and not self.walled(place, ahead) else None
        return found

    def successors(self, place: Position) -> dict[str, Position]:
        """The room that each action leads to; walls lead back. Raises WorldError: there is no such room."""
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
        pairs = ((a, b) for a in self.rooms for b in around(a) if a < b and b in self.sights)
        return tuple(pair for pair in pairs if pair not in self.walls)

    def neighbours(self, room: Position) -> tuple[Position, ...]:
        """The rooms behind the doors of `room`, in the order up, down, left, right.

        Raises:
            WorldError: there is no such room.
        """
        return tuple(other for other in self.exits(room).values() if other not in (None, room))

    def to_networkx(self) -> nx.Graph[Position]:
        """An undirected graph: a node a room with attributes `sight` and `position`, an edge a door.

        `Agent(motions, map=...)` takes it for a map.
        """
        import networkx as nx

        graph: nx.Graph[Position] = nx.Graph(name=self.name)
        graph.add_nodes_from((room, {"sight": self.sights[room], "position": room}) for room in self.rooms)
        graph.add_edges_from(self.doors)
        return graph

    def __repr__(self) -> str:
        rows, columns = self.shape
        return f"Maze({self.name!r}, {len(self.rooms)} rooms in {rows} x {columns}, {len(self.doors)} doors)"

    def _repr_svg_(self) -> str | None:
        return maze_svg(self.name, self.sights, self.doors)
