"""Beliefs rolled forward along policies, and the sums over places that terms are made of."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...model import Floats, Ints
from ..local import LocalModel

_OF_BELIEFS = ("staying", "visits", "reached", "_so_far", "_visited", "_held", "_belief_held")
FEW = 64  # places up to which it does not pay to leave out those without belief


@dataclass(frozen=True)
class Rollout:
    """Expectations after each of `N` prefixes of policies, level by level. The first prefix is empty."""

    model: LocalModel  # the local model of `R` places
    parent: Ints  # `[N]` the prefix that is one step shorter; the empty one is its own
    action: Ints  # `[N]` the last action; of the empty prefix it means nothing
    levels: list[tuple[int, int]]  # for each length from 1 on, where the prefixes of that length begin and end
    belief: Floats  # `[N, R]` Q after each prefix

    def again(self, model: LocalModel) -> Rollout:
        """The same beliefs in a model of other sights; what was worked out of the beliefs alone comes along."""
        new = Rollout(model, self.parent, self.action, self.levels, self.belief)
        new.__dict__.update({name: value for name, value in self.__dict__.items() if name in _OF_BELIEFS})
        return new

    def expected(self, values: Floats) -> Floats:
        """`[N, ...]` sum_s Q(s) values[s], of `values [R, ...]`."""
        return self._belief_held @ values[self._held]

    @cached_property
    def sights(self) -> Floats:
        """`[N, O]` P(o) after each prefix."""
        return self.expected(np.ascontiguousarray(self.model.A.T))

    @cached_property
    def staying(self) -> NDArray[np.bool_]:
        """`[N]` whether the last step stays."""
        return self.action == self.model.motions.stay

    @cached_property
    def visits(self) -> Floats:
        """`[N, R]` expected visits so far: the sum of the beliefs, that before the first step left out."""
        return self._so_far[0]

    @cached_property
    def reached(self) -> Floats:
        """`[N, R]` probability of any visit so far.

        It is the largest of the beliefs, a bound that is exact on the way to a place and while staying there.
        """
        return self._so_far[1]

    @cached_property
    def _so_far(self) -> tuple[Floats, Floats]:
        visits, reached = np.zeros_like(self.belief), np.zeros_like(self.belief)
        for begin, end in self.levels:
            parent, belief = self.parent[begin:end], self.belief[begin:end]
            np.add(visits[parent], belief, out=visits[begin:end])
            np.maximum(reached[parent], belief, out=reached[begin:end])
        return visits, reached

    def collected(self, table: Floats) -> Floats:
        """`[N]` what visits so far teach: sum_s q I_s(v / q) of expected visits v and probability q of any visit.

        Args:
            table: `[R, M + 1]` I from 0..M visits, zero in column 0; linear in between, constant beyond.
        """
        row, place, visits, reached, whole = self._visited
        whole = np.minimum(whole, table.shape[1] - 1)
        low, high = table[place, whole], table[place, np.minimum(whole + 1, table.shape[1] - 1)]
        worth = reached * low + (visits - reached * whole) * (high - low)
        return np.bincount(row, weights=worth, minlength=len(self.belief)).astype(np.float64, copy=False)

    def tried(self, place: Ints, action: Ints) -> Floats:
        """`[N, P]` probability that each of `P` actions was taken in its place so far: the largest of the beliefs."""
        tried = np.zeros((len(self.belief), len(place)))
        for begin, end in self.levels:
            parent = self.parent[begin:end]
            now = self.belief[np.ix_(parent, place)] * (self.action[begin:end, None] == action)
            np.maximum(tried[parent], now, out=tried[begin:end])
        return tried

    @cached_property
    def _visited(self) -> tuple[Ints, Ints, Floats, Floats, Ints]:
        """Prefix and place of every expected visit, how many, with what probability any, and how many in that case."""
        row, place = np.nonzero(self.visits)
        visits, reached = self.visits[row, place], self.reached[row, place]
        return row, place, visits, reached, (visits / reached).astype(np.int64)

    @cached_property
    def _held(self) -> Ints | slice:
        """Places that hold belief anywhere."""
        return slice(None) if self.belief.shape[1] <= FEW else np.flatnonzero(self.belief.any(axis=0))

    @cached_property
    def _belief_held(self) -> Floats:
        return self.belief[:, self._held]


@dataclass(frozen=True)
class Staying(Rollout):
    """One step that stays after each of some prefixes, and leaves every belief as it is; each is its own parent."""

    rolled: Rollout  # the rollout that the prefixes are of; visits are those before the step
    ends: Ints  # which of its prefixes

    @classmethod
    def after(cls, rolled: Rollout, ends: Ints) -> Staying:
        """After these prefixes of a rollout."""
        action = np.full(len(ends), rolled.model.motions.stay)
        return cls(rolled.model, np.arange(len(ends)), action, [], rolled.belief[ends], rolled, ends)

    @cached_property
    def visits(self) -> Floats:
        """`[N, R]` expected visits before the step."""
        return self.rolled.visits[self.ends]

    @cached_property
    def reached(self) -> Floats:
        """`[N, R]` probability of any visit before the step."""
        return self.rolled.reached[self.ends]
