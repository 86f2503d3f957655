"""Beliefs of a level of the prefix tree from those of the level above: one product, whatever B is held as."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from .transitions import Transitions

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

Predict = Callable[[Floats, Ints, Ints], Floats]
"""`[n, R]` beliefs of children: of those above `[m, R]`, the parent `[n]` of each among them, and its action `[n]`."""

FEW = 64
"""Places up to which one dense product for all actions is quicker than anything that spares work."""


def predictor(B: Floats | Transitions) -> Predict:
    """What predicts with B, an array `[R, R, K]` or successors."""
    few = B.shape[0] <= FEW
    if isinstance(B, Transitions):
        return partial(_every_action, _by_place(B.by_place)) if few else partial(_successors, B)
    if few:
        return partial(_every_action, _by_place(np.ascontiguousarray(B.transpose(1, 2, 0))))
    return partial(_action_by_action, B.transpose(2, 1, 0))


def _by_place(B: Floats) -> Floats:
    """`[R, K * R]` from `[R, K, R]`, B[s, a, s']."""
    return B.reshape(len(B), -1)


def _every_action(B: Floats, before: Floats, parent: Ints, action: Ints) -> Floats:
    """All actions of every parent, and of these the children."""
    size = len(B)
    return (before @ B).reshape(-1, size).take(parent * (B.shape[1] // size) + action, axis=0)


def _action_by_action(B: Floats, before: Floats, parent: Ints, action: Ints) -> Floats:
    """The children of each action, with B `[K, R, R]`, B[a, s, s']."""
    after = np.empty((len(parent), before.shape[1]))
    for a in np.flatnonzero(np.bincount(action)).tolist():
        these = action == a
        after[these] = before[parent[these]] @ B[a]
    return after


def _successors(B: Transitions, before: Floats, parent: Ints, action: Ints) -> Floats:
    return B.predicted(before[parent], action)
