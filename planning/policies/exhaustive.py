"""Every sequence of actions."""

from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np

from ...model import Motions
from ..local import LocalModel
from .base import Policies, PolicyGenerator, frozen


@dataclass(frozen=True, slots=True)
class Exhaustive(PolicyGenerator):
    """All K^L sequences, the paper's first way to make policies."""

    name: ClassVar[str] = "exhaustive"

    def make(self, model: LocalModel) -> Policies:
        self.check(model.motions, model.look_ahead)
        return _exhaustive(len(model.motions), model.look_ahead)

    def count(self, motions: Motions, look_ahead: int) -> int:
        return len(motions) ** look_ahead


@lru_cache(maxsize=4)
def _exhaustive(actions: int, look_ahead: int) -> Policies:
    digits = actions ** np.arange(look_ahead - 1, -1, -1)
    return frozen(np.arange(actions**look_ahead)[:, None] // digits % actions)
