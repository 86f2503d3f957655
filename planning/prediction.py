"""Beliefs of a level of the prefix tree from those of the level above: one product."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from .local import Transitions

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

Predict = Callable[[Floats, Ints, Ints], Floats]
"""`[n, R]` beliefs of children: of those above `[m, R]`, the parent `[n]` of each among them, and its action `[n]`."""

FEW = 64
"""Places up to which one dense product for all actions is quicker than anything that spares work."""


def predictor(B: Transitions) -> Predict:
    """What predicts with B."""
    if B.shape[0] <= FEW:
        return partial(_every_action, B.by_place.reshape(B.shape[0], -1))
    return partial(_successors, B)


def _every_action(B: Floats, before: Floats, parent: Ints, action: Ints) -> Floats:
    """All actions of every parent, and of these the children, with B `[R, K * R]`, B[s, a, s']."""
    size = len(B)
    return (before @ B).reshape(-1, size).take(parent * (B.shape[1] // size) + action, axis=0)


def _successors(B: Transitions, before: Floats, parent: Ints, action: Ints) -> Floats:
    return B.predicted(before[parent], action)
