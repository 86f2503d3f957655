"""Geometric sums, for terms that stay the same step by step."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def geometric(ratio: float, terms: Floats | float) -> Floats:
    """1 + ratio + ... of so many terms, ratio above 0, at most 1."""
    many = np.asarray(terms, dtype=np.float64)
    if ratio == 1.0:
        return many
    return np.expm1(many * np.log(ratio)) / np.expm1(np.log(ratio))
