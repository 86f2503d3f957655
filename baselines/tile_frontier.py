"""Nearest-frontier search over the tiles of MiniGrid: one flat map, no rooms."""

import heapq
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ..worlds import WorldError
from ..worlds import minigrid as mg

LEFT, RIGHT, FORWARD, TOGGLE, DONE = 0, 1, 2, 5, 6
_EMPTY, _FLOOR, _DOOR, _GOAL = 1, 3, 4, 8
_OPEN, _CLOSED = 0, 1

Pose = tuple[int, int, int]


class TileFrontier:
    """Goes by a shortest known way, turns and doors counted, to the nearest tile beside one never seen, and then to the
    next (Yamauchi 1997); answers `DONE` when there is none.

    It is given the symbolic view, and reckons where it is: in a world whose actions slip it is lost. Actions are
    MiniGrid's own.

    Args:
        eager: whether it chooses anew after every step, not only where it has arrived.
    """

    def __init__(self, *, eager: bool = False) -> None:
        self._eager = eager
        self._goal: mg.Tile | None = None
        self._pose: Pose = (0, 0, 0)
        self._action = DONE
        self._tiles: dict[mg.Tile, tuple[int, int]] = {(0, 0): (_EMPTY, 0)}  # kind and state

    def step(self, observation: Mapping[str, Any]) -> int:
        """The next low-level action. Raises WorldError: the observation has no symbolic view."""
        image = np.asarray(observation.get("image"))
        if image.shape != (7, 7, 3):
            raise WorldError(f"tile frontier: an image of shape {image.shape} is no symbolic view; give (7, 7, 3)")
        self._pose = self._moved(self._action)
        self._see(image)
        if self._eager or self._goal == self._pose[:2]:
            self._goal = None
        self._action = self._towards(self._goal)
        return self._action

    def _moved(self, action: int) -> Pose:
        x, y, heading = self._pose
        if action in (LEFT, RIGHT):
            return x, y, (heading + (1 if action == RIGHT else -1)) % 4
        return (*self._ahead(self._pose), heading) if action == FORWARD else self._pose

    @staticmethod
    def _ahead(pose: Pose) -> mg.Tile:
        return pose[0] + mg.AHEAD[pose[2]][0], pose[1] + mg.AHEAD[pose[2]][1]

    def _see(self, image: Any) -> None:
        x, y, heading = self._pose
        offsets = mg.view_offsets(heading)
        for i, j in np.argwhere(image[..., 0] != 0).tolist():
            dx, dy = offsets[i, j].tolist()
            if (dx, dy) != (0, 0):  # its own tile is blank
                self._tiles[x + dx, y + dy] = int(image[i, j, 0]), int(image[i, j, 2])

    def _free(self, tile: mg.Tile) -> bool:
        kind, state = self._tiles.get(tile, (0, 0))
        return kind in (_EMPTY, _FLOOR, _GOAL) or (kind == _DOOR and state == _OPEN)

    def _shut(self, tile: mg.Tile) -> bool:
        return self._tiles.get(tile) == (_DOOR, _CLOSED)

    def _edge(self, tile: mg.Tile) -> bool:
        """Whether it lies beside a tile that was never seen."""
        return any((tile[0] + dx, tile[1] + dy) not in self._tiles for dx, dy in mg.AHEAD)

    def _moves(self, pose: Pose) -> Iterator[tuple[int, int, Pose]]:
        """Steps, the first action, and where it leads."""
        x, y, heading = pose
        ahead = self._ahead(pose)
        if self._free(ahead):
            yield 1, FORWARD, (*ahead, heading)
        elif self._shut(ahead):
            yield 2, TOGGLE, (*ahead, heading)
        yield 1, LEFT, (x, y, (heading - 1) % 4)
        yield 1, RIGHT, (x, y, (heading + 1) % 4)

    def _towards(self, goal: mg.Tile | None) -> int:
        """The first action of a shortest way to a tile, or else to the nearest edge, which is the goal from then on."""
        best: dict[Pose, int] = {self._pose: 0}
        queue = [(0, self._pose, DONE)]
        while queue:
            steps, pose, first = heapq.heappop(queue)
            there = self._edge(pose[:2]) if goal is None else pose[:2] == goal
            if there and first != DONE:
                self._goal = pose[:2]
                return first
            if best[pose] < steps:
                continue
            for cost, action, new in self._moves(pose):
                if steps + cost < best.get(new, 1 << 30):
                    best[new] = steps + cost
                    heapq.heappush(queue, (steps + cost, new, action if first == DONE else first))
        return DONE if goal is None else self._towards(None)
