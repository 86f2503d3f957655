"""Straight on, then once around a corner."""

from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

from ...model import Motions
from ..local import LocalModel
from .base import Policies, PolicyGenerator, frozen, padded


@dataclass(frozen=True, slots=True)
class LShaped(PolicyGenerator):
    """Up to L steps straight or with one turn, each then staying; the paper's third way.

    In the grid these are exactly 4 L^2 + 1 policies. The map plays no part.
    """

    name: ClassVar[str] = "l_shaped"

    def make(self, model: LocalModel) -> Policies:
        self.check(model.motions, model.look_ahead)
        return _l_shaped(model.motions, model.look_ahead)

    def count(self, motions: Motions, look_ahead: int) -> int:
        moves = len(motions) - 1
        return 1 + moves * look_ahead + moves * max(moves - 2, 0) * look_ahead * (look_ahead - 1) // 2


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
