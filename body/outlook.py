"""What can be told of a room from what was seen of it: its exits, and what would have to be looked at."""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from ..worlds import minigrid as mg
from .room_map import Mask, Pose, RoomMap, shifted

MAYBE = 0.25  # probability that a room goes on beyond what was seen from which on that has to be looked at

_HEADINGS = np.array(mg.AHEAD)
_FAR, _WIDE = 6, 3  # tiles that are in view ahead, and to each side


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
    """A room as far as it was seen."""

    room: frozenset[mg.Tile]  # its tiles
    # doors and gaps by direction (0 right, 1 down, 2 left, 3 up), in the order of their place in the wall
    exits: tuple[tuple[mg.Tile, ...], ...]
    unknown: tuple[frozenset[mg.Tile], ...]  # tiles beside the room of which nothing is known, by direction
    # for each direction in which no exit is known, the tiles that have to be looked at; empty where there is
    # surely none
    needed: tuple[frozenset[mg.Tile], ...]

    @property
    def whole(self) -> bool:
        """Whether the room was seen whole."""
        return not any(self.unknown)


def outlook(known: RoomMap, seed: mg.Tile, sizes: Sizes, given_up: Collection[mg.Tile]) -> Outlook:
    """What can be told of the room that holds the tile `seed`; tiles that were given up count as walls."""
    masks, room = known.masks(), known.room(seed)
    exits: list[tuple[mg.Tile, ...]] = []
    unknown: list[frozenset[mg.Tile]] = []
    passable = masks.narrow & (masks.free | masks.shut)
    for heading in range(4):
        beside = shifted(room, (heading + 2) % 4) & ~room
        exits.append(tuple(sorted(_tiles(beside & passable))))
        unknown.append(frozenset(_tiles(beside & ~masks.known)) - frozenset(given_up))
    tiles = frozenset(_tiles(room))
    wide, high = _extent(tiles)
    needed: list[frozenset[mg.Tile]] = []
    for heading in range(4):
        aims = unknown[heading]
        if not aims and sizes.goes_on(wide if heading % 2 else high) > MAYBE:
            aims = unknown[(heading + 1) % 4] | unknown[(heading - 1) % 4]
        needed.append(frozenset() if exits[heading] else aims)
    return Outlook(tiles, tuple(exits), tuple(unknown), tuple(needed))


def viewpoint(steps: dict[Pose, int], targets: Collection[mg.Tile]) -> tuple[Pose, int, int] | None:
    """From where to look at tiles: the pose, its distance, and how many of them lie in view there; None of nowhere.

    The nearest from which all are in view, else the one with the most for its distance.
    """
    aims, poses = np.array(sorted(targets)), np.array([*steps])
    distance = np.array([*steps.values()])
    far = aims[None, :, :] - poses[:, None, :2]
    ahead, right = _HEADINGS[poses[:, 2]], _HEADINGS[(poses[:, 2] + 1) % 4]
    forward, across = (far * ahead[:, None]).sum(axis=2), (far * right[:, None]).sum(axis=2)
    many = ((forward >= 0) & (forward <= _FAR) & (abs(across) <= _WIDE)).sum(axis=1)
    if not many.any():
        return None
    worth = np.where(many == len(aims), distance - 1e9, distance / np.maximum(many, 1))
    worth[many == 0] = np.inf
    best = int(np.lexsort((distance, worth))[0])
    x, y, heading = poses[best].tolist()
    return (x, y, heading), int(distance[best]), int(many[best])


def _tiles(mask: Mask) -> list[mg.Tile]:
    return [(x, y) for y, x in np.argwhere(mask).tolist()]


def _extent(room: Collection[mg.Tile]) -> tuple[int, int]:
    xs, ys = [x for x, _ in room], [y for _, y in room]
    return max(xs) - min(xs) + 1, max(ys) - min(ys) + 1
