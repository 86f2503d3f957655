"""Where in its room a body is: a filter over poses, for legs that slip."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..worlds import minigrid as mg
from .eyes import View
from .room_map import SIDE, Pose, RoomMap

LEFT, RIGHT, FORWARD, PICKUP, DROP, TOGGLE, NOTHING = range(7)
"""MiniGrid's actions."""

_KEEP, _FEW = 1e-4, 64
LOST = 10.0
"""Nats by which the best pose must be worse than one of which nothing is known: nothing that was expected is seen."""
SURE = 0.7
"""Belief in one pose from which on the map learns."""


class Whereabouts:
    """A belief over poses in the room, and how often actions go astray.

    Attributes:
        pose: the most probable.
        certainty: how probable it is.
        misfit: nats by which the last view fits the best pose worse than one of which nothing is known.
    """

    def __init__(self, pose: Pose) -> None:
        self._slips, self._moves = 0.04, 4.0
        self.set(pose)

    def set(self, pose: Pose) -> None:
        """Be there for sure."""
        self._poses, self._weights = np.array([pose], dtype=np.int64), np.ones(1)
        self.pose, self.certainty, self.misfit = pose, 1.0, 0.0

    @property
    def slip(self) -> float:
        """How often an action is taken to go astray."""
        return self._slips / self._moves

    def update(self, action: int, view: View, known: RoomMap) -> None:
        """Take in what is seen after an action; `NOTHING` where none was taken. What was toggled is forgotten."""
        poses, prior, meant = self._ahead(action, known)
        if action in (PICKUP, DROP, TOGGLE):  # it stood in the way until then
            x, y, heading = self.pose
            known.unlearn((x + mg.AHEAD[heading][0], y + mg.AHEAD[heading][1]))
        log_p = np.log(prior) + known.log_likelihood(poses, view)
        best = float(log_p.max())
        self.misfit = known.novelty(view) - best
        weights = np.exp(log_p - best)
        weights /= weights.sum()
        right = float(weights[meant].sum())
        if action in (LEFT, RIGHT, FORWARD):
            self._moves, self._slips = self._moves + 1.0, self._slips + 1.0 - right
        self._merge(poses, weights)

    def _merge(self, poses: NDArray[np.int64], weights: NDArray[np.float64]) -> None:
        together: dict[Pose, float] = {}
        for pose, weight in zip(map(tuple, poses.tolist()), weights.tolist(), strict=True):
            together[pose] = together.get(pose, 0.0) + weight
        kept = sorted(together.items(), key=lambda item: (-item[1], item[0]))[:_FEW]
        kept = [item for item in kept if item[1] >= _KEEP]
        self._poses = np.array([pose for pose, _ in kept], dtype=np.int64)
        self._weights = np.array([weight for _, weight in kept])
        self._weights /= self._weights.sum()
        self.pose, self.certainty = kept[0][0], float(self._weights[0])

    def _ahead(self, action: int, known: RoomMap) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.bool_]]:
        """Every pose that the action, or another in its stead, may have led to; how probably; and which were meant."""
        poses: list[Pose] = []
        prior: list[float] = []
        meant: list[bool] = []
        intended = action if action in (LEFT, RIGHT, FORWARD) else NOTHING
        for (x, y, heading), weight in zip(self._poses.tolist(), self._weights.tolist(), strict=True):
            for each in (LEFT, RIGHT, FORWARD, NOTHING):
                poses.append(moved((x, y, heading), each, known))
                prior.append(weight * (1.0 - self.slip if each == intended else self.slip / 3.0))
                meant.append(each == intended)
        return np.array(poses, dtype=np.int64), np.maximum(prior, 1e-300), np.array(meant)


def moved(pose: Pose, action: int, known: RoomMap) -> Pose:
    """Where an action leads; one cannot step where something is known to stand."""
    x, y, heading = pose
    if action == LEFT:
        return x, y, (heading - 1) % 4
    if action == RIGHT:
        return x, y, (heading + 1) % 4
    if action == FORWARD:
        ahead = (x + mg.AHEAD[heading][0], y + mg.AHEAD[heading][1])
        inside = 0 < ahead[0] < SIDE - 1 and 0 < ahead[1] < SIDE - 1
        if inside and (known.free(ahead) or not known.known(ahead)):
            return (*ahead, heading)
    return pose
