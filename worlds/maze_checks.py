"""What a maze is checked for when it is made: positions, labels, walls, and that every room can be reached."""

from __future__ import annotations

import operator
from collections.abc import Iterable, Mapping
from itertools import chain
from typing import Any

from .errors import WorldError
from .motions import GRID

Position = tuple[int, int]
Label = int | str
Door = tuple[Position, Position]

LARGEST_LABEL = 2**31 - 1


def around(room: Position) -> tuple[Position, ...]:
    """The four cells next to a room: up, down, left, right."""
    row, column = room
    return tuple((row + down, column + right) for down, right in GRID.displacements if down or right)


class UnreachableError(WorldError):
    """Some rooms cannot be reached from the rest.

    Attributes:
        rooms: those outside the largest connected part, in row-major order.
    """

    def __init__(self, where: str, rooms: tuple[Position, ...]) -> None:
        super().__init__(f"{where}: {_name_rooms(rooms)} cannot be reached from the rest; join or remove them")
        self.where, self.rooms = where, rooms

    def __reduce__(self) -> tuple[type[UnreachableError], tuple[str, tuple[Position, ...]]]:
        return UnreachableError, (self.where, self.rooms)


def unreachable(rooms: tuple[Position, ...], walls: frozenset[Door]) -> tuple[Position, ...]:
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


def checked_walls(name: str, walls: Iterable[Any], sights: Mapping[Position, Any]) -> frozenset[Door]:
    """The walls, each in row-major order; a WorldError if one is not between adjacent rooms."""
    found: set[Door] = set()
    for wall in walls:
        rooms = sorted(_position(name, room) for room in wall)
        if len(rooms) != 2 or not sights.keys() >= set(rooms) or rooms[1] not in around(rooms[0]):
            raise WorldError(f"maze {name!r}: {wall!r} is no wall; give two adjacent rooms (row, column)")
        found.add((rooms[0], rooms[1]))
    return frozenset(found)


def checked_positions(name: str, sights: Mapping[Any, Any]) -> dict[Position, Any]:
    """The same by (row, column) in whole numbers; a WorldError if one is no position on the grid."""
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


def checked_labels(name: str, sights: dict[Position, Any]) -> dict[Position, Label]:
    """The same with labels that are all whole numbers or all words; a WorldError if they are not."""
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
