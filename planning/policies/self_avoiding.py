"""Walks that never return on their track, with a stop after each step."""

from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np

from ...model import Motions
from ..local import LocalModel
from .base import Ints, Policies, PolicyGenerator, frozen


@dataclass(frozen=True, slots=True)
class SelfAvoiding(PolicyGenerator):
    """Self-avoiding walks of 0..L steps in Z^n, each then staying; the paper's second way.

    In the grid these are 5, 17, 53, 153, 437, 1217, 3389 policies for L = 1..7. The map plays no part.
    """

    name: ClassVar[str] = "self_avoiding"

    def make(self, model: LocalModel) -> Policies:
        self.check(model.motions, model.look_ahead)
        return _self_avoiding(model.motions, model.look_ahead)

    def count(self, motions: Motions, look_ahead: int) -> int:
        """Walks that never turn straight back, of which the self-avoiding ones are a part."""
        moves = len(motions) - 1
        return 1 + sum(moves * max(moves - 1, 1) ** (length - 1) for length in range(1, look_ahead + 1))


@lru_cache(maxsize=16)
def _self_avoiding(motions: Motions, look_ahead: int) -> Policies:
    moves = np.array([a for a in range(len(motions)) if a != motions.stay], dtype=np.int64)
    steps = np.array(motions.displacements, dtype=np.int64)[moves]
    tracks = np.zeros((1, 1, len(motions.displacements[0])), dtype=np.int64)
    walks = np.full((1, look_ahead), motions.stay, dtype=np.int64)
    levels: list[Ints] = [walks]
    for depth in range(look_ahead if len(moves) else 0):
        ends = tracks[:, -1:, :] + steps
        fresh = (ends[:, :, None, :] != tracks[:, None, :, :]).any(-1).all(-1)
        walk, move = np.nonzero(fresh)
        walks = walks[walk]
        walks[:, depth] = moves[move]
        tracks = np.concatenate([tracks[walk], ends[walk, move][:, None, :]], axis=1)
        levels.append(walks)
    return frozen(np.concatenate(levels))
