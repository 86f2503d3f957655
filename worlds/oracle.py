"""Exact oracles: the shortest way between two rooms, the shortest walk through all of them."""

from __future__ import annotations

from collections.abc import Collection

from .covering import search
from .errors import WorldError
from .maze import Maze, Position, name_rooms

LIMIT = 50_000  # some seconds


def shortest_path(maze: Maze, a: Position, b: Position, *, closed: Collection[Position] = ()) -> list[Position]:
    """A shortest list of rooms from `a` to `b`, both included, that enters no room of `closed`.

    Raises:
        WorldError: no such room, or no way.
    """
    maze.neighbours(b)
    before: dict[Position, Position] = {a: a}
    edge = [a]
    for room in edge:  # grows while it is read: breadth first
        for other in maze.neighbours(room):
            if other not in before and other not in closed:
                before[other] = room
                edge.append(other)
    if b not in before:
        raise WorldError(f"no way from {a} to {b} with {name_rooms(tuple(sorted(closed)))} closed; open one")
    path = [b]
    while path[-1] != a:
        path.append(before[path[-1]])
    return path[::-1]


def covering_walk(maze: Maze, start: Position, *, limit: int = LIMIT) -> tuple[Position, ...] | None:
    """A shortest walk from `start` that visits every room, as the rooms in order, `start` first.

    Exact. Where the maze is a tree it has 2(n - 1) - eccentricity(start) steps; otherwise A* over
    (room, visited rooms) finds it.

    Args:
        maze: the layout, everything open.
        start: the first room.
        limit: most search states to expand; past it the oracle is out of reach and the answer is None.

    Raises:
        WorldError: no such room, or a limit below 1.
    """
    maze.neighbours(start)
    if limit < 1:
        raise WorldError(f"the oracle's limit is {limit}; use at least 1")
    if len(maze.doors) == len(maze.rooms) - 1:
        return _tree_walk(maze, start)
    number = {room: i for i, room in enumerate(maze.rooms)}
    doors = [[number[other] for other in maze.neighbours(room)] for room in maze.rooms]
    colours = [(row + column) % 2 for row, column in maze.rooms]
    walk = search(doors, colours, number[start], limit=limit)
    return None if walk is None else tuple(maze.rooms[i] for i in walk)


def covering_steps(maze: Maze, start: Position, *, limit: int = LIMIT) -> int | None:
    """The steps of `covering_walk`; None where it is out of reach."""
    walk = covering_walk(maze, start, limit=limit)
    return None if walk is None else len(walk) - 1


def _tree_walk(maze: Maze, start: Position) -> tuple[Position, ...]:
    # every branch off the way to the farthest room is walked there and back, that way only there
    order, before = _breadth_first(maze, start)
    spine = shortest_path(maze, start, order[-1])
    walk: list[Position] = []
    for here, ahead in zip(spine, [*spine[1:], None], strict=True):
        walk.extend(_there_and_back(maze, here, skip={before[here], ahead}))
    return tuple(walk)


def _breadth_first(maze: Maze, start: Position) -> tuple[list[Position], dict[Position, Position | None]]:
    order: list[Position] = [start]
    before: dict[Position, Position | None] = {start: None}
    for room in order:
        new = [other for other in maze.neighbours(room) if other not in before]
        before.update((other, room) for other in new)
        order.extend(new)
    return order, before


def _there_and_back(maze: Maze, root: Position, *, skip: set[Position | None]) -> list[Position]:
    walk, trail = [root], [root]
    seen: set[Position | None] = {root, *skip}
    while trail:
        new = [other for other in maze.neighbours(trail[-1]) if other not in seen]
        if new:
            trail.append(new[0])
            seen.add(new[0])
        else:
            trail.pop()
        walk.extend(trail[-1:])
    return walk
