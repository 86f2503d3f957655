"""Walks that never return on their track, with a stop after each step."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ...model.motions import Motions
from ..reach import Reach
from .base import Ints, Policies, check_count, check_look_ahead, frozen


def self_avoiding(reach: Reach) -> Policies:
    """Self-avoiding walks of 0..L steps in Z^n, each then staying; the paper's second way.

    In the grid these are 5, 17, 53, 153, 437, 1217, 3389 policies for L = 1..7. The map plays no part.

    Raises:
        CogmapError: `look_ahead` is below one, or there are more than two million walks.
    """
    check_look_ahead("self_avoiding", reach.look_ahead)
    return _self_avoiding(reach.motions, reach.look_ahead)


@lru_cache(maxsize=16)
def _self_avoiding(motions: Motions, look_ahead: int) -> Policies:
    moves = np.array([a for a in range(len(motions)) if a != motions.stay], dtype=np.int64)
    steps = np.array(motions.displacements, dtype=np.int64)[moves]
    tracks = np.zeros((1, 1, len(motions.displacements[0])), dtype=np.int64)
    walks = np.full((1, look_ahead), motions.stay, dtype=np.int64)
    levels: list[Ints] = [walks]
    for depth in range(look_ahead if len(moves) else 0):
        check_count("self_avoiding", sum(map(len, levels)) + len(walks), look_ahead)
        ends = tracks[:, -1:, :] + steps
        fresh = (ends[:, :, None, :] != tracks[:, None, :, :]).any(-1).all(-1)
        walk, move = np.nonzero(fresh)
        walks = walks[walk]
        walks[:, depth] = moves[move]
        tracks = np.concatenate([tracks[walk], ends[walk, move][:, None, :]], axis=1)
        levels.append(walks)
    return frozen(np.concatenate(levels))
