"""What tiles there may be, how they look, and what can be done with them."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..worlds import minigrid as mg

EMPTY, WALL, FLOOR, DOOR, KEY, BALL, BOX, GOAL, LAVA = range(1, 10)
OPENED, CLOSED, LOCKED = range(3)


@dataclass(frozen=True)
class Vocabulary:
    """Tables over the K tiles of `codes()`, the unseen one being number 0.

    Attributes:
        codes: `[K, 3]` as MiniGrid encodes them.
        free: `[K + 1]` whether one can step there; the last row is what is unknown.
        wall, door, thing: `[K + 1]` the same of walls, of doors (open or not), and of things that lie in the way.
        shut: `[K + 1]` of closed doors that are not locked.
        locked, key: `[K + 1]` colour of the locked door, or of the key, that it is; -1 of others.
        floor: `[K + 1]` number of the coloured floor, -1 of others.
    """

    codes: NDArray[np.int64]
    free: NDArray[np.bool_]
    wall: NDArray[np.bool_]
    door: NDArray[np.bool_]
    thing: NDArray[np.bool_]
    shut: NDArray[np.bool_]
    locked: NDArray[np.int64]
    key: NDArray[np.int64]
    floor: NDArray[np.int64]

    def looks(self, pixels: int) -> NDArray[np.float64]:
        """`[K, 3 * pixels * pixels]` how each looks in tiles of that size."""
        return _looks(pixels)

    def exact(self, pixels: int) -> dict[bytes, int]:
        """The number of each tile by its pixels."""
        return _exact(pixels)


@lru_cache(maxsize=1)
def vocabulary() -> Vocabulary:
    """The tiles of MiniGrid, and coloured floors."""
    known = np.array([*mg.codes(), (0, 0, 0)], dtype=np.int64)
    kind, state = known[:, 0], known[:, 2]
    floor = np.array(
        [-1 if k != FLOOR or (n := mg.decode_floor(c, s)) is None else n for k, c, s in known.tolist()], dtype=np.int64
    )
    door = kind == DOOR
    free = np.isin(kind, (EMPTY, FLOOR, GOAL)) | (door & (state == OPENED))
    thing = np.isin(kind, (KEY, BALL, BOX))
    locked = np.where(door & (state == LOCKED), known[:, 1], -1)
    key = np.where(kind == KEY, known[:, 1], -1)
    return Vocabulary(known[:-1], free, kind == WALL, door, thing, door & (state == CLOSED), locked, key, floor)


@lru_cache(maxsize=8)
def _looks(pixels: int) -> NDArray[np.float64]:
    return np.array([mg.look_of(code, pixels=pixels).ravel() for code in mg.codes()], dtype=np.float64)


@lru_cache(maxsize=8)
def _exact(pixels: int) -> dict[bytes, int]:
    return {mg.look_of(code, pixels=pixels).tobytes(): i for i, code in enumerate(mg.codes())}
