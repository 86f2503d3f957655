"""Where actions lead, held as the few successors that each place has."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from ...model import Floats, Ints

MANY = np.iinfo(np.int64).max
FEW = 64  # places up to which one dense product for all actions is quicker than anything that spares work
WIDE = 8  # actions from which on it pays to leave out those that no policy takes


@dataclass(frozen=True)
class Transitions:
    """P(s' | s, a) over `R` places, its few successors alone."""

    successors: Ints  # `[R, K, n]` places that an action may lead to; one may be named more than once
    probability: Floats  # `[R, K, n]` of each; sums to one over the last axis, zero where a slot is unused

    @classmethod
    def of(cls, dense: ArrayLike) -> Transitions:
        """Those of a dense table `[R, R, K]`, B[s', s, a]."""
        B = np.asarray(dense, dtype=np.float64).transpose(1, 2, 0)
        slots = max(1, int((B > 0.0).sum(axis=2).max(initial=0)))
        successors = np.argsort(-B, axis=2, kind="stable")[:, :, :slots]
        return cls(successors, np.take_along_axis(B, successors, axis=2))

    @cached_property
    def by_place(self) -> Floats:
        """`[R, K, R]` the dense table as B[s, a, s']: R^2 numbers an action, for few places."""
        size, actions, _ = self.successors.shape
        at = (np.arange(size * actions) * size).reshape(size, actions, 1) + self.successors
        dense = np.bincount(at.ravel(), weights=self.probability.ravel(), minlength=actions * size * size)
        return dense.astype(np.float64, copy=False).reshape(size, actions, size)

    @property
    def dense(self) -> Floats:
        """`[R, R, K]` the dense table as B[s', s, a]: R^2 numbers an action, for few places."""
        return self.by_place.transpose(2, 0, 1)

    def predicted(self, belief: Floats, before: Ints, action: Ints) -> Floats:
        """`[n, R]` Q'(s') = sum_s B[s', s, a] Q(s): rows `before` of the beliefs `[m, R]`, each after its action."""
        size, actions, _ = self.successors.shape
        if size <= FEW:
            every = belief @ self.by_place.reshape(size, -1)
            return every.reshape(-1, size).take(before * actions + action, axis=0)
        return self._touched(belief[before], action)

    def _touched(self, belief: Floats, action: Ints) -> Floats:
        """The same for one belief an action, by what holds mass alone."""
        many, size = belief.shape
        if many == 1:
            return self._of_one(belief[0], int(action[0]))[None]
        row, place = np.nonzero(belief)
        taken = action[row]
        at = row[:, None] * size + self.successors[place, taken]
        mass = belief[row, place][:, None] * self.probability[place, taken]
        after = np.bincount(at.ravel(), weights=mass.ravel(), minlength=many * size)
        return after.astype(np.float64, copy=False).reshape(many, size)

    def _of_one(self, belief: Floats, action: int) -> Floats:
        """The same for one belief."""
        place = belief.nonzero()[0]
        mass = belief.take(place)[:, None] * self.probability[place, action]
        after = np.bincount(self.successors[place, action].ravel(), weights=mass.ravel(), minlength=len(belief))
        return after.astype(np.float64, copy=False)

    def used(self, action: Ints) -> tuple[Transitions, Ints]:
        """Those of some actions alone, where most are in no use, and these actions by their new numbers."""
        if self.successors.shape[1] <= WIDE:
            return self, action
        numbers, renamed = np.unique(action, return_inverse=True)
        return Transitions(self.successors[:, numbers], self.probability[:, numbers]), renamed

    def settled(self, action: int) -> bool:
        """Whether the action certainly leaves every place as it is."""
        here = np.arange(len(self.successors))[:, None]
        elsewhere = (self.successors[:, action] != here) & (self.probability[:, action] > 0.0)
        return not elsewhere.any()

    def reachable(self, places: Ints, steps: int) -> Ints:
        """The places, ascending, that so many steps may lead to."""
        known = np.zeros(len(self.successors), dtype=np.bool_)
        known[places] = True
        for _ in range(steps):
            reached = self.successors[places][self.probability[places] > 0.0]
            places = np.unique(reached[~known[reached]])
            known[places] = True
        return np.flatnonzero(known)

    def within(self, places: Ints) -> Transitions:
        """The same over some of the places, ascending; what leads to others stays where it is."""
        local = np.zeros(len(self.successors), dtype=np.int64)
        inside = np.zeros(len(self.successors), dtype=np.bool_)
        local[places], inside[places] = np.arange(len(places)), True
        successors = self.successors[places]
        here = np.arange(len(places))[:, None, None]
        return Transitions(np.where(inside[successors], local[successors], here), self.probability[places])


def likeliest(successors: Ints, probability: Floats, places: Ints, nowhere: int) -> tuple[Ints, Floats]:
    """`[n, K]` where each action most probably leads besides the place itself, and the probability of staying.

    The first is -1 where that is less probable than staying or than `nowhere`. Of equals it is the one with the lowest
    number.

    Args:
        successors: `[n, K, slots]`.
        probability: `[n, K, slots]`, zero where a slot is unused.
        places: `[n]` the place that each row is of.
        nowhere: the number that stands for a place never imagined.
    """
    own = successors == places[:, None, None]
    lost = successors == nowhere
    others = np.where(own | lost, 0.0, probability)
    p = others.max(axis=2)
    best = np.where(others == p[..., None], successors, MANY).min(axis=2)
    staying, losing = np.einsum("nks,nks->nk", probability, own), np.einsum("nks,nks->nk", probability, lost)
    return np.where((p > 0.0) & (p >= staying) & (p >= losing), best, -1), staying
