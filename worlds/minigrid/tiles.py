"""Tiles as they are encoded, and as they look: what both views show."""

from functools import lru_cache
from typing import Any

import numpy as np
from minigrid.core.grid import Grid
from minigrid.core.world_object import Door, Floor, WorldObj
from minigrid.utils.rendering import fill_coords, point_in_rect
from numpy.typing import NDArray

from .palette import COLOURS, FLOOR, decode_floor, encode_floor

Code = tuple[int, int, int]
"""(object, colour, state), as MiniGrid encodes a tile."""
Pixels = NDArray[np.uint8]

TILE = 8
"""Pixels a side of a tile in the RGB view."""
UNSEEN: Code = (0, 0, 0)
_FACING_UP = 3


class ColouredFloor(Floor):
    """A floor of one of our colours; `number` says which."""

    def __init__(self, number: int) -> None:
        super().__init__("blue")
        self.number = number

    def encode(self) -> Code:
        """As `encode_floor`."""
        return encode_floor(self.number)

    def render(self, img: Any) -> None:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Filled, but for the lines between tiles."""
        fill_coords(img, point_in_rect(0.031, 1, 0.031, 1), COLOURS[self.number])


@lru_cache(maxsize=4096)
def look_of(code: Code, *, agent: bool = False, pixels: int = TILE) -> Pixels:
    """`[pixels, pixels, 3]` how a tile looks in the agent's own view; `agent`: with the agent upon it."""
    what: Any = _object(code)
    facing: Any = _FACING_UP if agent else None
    drawn: Any = Grid.render_tile(what, agent_dir=facing, highlight=code != UNSEEN, tile_size=pixels)
    look = np.asarray(drawn).astype(np.uint8)
    look.setflags(write=False)
    return look


def paint(image: NDArray[Any], *, pixels: int = TILE) -> Pixels:
    """The RGB view of what the symbolic view shows, pixel for pixel as MiniGrid's own wrapper draws it.

    Args:
        image: `[n, n, 3]` the symbolic view, the agent in the middle of its last row.
        pixels: a side of a tile.

    Returns:
        `[n * pixels, n * pixels, 3]`.
    """
    size = len(image)
    rows = image.reshape(-1, 3).tolist()
    here = size // 2 * size + size - 1
    looks = [look_of((a, b, c), agent=i == here, pixels=pixels) for i, (a, b, c) in enumerate(rows)]
    view = np.array(looks).reshape(size, size, pixels, pixels, 3)
    return view.transpose(1, 2, 0, 3, 4).reshape(size * pixels, size * pixels, 3)


@lru_cache(maxsize=1)
def codes() -> tuple[Code, ...]:
    """Every tile that a view may show, of MiniGrid's and of ours, the unseen one first."""
    plain = [
        UNSEEN,
        (1, 0, 0),
        (2, 5, 0),
        (8, 1, 0),
        (9, 0, 0),
    ]  # all walls are grey: a green one would be a goal
    of_six = [(kind, colour, 0) for kind in (3, 5, 6, 7) for colour in range(6)]
    doors = [(4, colour, state) for colour in range(6) for state in range(3)]
    return (*plain, *of_six, *doors, *map(encode_floor, range(len(COLOURS))))


def _object(code: Code) -> WorldObj | None:
    kind, colour, state = code
    number = decode_floor(colour, state) if kind == FLOOR else None
    if number is not None:
        return ColouredFloor(number)
    return WorldObj.decode(kind, colour, state)


__all__ = ["TILE", "UNSEEN", "Code", "ColouredFloor", "Door", "codes", "look_of", "paint"]
