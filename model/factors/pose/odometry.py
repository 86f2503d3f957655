"""What odometry measured of a move, as evidence of the move that was made."""

from collections.abc import Sequence

import numpy as np

from ...motions import Motions
from ..base import Floats

SPREAD = 0.1
"""Standard deviation of a measurement along each axis, as a share of a move's mean length, as it is guessed."""

DEGREES = 3.0
"""Of the Student t that follows, since the spread is a guess: a measurement that is far off everything says little."""


def odometry(motions: Motions, measured: Sequence[float]) -> Floats:
    """`[K]` log P(measured | the move of each action was made), up to a constant: the largest is 0.

    A displacement of D numbers is measured with Gaussian noise, of which the variance has an inverse gamma prior about
    σ²: log P = -(ν + D) / 2 log(1 + |measured - displacement|² / (ν σ²)).
    """
    moves = np.array(motions.displacements, dtype=np.float64)
    lengths = np.linalg.norm(moves, axis=1)
    scale = SPREAD * lengths.sum() / max(np.count_nonzero(lengths), 1) or 1.0
    far = np.hypot.reduce((moves - np.array(measured)) / scale, axis=1)  # squares could be too large for numbers
    log = -(DEGREES + moves.shape[1]) * np.log(np.hypot(1.0, far / np.sqrt(DEGREES)))
    return log - log.max()
