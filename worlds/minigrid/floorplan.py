"""A maze laid out in tiles: rooms of floor, passages between them, a door in each."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import WorldError
from ..maze import Maze, Position
from .geometry import Geometry

Tile = tuple[int, int]
"""(x, y): x to the right, y downwards, as MiniGrid has them."""


@dataclass(frozen=True, slots=True)
class Passage:
    """What joins two rooms."""

    rooms: tuple[Position, Position]  # the two, in row-major order
    tiles: tuple[Tile, ...]  # from the one to the other, floors of rooms left out
    door: Tile  # the tile of the door
    locked: bool = False  # whether it takes a key


@dataclass(frozen=True)
class Floorplan:
    """Where everything is.

    Attributes:
        maze: what is laid out.
        width, height: of the whole, in tiles.
        rooms: (x, y, width, height) of the floor of each room.
        passages: one a door of the maze.
    """

    maze: Maze
    width: int
    height: int
    rooms: dict[Position, tuple[int, int, int, int]]
    passages: tuple[Passage, ...]

    def floor(self, room: Position) -> tuple[Tile, ...]:
        """The tiles of a room's floor."""
        x, y, width, height = self.rooms[room]
        return tuple((x + i, y + j) for j in range(height) for i in range(width))

    def room_at(self, tile: Tile) -> Position | None:
        """The room of whose floor this is a tile; None of walls and passages."""
        for room, (x, y, width, height) in self.rooms.items():
            if x <= tile[0] < x + width and y <= tile[1] < y + height:
                return room
        return None

    def tiles(self) -> NDArray[np.bool_]:
        """`[x, y]` the tiles that count as seen or not: floors, passages, and the walls around them."""
        free = np.zeros((self.width, self.height), dtype=np.bool_)
        for x, y, width, height in self.rooms.values():
            free[x : x + width, y : y + height] = True
        for passage in self.passages:
            free[tuple(zip(*passage.tiles, strict=True))] = True
        around = np.zeros_like(free)
        for i in (-1, 0, 1):
            for j in (-1, 0, 1):
                around |= np.roll(free, (i, j), axis=(0, 1))
        return around


def size_of(maze: Maze, geometry: Geometry) -> tuple[int, int]:
    """Width and height in tiles, walls at the edge included."""
    rows, columns = maze.shape
    wide, high = ((n * geometry.most + (n - 1) * geometry.passage + 2) for n in (columns, rows))
    return max(wide, 3), max(high, 3)


def draw_floorplan(maze: Maze, geometry: Geometry, rng: np.random.Generator) -> Floorplan:
    """Lay a maze out: sizes and places of rooms, where passages leave, and which doors are locked are drawn.

    A room holds the middle of its cell, so two neighbours have some floor in common: a passage is where they do.

    Raises:
        WorldError: so many doors cannot be locked with every room reachable.
    """
    rooms = {room: _room(room, geometry, rng) for room in maze.rooms}
    locked = _locked(maze, geometry.locked, rng)
    passages = tuple(_passage(pair, rooms, geometry, rng, locked=pair in locked) for pair in maze.doors)
    return Floorplan(maze, *size_of(maze, geometry), rooms, passages)


def _room(room: Position, geometry: Geometry, rng: np.random.Generator) -> tuple[int, int, int, int]:
    pitch, middle = geometry.most + geometry.passage, geometry.most // 2
    width, height = (int(rng.integers(geometry.least, geometry.most + 1)) for _ in range(2))
    lows = [
        1 + cell * pitch + int(rng.integers(max(0, middle - size + 1), min(middle, geometry.most - size) + 1))
        for cell, size in ((room[1], width), (room[0], height))
    ]
    return lows[0], lows[1], width, height


def _passage(
    pair: tuple[Position, Position],
    rooms: dict[Position, tuple[int, int, int, int]],
    geometry: Geometry,
    rng: np.random.Generator,
    *,
    locked: bool,
) -> Passage:
    """Straight, where both rooms have floor; drawn evenly."""
    (x0, y0, w0, h0), (x1, y1, w1, h1) = rooms[pair[0]], rooms[pair[1]]
    if pair[0][0] == pair[1][0]:
        y = int(rng.integers(max(y0, y1), min(y0 + h0, y1 + h1)))
        tiles = tuple((x, y) for x in range(x0 + w0, x1))
    else:
        x = int(rng.integers(max(x0, x1), min(x0 + w0, x1 + w1)))
        tiles = tuple((x, y) for y in range(y0 + h0, y1))
    at = len(tiles) // 2 if geometry.door == "middle" else int(rng.integers(len(tiles)))
    return Passage(pair, tiles, tiles[at], locked)


def _locked(maze: Maze, count: int, rng: np.random.Generator) -> set[tuple[Position, Position]]:
    """Doors to lock: none that is the only way to a room."""
    import networkx as nx

    graph, locked = maze.to_networkx(), set[tuple[Position, Position]]()
    doors = [maze.doors[i] for i in rng.permutation(len(maze.doors))] if count else []
    for door in doors:
        if len(locked) == count:
            break
        graph.remove_edge(*door)
        if nx.has_path(graph, *door):
            locked.add(door)
        else:
            graph.add_edge(*door)
    if len(locked) < count:
        most = f"{len(locked)} doors of maze {maze.name!r} can be locked with every room reachable"
        raise WorldError(f"geometry: locked is {count}, and {most}; lock fewer")
    return locked
