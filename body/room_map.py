"""What a body knows of the room it is in: tiles around it, in a frame of its own."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..worlds import minigrid as mg
from .eyes import View
from .vocabulary import vocabulary

Pose = tuple[int, int, int]
"""x to the right, y downwards, and heading: 0 right, 1 down, 2 left, 3 up, all in the body's own frame."""

SIDE = 96
CENTRE = SIDE // 2
UNKNOWN = -1
_SURE = 14.0  # nats: two looks that agree; what has changed is believed after as many
_NOVEL = 0.1  # nats: how surprising a tile is of which nothing is known; what lies beside what is known mostly goes on

Mask = NDArray[np.bool_]

_OFFSETS = np.array([mg.view_offsets(heading).reshape(-1, 2) for heading in range(4)])


@dataclass(frozen=True, slots=True)
class Masks:
    """`[y, x]` truth values: can one stand there; is it a wall, a door, one to be opened; known; does it join rooms.

    What joins rooms is a door, or a gap between walls on opposite sides. A gap of which one side was not seen counts
    where the wall on the other side ends beside it.
    """

    free: Mask
    wall: Mask
    door: Mask
    shut: Mask
    known: Mask
    narrow: Mask


class RoomMap:
    """Evidence for every tile, summed over looks.

    Attributes:
        tile: `[y, x]` the most likely tile, `UNKNOWN` where none was seen.
        key: colour of the key that is carried; -1 of none. Locked doors of that colour can be opened.
    """

    def __init__(self) -> None:
        self._words = vocabulary()
        self._evidence = np.zeros((SIDE, SIDE, len(self._words.codes)))
        self.tile: NDArray[np.int64] = np.full((SIDE, SIDE), UNKNOWN, dtype=np.int64)
        self._stood: set[mg.Tile] = set()
        self._masks: Masks | None = None
        self._key = -1

    @property
    def key(self) -> int:
        """See the class."""
        return self._key

    @key.setter
    def key(self, colour: int) -> None:
        self._key, self._masks = colour, None

    def clear(self) -> None:
        """Forget everything."""
        self._masks = None
        self._evidence[:] = 0.0
        self.tile[:] = UNKNOWN
        self._stood.clear()

    def recentre(self, tile: mg.Tile, keep: Iterable[mg.Tile]) -> mg.Tile:
        """Forget all but `keep`, and move the map so that `tile` is in its middle; answers with where that is."""
        dx, dy = CENTRE - tile[0], CENTRE - tile[1]
        kept = [(x, y, self._evidence[y, x].copy(), int(self.tile[y, x])) for x, y in keep]
        stood = {(x + dx, y + dy) for x, y in self._stood & {(x, y) for x, y, _, _ in kept}}
        self.clear()
        for x, y, evidence, number in kept:
            if 0 <= x + dx < SIDE and 0 <= y + dy < SIDE:
                self._evidence[y + dy, x + dx], self.tile[y + dy, x + dx] = evidence, number
        self._stood, self._masks = stood, None
        return CENTRE, CENTRE

    def log_likelihood(self, poses: NDArray[np.int64], view: View) -> NDArray[np.float64]:
        """`[n]` log P(view | pose) of each pose `[n, 3]`; tiles of which nothing is known count as novel."""
        x, y = self._places(poses)
        tile = self.tile[y, x]
        each = np.where(
            tile == UNKNOWN, -_NOVEL, view.log_likelihood[np.arange(len(view.tile))[None, :], np.maximum(tile, 0)]
        )
        return (each * view.seen).sum(axis=1)

    def novelty(self, view: View) -> float:
        """log P(view | a pose of which nothing is known)."""
        return -_NOVEL * float(view.seen.sum())

    def add(self, pose: Pose, view: View) -> None:
        """Take in a view from a pose."""
        x, y = self._places(np.array([pose]))
        x, y = x[0][view.seen], y[0][view.seen]
        evidence = self._evidence[y, x] + view.log_likelihood[view.seen]
        evidence = np.maximum(evidence - evidence.max(axis=1, keepdims=True), -_SURE)
        self._evidence[y, x] = evidence
        self.tile[y, x] = evidence.argmax(axis=1)
        self._stood.add(pose[:2])
        self._masks = None

    def unlearn(self, tile: mg.Tile) -> None:
        """Forget a tile that has been changed."""
        self._stood.discard(tile)
        self._evidence[tile[1], tile[0]] = 0.0
        self.tile[tile[1], tile[0]] = UNKNOWN
        self._masks = None

    def evidence(self, tiles: Iterable[mg.Tile]) -> NDArray[np.float64]:
        """`[K]` evidence for each kind of tile, summed over tiles of which something is known."""
        known = [(x, y) for x, y in tiles if self.tile[y, x] != UNKNOWN]
        return sum((self._evidence[y, x] for x, y in known), np.zeros(len(self._words.codes)))

    def known(self, tile: mg.Tile) -> bool:
        """Whether anything is known of a tile."""
        return self.tile[tile[1], tile[0]] != UNKNOWN or tile in self._stood

    def free(self, tile: mg.Tile) -> bool:
        """Whether one can stand there."""
        return bool(self._words.free[self.tile[tile[1], tile[0]]]) or tile in self._stood

    def wall(self, tile: mg.Tile) -> bool:
        """Whether a wall is there."""
        return bool(self._words.wall[self.tile[tile[1], tile[0]]])

    def door(self, tile: mg.Tile) -> bool:
        """Whether a door is there, open or not."""
        return bool(self._words.door[self.tile[tile[1], tile[0]]])

    def shut(self, tile: mg.Tile) -> bool:
        """Whether a door is there that can be opened."""
        return bool(self.masks().shut[tile[1], tile[0]])

    def floor(self, tile: mg.Tile) -> int:
        """The number of the coloured floor there; -1 of anything else."""
        return int(self._words.floor[self.tile[tile[1], tile[0]]])

    def narrow(self, tile: mg.Tile) -> bool:
        """Whether a tile joins rooms; see `masks`."""
        return bool(self.masks().narrow[tile[1], tile[0]])

    def masks(self) -> Masks:
        """What the tiles are, as truth values; worked out anew where the map has changed."""
        if self._masks is None:
            words, tile = self._words, self.tile
            free, wall, door = words.free[tile], words.wall[tile], words.door[tile]
            known = tile != UNKNOWN
            for x, y in self._stood:
                free[y, x] = known[y, x] = True
            shut = words.shut[tile] | ((words.locked[tile] == self._key) & (self._key >= 0))
            self._masks = Masks(free, wall, door, shut, known, _narrow(free, wall, door, known))
        return self._masks

    def room(self, tile: mg.Tile) -> NDArray[np.bool_]:
        """`[y, x]` the tiles of floor that hang together with this one, doors and gaps left out."""
        from scipy.ndimage import label  # slow to import

        masks = self.masks()
        floor = masks.free & ~masks.narrow
        floor[tile[1], tile[0]] = True
        labelled: Any = label(floor)
        parts = labelled[0]
        return parts == parts[tile[1], tile[0]]

    def _places(self, poses: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        where = poses[:, None, :2] + _OFFSETS[poses[:, 2]]
        where = np.clip(where, 0, SIDE - 1)
        return where[..., 0], where[..., 1]


def around(tile: mg.Tile) -> Iterator[tuple[int, mg.Tile]]:
    """The four tiles beside one, each with its direction."""
    for heading, (dx, dy) in enumerate(mg.AHEAD):
        yield heading, (tile[0] + dx, tile[1] + dy)


def shifted(mask: Mask, heading: int, by: int = 1) -> Mask:
    """Whether the tile so far ahead, in that direction, is in the mask."""
    dx, dy = mg.AHEAD[heading]
    return np.roll(mask, (-dy * by, -dx * by), axis=(0, 1))


def _narrow(free: Mask, wall: Mask, door: Mask, known: Mask) -> Mask:
    walls, unknown = [shifted(wall, h) for h in range(4)], [~shifted(known, h) for h in range(4)]
    found = door | (walls[0] & walls[2]) | (walls[1] & walls[3])
    for side in range(4):
        half = walls[side] & unknown[(side + 2) % 4]
        if half.any():
            beside = shifted(free, side)
            for along in ((side + 1) % 4, (side + 3) % 4):
                found |= half & shifted(free, along) & shifted(beside, along)
    return found
