"""The worlds of the golden walks, by name."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from typing import Any

import numpy as np
from cogmap.worlds import (
    MAZES,
    Maze,
    MazeEnv,
    comb,
    hall,
    labyrinth,
    load_world,
    parse_maze,
    random_maze,
    rings,
    spiral,
)

Room = tuple[int, ...]

HOUSE = """
    porch   hall   study  library
    kitchen hall   hall   library
    pantry  garden .      attic
    cellar  garden garden shed
"""

LINE = {"left": (-1,), "right": (1,), "stay": (0,)}
CUBE = {
    "up": (-1, 0, 0),
    "down": (1, 0, 0),
    "left": (0, -1, 0),
    "right": (0, 1, 0),
    "in": (0, 0, -1),
    "out": (0, 0, 1),
    "stay": (0, 0, 0),
}
STAR = {f"{down:+d}{right:+d}": (down, right) for down in (-1, 0, 1) for right in (-1, 0, 1)}


class Lattice:
    """Rooms in Z^n with motions of one's own; as much of a `MazeEnv` as the walks need."""

    def __init__(self, motions: Mapping[str, Room], sights: Mapping[Room, Hashable]) -> None:
        self.motions = dict(motions)
        self.sights = dict(sights)
        self.position: Room = min(self.sights)
        self.closed_rooms: set[Room] = set()

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        rooms = sorted(self.sights)
        start = (options or {}).get("start")
        self.position = rooms[int(np.random.default_rng(seed).integers(len(rooms)))] if start is None else start
        return self.observe(), {}

    def observe(self) -> dict[str, Any]:
        open_ = [self._beyond(action) is not None for action in range(len(self.motions))]
        return {"sight": self.sights[self.position], "open": open_}

    def step(self, action: int) -> None:
        self.position = self._beyond(action) or self.position

    def displace(self, room: Room) -> None:
        self.position = room

    def _beyond(self, action: int) -> Room | None:
        motion = list(self.motions.values())[action]
        there = tuple(x + dx for x, dx in zip(self.position, motion, strict=True))
        return there if there in self.sights and there not in self.closed_rooms else None


World = MazeEnv | Lattice


def rooms_of(world: World) -> list[Room]:
    """Every room, sorted."""
    return sorted(world.sights if isinstance(world, Lattice) else world.maze.rooms)


def _rng() -> np.random.Generator:
    return np.random.default_rng(7)


def _box(*sides: int, sights: int) -> dict[Room, Hashable]:
    """All cells of a box, their sights drawn."""
    rng = _rng()
    return {tuple(cell): int(rng.integers(sights)) for cell in np.ndindex(*sides)}


def _branch() -> dict[Room, Hashable]:
    """A box of 3 by 3 by 3 with a third of its cells left out."""
    return {cell: sight for cell, sight in _box(3, 3, 3, sights=6).items() if sum(cell) % 3 != 1 or cell[0] == 1}


GENERATED: Mapping[str, Callable[[], Maze]] = {
    "house": lambda: parse_maze(HOUSE, name="house"),
    "random_12": lambda: random_maze(12, rng=_rng()),
    "random_25_alias": lambda: random_maze(25, sights=4, rng=_rng()),
    "comb": lambda: comb(4, 3),
    "comb_alias": lambda: comb(3, 3, sights=3, rng=_rng()),
    "spiral": lambda: spiral(6),
    "rings": lambda: rings(2),
    "rings_alias": lambda: rings(2, sights=4, rng=_rng()),
    "hall": lambda: hall(4, 5, sights=3, rng=_rng()),
    "hall_blank": lambda: hall(6, 6, sights=1, rng=_rng()),
    "labyrinth_100": lambda: labyrinth(100, rng=_rng()),
    "labyrinth_100_loops": lambda: labyrinth(100, loops=0.3, sights=10, rng=_rng()),
}
LATTICES: Mapping[str, Callable[[], Lattice]] = {
    "line": lambda: Lattice(LINE, _box(12, sights=4)),
    "cube": lambda: Lattice(CUBE, _box(2, 3, 3, sights=8)),
    "branch": lambda: Lattice(CUBE, _branch()),
    "star": lambda: Lattice(STAR, _box(3, 4, sights=5)),
}


def world_named(name: str) -> World:
    """A built-in maze, or one of the above."""
    if name in LATTICES:
        return LATTICES[name]()
    return load_world(name) if name in MAZES else MazeEnv(GENERATED[name]())
