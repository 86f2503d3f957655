"""What is learned of the lengths of ways, and of how far measurements of moves err."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...changes import Changes
from ...column import Column
from ..base import Floats, Ints
from .relaxing import AXES, Measured

COMPASS = 0.0105  # standard deviation of a bearing, radians: whole degrees, some of them made different from each other

USUAL, COUNTS = 0.002, 4.0
"""Standard deviation of a measurement over its length before anything is known, and how many count for it."""

ERRS = 0.006  # rate from which on measurements are not taken for exact

LEAST = 0.01
"""Mean lengths of a way that a move counts for at least, where it is asked how far its measurement may err."""

WIDE = 0.3
"""Mean lengths of a way by which it matters where a place is entered, on open ground, where no bearings are seen."""

GUESSED = 0.5  # standard deviation of a length that was not measured, over the mean length
SHORT = 0.1  # mean lengths of a way that one counts for at least among the logarithms: some places have one position

SPREAD, FEW = 0.5, 4
"""Standard deviation of the logarithm of lengths before any was measured, and how many measurements it counts for."""


@dataclass(frozen=True, slots=True)
class Move:
    """A move as it was measured."""

    raw: Floats  # `[3]` as measured
    moved: Floats  # `[3]` how far it most probably led, by what was measured and by the bearing of its way
    along: float  # standard deviation of its length


class Odometer:
    """How long ways are, and how far measurements of moves err, over their length: counts and sums.

    Attributes:
        noted: ways measured, the sum of the logarithms of their lengths and of the squares of these, their lengths in
            all, the longest; measurements whose error was seen, and the sum of the squares of these over lengths.
    """

    def __init__(self, changes: Changes) -> None:
        self.noted = Column("odometer", np.float64, changes=changes)
        self.noted.resize(7)

    @property
    def longest(self) -> float:
        """The longest way that was measured."""
        return float(self.noted.values[4]) or 1.0

    @property
    def length(self) -> float:
        """The mean length of a way."""
        many, total = self.noted.values[[0, 3]].tolist()
        return total / many if many else 1.0

    @property
    def rate(self) -> float:
        """Standard deviation of a measurement along each axis, over the length of the move: posterior mean of σ²."""
        many, squares = self.noted.values[5:7].tolist()
        return float(np.sqrt((COUNTS * USUAL**2 + squares) / (COUNTS + many)))

    @property
    def errs(self) -> bool:
        """Whether measurements are not exact."""
        return self.rate > ERRS

    def log_length(self, length: Any) -> Any:
        """How long that is: standard deviations of the logarithm of lengths above their mean."""
        many, logs, squares = self.noted.values[:3].tolist()
        mean = logs / max(many, 1.0)
        spread = np.sqrt((max(squares - many * mean * mean, 0.0) + FEW * SPREAD**2) / (many + FEW))
        return (np.log(np.maximum(length, 1e-9)) - mean) / spread

    def most(self, along: float) -> float:
        """Standard deviation of where one is after all ways that were measured, and a move of such a one."""
        many, _, _, _, longest = self.noted.values[:5].tolist()
        return float(np.hypot(np.sqrt(many) * self.rate * longest, along)) if many else np.inf

    def moved(self, displacement: Sequence[float] | None, bearing: float) -> Move | None:
        """A move along a way with this bearing, below 0 where it has none; None where nothing is known of it."""
        if displacement is None and bearing < 0.0:
            return None
        if displacement is None:
            raw, many = self.length * direction(np.array([bearing]))[0], 0.0
        else:
            raw, many = np.array([*displacement, 0.0])[:AXES], 1.0
        weighed = self.weighed(np.zeros((1, 2), dtype=np.int64), raw[None], np.array([many]), np.array([bearing]))
        return Move(raw, weighed.moved[0], float(weighed.along[0]))

    def weighed(self, ends: Ints, moved: Floats, many: Floats, bearing: Floats) -> Measured:
        """Measurements by what they are worth, what the bearings of the ways say taken in.

        Args:
            ends: `[E, 2]` between which places.
            moved: `[E, 3]` the mean of what was measured.
            many: `[E]` how often; 0 where a length is only guessed.
            bearing: `[E]` degrees, below 0 where there is none.
        """
        length = np.maximum(np.linalg.norm(moved, axis=1), LEAST * self.length)
        along = length * np.where(many > 0.0, self.rate / np.sqrt(np.maximum(many, 1.0)), GUESSED)
        along = np.where(bearing < 0.0, np.hypot(along, WIDE * self.length), along)
        u, square = direction(bearing), across(bearing)
        told = (bearing >= 0.0) & ((moved * u).sum(axis=1) > 0.0)  # who walked backwards walked another way
        told &= self.errs | (many < 1.0)
        off, blur = (moved * square).sum(axis=1), np.square(COMPASS * length)
        share = np.where(told, np.square(along) / (np.square(along) + blur), 0.0)
        sideways = np.where(told, np.sqrt(share * blur), along)
        return Measured(ends, moved - (share * off)[:, None] * square, along, sideways)

    def learn_direction(self, displacement: Sequence[float] | None, bearing: float) -> None:
        """How far a move was measured to lead off the bearing of its way tells how far measurements err."""
        if displacement is None or bearing < 0.0:
            return
        raw, bearings = np.array([*displacement, 0.0])[:AXES], np.array([bearing])
        off, length = float(across(bearings)[0] @ raw), float(np.linalg.norm(raw))
        if direction(bearings)[0] @ raw > abs(off):
            beyond = max((off / length) ** 2 - COMPASS**2, 0.0)
            self._err(1.0, beyond)

    def learn(self, off: Floats, square: float) -> None:
        """A measurement was so far off something whose variance is `square` where the rate is 1."""
        flat = off[: 3 if off[2] else 2]
        ratio = float(np.square(flat).mean()) / max(square, 1e-18)
        if ratio <= 25.0 * max(self.rate, 0.02) ** 2:  # else it is no error of measurement
            self._err(1.0, ratio)

    def measure(self, length: float) -> None:
        """A way that was not walked before is so long."""
        many, logs, squares, total, longest = self.noted.values[:5].tolist()
        log = float(np.log(max(length, SHORT * (total + length) / (many + 1.0))))
        new = many + 1.0, logs + log, squares + log * log, total + length, max(longest, length)
        for at, value in enumerate(new):
            self.noted.set(at, value)

    def _err(self, many: float, square: float) -> None:
        before, squares = self.noted.values[5:7].tolist()
        self.noted.set(5, before + many)
        self.noted.set(6, squares + square)


def direction(bearing: Floats) -> Floats:
    """`[n, 3]` where a bearing in degrees leads; 0 is +y, clockwise."""
    angle = np.deg2rad(bearing)
    return np.stack([np.sin(angle), np.cos(angle), np.zeros(len(angle))], axis=1)


def across(bearing: Floats) -> Floats:
    """`[n, 3]` square to it, to the left."""
    ahead = direction(bearing)
    return np.stack([-ahead[:, 1], ahead[:, 0], ahead[:, 2]], axis=1)
