"""Which rooms of a maze may be closed on somebody who looks for a goal."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from ..model.errors import CogmapError
from ..worlds import Label, Maze, Position, WorldError, shortest_path


def parse_rooms(maze: Maze, texts: Sequence[str]) -> tuple[Position, ...]:
    """Rooms given as "ROW,COLUMN".

    Raises:
        CogmapError: not of that form, or no such room.
    """
    rooms: list[Position] = []
    for text in texts:
        numbers = text.split(",")
        if len(numbers) != 2 or not all(number.strip().isdecimal() for number in numbers):
            raise CogmapError(f"close: {text!r} is no room; give ROW,COLUMN, such as 0,2")
        rooms.append((int(numbers[0]), int(numbers[1])))
    check_rooms(maze, rooms)
    return tuple(rooms)


def check_rooms(maze: Maze, rooms: Collection[Position]) -> None:
    """Refuse rooms that the maze does not have.

    Raises:
        CogmapError: no such room.
    """
    for room in rooms:
        if room not in maze.sights:
            raise CogmapError(
                f"close: maze {maze.name!r} has no room at {room}; `cogmap worlds {maze.name}` shows them"
            )


def check_closed(maze: Maze, goal: Label, closed: Collection[Position], *, known: bool) -> None:
    """Refuse closures after which the goal could not be reached from every room that is left.

    Raises:
        CogmapError: no such room, no way to the goal, or the maze is not explored first.
    """
    check_rooms(maze, closed)
    if closed and not known:
        raise CogmapError(
            "close: rooms close after exploring, and this agent sets out unexplored; leave one of them out"
        )
    for room in maze.rooms:
        if closed and room not in closed:
            shortest(maze, room, goal, closed)


def shortest(maze: Maze, start: Position, goal: Label, closed: Collection[Position] = ()) -> int:
    """Steps of the shortest path to the nearest room with the label that is open.

    Raises:
        CogmapError: there is no way.
    """
    steps: list[int] = []
    for room in maze.rooms:
        if maze.sights[room] == goal and room not in closed:
            try:
                steps.append(len(shortest_path(maze, start, room, closed=closed)) - 1)
            except WorldError:
                continue
    if not steps:
        rooms = ", ".join(map(str, sorted(closed)))
        raise CogmapError(f"close: with {rooms} closed there is no way from {start} to label {goal!r}; leave one open")
    return min(steps)
