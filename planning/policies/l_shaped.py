"""Straight on, then once around a corner."""

from __future__ import annotations

from functools import lru_cache

from ...model.motions import Motions
from ..reach import Reach
from .base import Policies, check_look_ahead, frozen, padded


def l_shaped(reach: Reach) -> Policies:
    """Up to L steps straight or with one turn, each then staying; the paper's third way.

    In the grid these are exactly 4 L^2 + 1 policies. The map plays no part.

    Raises:
        CogmapError: `look_ahead` is below one.
    """
    check_look_ahead("l_shaped", reach.look_ahead)
    return _l_shaped(reach.motions, reach.look_ahead)


@lru_cache(maxsize=16)
def _l_shaped(motions: Motions, look_ahead: int) -> Policies:
    moves = [a for a in range(len(motions)) if a != motions.stay]
    paths: list[tuple[int, ...]] = [()]
    for first in moves:
        turns = [a for a in moves if a not in (first, motions.inverse[first])]
        for straight in range(1, look_ahead + 1):
            paths.append((first,) * straight)
            paths += [
                (first,) * straight + (turn,) * after for turn in turns for after in range(1, look_ahead - straight + 1)
            ]
    return frozen(padded(paths, stay=motions.stay, length=look_ahead))
