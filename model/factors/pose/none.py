"""No positions at all: places are known by what is sensed there and by the ways that lead to them."""

import numpy as np

from ...dirichlet import SparseDirichlet
from ...domain import Domain
from ...motions import Position
from ...percept import Percept
from ..base import Context, Floats, Ints
from .base import Ahead, Pose


class NoPose(Pose):
    """No positions: every place has the same pose, which carries no information."""

    def attach(self, context: Context) -> None:
        """Make it part of a model."""
        super().attach(context)
        self.positions = Domain("positions")
        self.table = SparseDirichlet(name="A_p", slots=1)

    def grow(self, places: int) -> None:
        """No counts at all."""
        self.table.resize(places)

    def of(self, places: Ints) -> Ints:
        """`[n]` zeros."""
        return np.zeros(len(places), dtype=np.int64)

    def spread(self, places: Ints) -> tuple[Ints, Floats]:
        """The one pose, for sure."""
        return np.zeros((len(places), 1), dtype=np.int64), np.ones((len(places), 1))

    def fit(self, poses: Ints, places: Ints) -> Floats:
        """`[n]` ones."""
        return np.ones(len(places))

    def stays(self, action: int, *, opened: bool) -> float:
        """It always does."""
        return 1.0

    def predict(self, poses: Ints, action: int, percept: Percept) -> Ahead:
        """It stays."""
        return ((poses, 1.0, 1.0),)

    def ahead(self, place: int, action: int) -> tuple[Position | None, int | None]:
        """Nobody knows."""
        return None, None

    def information(self, places: Ints, steps: int) -> Floats:
        """None."""
        return np.zeros((len(places), steps + 1))
