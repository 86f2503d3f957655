"""What a body knows of the room it is in: tiles around it, in a frame of its own."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from copy import copy
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
_MOST_NOVEL = 1.0  # and all of a view: a room goes on or ends, its tiles do not decide one by one

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
    """What every tile is taken for, and how surely, from all looks at it.

    Attributes:
        tile: `[y, x]` the most likely tile, `UNKNOWN` where none was seen.
        key: colour of the key that is carried; -1 of none. Locked doors of that colour can be opened.
    """

    def __init__(self) -> None:
        self._words = vocabulary()
        self.tile: NDArray[np.int16] = np.full((SIDE, SIDE), UNKNOWN, dtype=np.int16)
        self._sure = np.zeros((SIDE, SIDE), dtype=np.float32)  # nats by which it is likelier than what is next
        self._stood = np.zeros((SIDE, SIDE), dtype=np.bool_)
        self._masks: Masks | None = None
        self._key = -1

    @property
    def key(self) -> int:
        """See the class."""
        return self._key

    @key.setter
    def key(self, colour: int) -> None:
        self._key, self._masks = colour, None

    def copy(self) -> RoomMap:
        """One that goes on by itself."""
        new = copy(self)
        new.tile, new._sure, new._stood = self.tile.copy(), self._sure.copy(), self._stood.copy()
        return new

    def same(self, other: RoomMap) -> bool:
        """Whether another has the same tiles."""
        return np.array_equal(self.tile, other.tile)

    def about(self, tile: mg.Tile, keep: Iterable[mg.Tile]) -> RoomMap:
        """One of `keep` alone, moved so that `tile` is in its middle."""
        new, (dx, dy) = RoomMap(), (CENTRE - tile[0], CENTRE - tile[1])
        x, y = np.array([(x, y) for x, y in keep if 0 <= x + dx < SIDE and 0 <= y + dy < SIDE]).T
        for mine, its in ((self.tile, new.tile), (self._sure, new._sure), (self._stood, new._stood)):
            its[y + dy, x + dx] = mine[y, x]
        new._key = self._key
        return new

    def log_likelihood(self, poses: NDArray[np.int64], view: View) -> NDArray[np.float64]:
        """`[n]` log P(view | pose) of each pose `[n, 3]`; tiles of which nothing is known count as novel.

        A tile that was misread is another one: what contradicts it counts no more than it is sure.
        """
        x, y = _places(poses)
        tile = self.tile[y, x]
        each = view.log_likelihood[np.arange(len(view.tile))[None, :], np.maximum(tile, 0)]
        each = np.maximum(each, -self._sure[y, x])
        novel = (tile == UNKNOWN) & view.seen
        return (each * (view.seen & ~novel)).sum(axis=1) - np.minimum(_NOVEL * novel.sum(axis=1), _MOST_NOVEL)

    def novelty(self, view: View) -> float:
        """log P(view | a pose of which nothing is known)."""
        return -min(_NOVEL * float(view.seen.sum()), _MOST_NOVEL)

    def at(self, poses: NDArray[np.int64]) -> NDArray[np.int16]:
        """`[n, 49]` the tiles that lie in view from poses `[n, 3]`."""
        x, y = _places(poses)
        return self.tile[y, x]

    def add(self, pose: Pose, view: View) -> None:
        """Take in a view from a pose."""
        x, y = _places(np.array([pose]))
        x, y, new = x[0][view.seen], y[0][view.seen], view.tile[view.seen]
        against, old = view.log_likelihood[view.seen], self.tile[y, x]
        second = np.partition(against, -2, axis=1)[:, -2]
        sure = np.where(old == new, self._sure[y, x] - second, self._sure[y, x])
        sure += np.where((old != new) & (old != UNKNOWN), against[np.arange(len(old)), np.maximum(old, 0)], 0.0)
        sure = np.where(old == UNKNOWN, second, sure)
        turned = (sure <= 0.0) & (old != new)  # it is another tile from now on
        self.tile[y, x], self._sure[y, x] = np.where(turned, new, old), np.minimum(np.abs(sure), _SURE)
        self._stood[pose[1], pose[0]] = True
        self._masks = None

    def unlearn(self, tile: mg.Tile) -> None:
        """Forget a tile that has been changed."""
        self.tile[tile[1], tile[0]], self._sure[tile[1], tile[0]], self._stood[tile[1], tile[0]] = UNKNOWN, 0.0, False
        self._masks = None

    def evidence(self, tiles: Iterable[mg.Tile]) -> NDArray[np.float64]:
        """`[K]` evidence for each kind of tile, summed over tiles of which something is known."""
        x, y = np.array(list(tiles)).T
        x, y = x[self.tile[y, x] >= 0], y[self.tile[y, x] >= 0]
        counts = np.bincount(self.tile[y, x], weights=self._sure[y, x], minlength=len(self._words.codes))
        return counts.astype(np.float64)

    def known(self, tile: mg.Tile) -> bool:
        """Whether anything is known of a tile."""
        return bool(self.tile[tile[1], tile[0]] != UNKNOWN or self._stood[tile[1], tile[0]])

    def free(self, tile: mg.Tile) -> bool:
        """Whether one can stand there."""
        return bool(self._words.free[self.tile[tile[1], tile[0]]] or self._stood[tile[1], tile[0]])

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
            free, wall, door = words.free[tile] | self._stood, words.wall[tile], words.door[tile]
            known = (tile != UNKNOWN) | self._stood
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


def _places(poses: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    where = np.clip(poses[:, None, :2] + _OFFSETS[poses[:, 2]], 0, SIDE - 1)
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
