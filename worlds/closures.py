"""Which rooms and doors of a maze are closed at present."""

from __future__ import annotations

from typing import Any

from .errors import WorldError
from .maze import Door, Maze, Position
from .motions import GRID


class Closures:
    """The closed rooms and doors of a maze, and the ways that are left.

    Attributes:
        rooms: closed rooms.
        doors: doors closed by themselves, as pairs in row-major order.
    """

    def __init__(self, maze: Maze) -> None:
        self._maze = maze
        self.rooms: set[Position] = set()
        self.doors: set[Door] = set()

    def exits(self, room: Position) -> tuple[Position | None, ...]:
        """Where each action leads from `room`; None where a wall or a closed door is in the way."""
        row, column = room
        ahead = [(row + down, column + right) for down, right in GRID.displacements]
        return tuple(other if self._passable(room, other) else None for other in ahead)

    def room(self, room: Any) -> Position:
        """`room` as a position of the maze.

        Raises:
            WorldError: no such room.
        """
        try:
            row, column = room
            place = (int(row), int(column))
        except (TypeError, ValueError, OverflowError) as error:
            raise WorldError(f"{room!r} is no room; use (row, column)") from error
        if place != (row, column) or place not in self._maze.sights:
            raise WorldError(f"maze {self._maze.name!r} has no room at {(row, column)}; see maze.rooms")
        return place

    def enterable(self, room: Any) -> Position:
        """`room` as a position of the maze the agent can be put in.

        Raises:
            WorldError: no such room, or it is closed.
        """
        place = self.room(room)
        if place in self.rooms:
            raise WorldError(f"room {place} of {self._maze.name!r} is closed; open it or choose another")
        return place

    def door(self, a: Any, b: Any) -> Door:
        """The door between two rooms, in row-major order.

        Raises:
            WorldError: no such rooms, or no door between them.
        """
        first, second = sorted((self.room(a), self.room(b)))
        if abs(first[0] - second[0]) + abs(first[1] - second[1]) != 1:
            raise WorldError(f"there is no door between {first} and {second}; only adjacent rooms have one")
        return first, second

    def _passable(self, room: Position, other: Position) -> bool:
        if other == room:
            return True
        if other not in self._maze.sights or room in self.rooms or other in self.rooms:
            return False
        return not self.doors or ((room, other) if room < other else (other, room)) not in self.doors
