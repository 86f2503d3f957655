"""What the experimenter counts: tiles seen, rooms entered, and when. No agent sees it."""

import numpy as np
from numpy.typing import NDArray

from ..maze import Position
from .floorplan import Floorplan, Tile

AHEAD = ((1, 0), (0, 1), (-1, 0), (0, -1))
"""The step forward of each heading."""


def view_offsets(heading: int, size: int = 7) -> NDArray[np.int64]:
    """`[size, size, 2]` where each tile of a view lies from the agent, which looks that way."""
    across, up = np.arange(size)[:, None] - size // 2, (size - 1 - np.arange(size))[None, :]
    ahead, right = np.array(AHEAD[heading]), np.array(AHEAD[(heading + 1) % 4])
    return up[..., None] * ahead + across[..., None] * right


_OFFSETS = [view_offsets(heading) for heading in range(4)]


class Tally:
    """Counts along an episode.

    Attributes:
        seen: `[x, y]` whether each tile was in view.
        room: of whose floor the agent stood last.
        entered: the step at which each room was entered first.
        shares: the step at which each share of the tiles, in tenths, was first seen.
        share: of the tiles that was seen.
        white: the steps at which the white tile was stood on.
        path: every pose, one a step, the first before any.
    """

    def __init__(self, plan: Floorplan) -> None:
        self._plan, self._counts = plan, plan.tiles()
        self._of = {tile: room for room in plan.rooms for tile in plan.floor(room)}
        self._total = int(self._counts.sum())
        self.seen = np.zeros((plan.width, plan.height), dtype=np.bool_)
        self.entered: dict[Position, int] = {}
        self.shares: dict[int, int] = {}
        self.white: list[int] = []
        self.path: list[tuple[int, int, int]] = []
        self.room: Position = plan.maze.rooms[0]
        self.share = 0.0

    def note(self, tile: Tile, heading: int, symbols: NDArray[np.uint8], *, step: int) -> None:
        """Take in where the agent is, and what it sees."""
        lit = _OFFSETS[heading][symbols[..., 0] != 0] + tile
        x, y = lit[:, 0], lit[:, 1]
        inside = (x >= 0) & (y >= 0) & (x < self.seen.shape[0]) & (y < self.seen.shape[1])
        self.seen[x[inside], y[inside]] = True
        self.seen[tile] = True
        self.share = int((self.seen & self._counts).sum()) / self._total
        for tenth in range(len(self.shares) + 1, int(self.share * 10 + 1e-9) + 1):
            self.shares[tenth] = step
        self.path.append((*tile, heading))
        room = self._of.get(tile)
        if room is not None:
            self.room = room
            self.entered.setdefault(room, step)
