"""What can be told of a room from what was seen of it: its exits, and what would have to be looked at."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from ..worlds import minigrid as mg
from .room_map import Pose, RoomMap, around

MAYBE = 0.25
"""Probability that a room goes on beyond what was seen from which on that has to be looked at."""

_CONES = [{tuple(tile) for tile in mg.view_offsets(h).reshape(-1, 2).tolist()} for h in range(4)]


class Sizes:
    """How large rooms are, learned from those that were seen whole."""

    def __init__(self) -> None:
        self._seen: list[int] = []

    def learn(self, room: Collection[mg.Tile]) -> None:
        """A room was seen whole."""
        self._seen.extend(_extent(room))

    def goes_on(self, size: int) -> float:
        """Probability that a side of which so much was seen is longer."""
        longer, reached = sum(s > size for s in self._seen), sum(s >= size for s in self._seen)
        return (longer + 0.5) / (reached + 1.0)


@dataclass(frozen=True)
class Outlook:
    """A room as far as it was seen.

    Attributes:
        room: its tiles.
        exits: doors and gaps by direction (0 right, 1 down, 2 left, 3 up), in the order of their place in the wall.
        unknown: tiles beside the room of which nothing is known, by direction.
        needed: for each direction in which no exit is known, the tiles that have to be looked at; empty where there is
            surely none.
    """

    room: frozenset[mg.Tile]
    exits: tuple[tuple[mg.Tile, ...], ...]
    unknown: tuple[frozenset[mg.Tile], ...]
    needed: tuple[frozenset[mg.Tile], ...]

    @property
    def whole(self) -> bool:
        """Whether the room was seen whole."""
        return not any(self.unknown)


def outlook(known: RoomMap, seed: mg.Tile, sizes: Sizes, given_up: Collection[mg.Tile]) -> Outlook:
    """What can be told of the room that holds the tile `seed`; tiles that were given up count as walls."""
    room = known.room(seed)
    exits: list[set[mg.Tile]] = [set() for _ in range(4)]
    unknown: list[set[mg.Tile]] = [set() for _ in range(4)]
    for tile in room:
        for heading, other in around(tile):
            if other in room:
                continue
            if not known.known(other):
                if other not in given_up:
                    unknown[heading].add(other)
            elif known.narrow(other) and (known.free(other) or known.door(other)):
                exits[heading].add(other)
    wide, high = _extent(room)
    needed: list[frozenset[mg.Tile]] = []
    for heading in range(4):
        tiles = set(unknown[heading])
        across = wide if heading % 2 else high
        if not tiles and sizes.goes_on(across) > MAYBE:
            tiles = unknown[(heading + 1) % 4] | unknown[(heading - 1) % 4]
        needed.append(frozenset() if exits[heading] else frozenset(tiles))
    listed = tuple(tuple(sorted(found)) for found in exits)
    return Outlook(frozenset(room), listed, tuple(map(frozenset, unknown)), tuple(needed))


def viewpoint(steps: dict[Pose, int], targets: Collection[mg.Tile]) -> tuple[Pose, int, int] | None:
    """From where to look at tiles: the pose, its distance, and how many of them lie in view there; None of nowhere.

    The nearest from which all are in view, else the one with the most for its distance.
    """
    aims = np.array(sorted(targets), dtype=np.int64)
    best: tuple[tuple[float, int], Pose, int, int] | None = None
    for pose, distance in steps.items():
        offsets = aims - pose[:2]
        cone = _CONES[pose[2]]
        many = sum(tuple(offset) in cone for offset in offsets.tolist())
        if not many:
            continue
        worth = (-1e9 + distance if many == len(aims) else distance / many, distance)
        if best is None or worth < best[0]:
            best = worth, pose, distance, many
    return None if best is None else best[1:]


def _extent(room: Collection[mg.Tile]) -> tuple[int, int]:
    xs, ys = [x for x, _ in room], [y for _, y in room]
    return max(xs) - min(xs) + 1, max(ys) - min(ys) + 1
