"""Mathematics of clusters of vectors."""

from math import lgamma, log, pi

import numpy as np
from numpy.typing import NDArray

from .base import Floats


def student(squares: Floats, variance: Floats, degrees: float, size: int) -> Floats:
    """`[K]` log density of a D-dimensional Student t at a squared distance from its centre, in nats."""
    constant = lgamma(0.5 * (degrees + size)) - lgamma(0.5 * degrees) - 0.5 * size * log(degrees * pi)
    return constant - 0.5 * size * np.log(variance) - 0.5 * (degrees + size) * np.log1p(squares / (degrees * variance))


def seating(many: Floats, few: Floats, concentration: float) -> Floats:
    """`[n]` log odds that so many vectors are of one prototype to that they are of two (Chinese restaurant process)."""
    from scipy.special import gammaln  # slow to import, and only needed here

    return gammaln(many + few) - gammaln(many) - gammaln(few) - log(concentration)


def halves(vectors: Floats, *, rounds: int = 4) -> NDArray[np.bool_]:
    """`[n]` which of the vectors belong with the one that is farthest from their mean (2-means)."""
    far = int(((vectors - vectors.mean(axis=0)) ** 2).sum(axis=1).argmax())
    other = int(((vectors - vectors[far]) ** 2).sum(axis=1).argmax())
    centres = vectors[[far, other]]
    half = np.zeros(len(vectors), dtype=np.bool_)
    for _ in range(rounds):
        squares = ((vectors[:, None] - centres) ** 2).sum(axis=2)
        half = squares[:, 0] <= squares[:, 1]
        if half.all() or not half.any():
            return half
        centres = np.stack([vectors[half].mean(axis=0), vectors[~half].mean(axis=0)])
    return half
