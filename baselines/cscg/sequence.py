"""What was sensed and done, as numbers, and the (sight, action, next sight) triples that occur in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...worlds import WorldError

Ints = NDArray[np.int64]


@dataclass(frozen=True)
class Walk:
    """A history of sights and the actions between them."""

    sights: Ints  # `[T]` the index of each sight, T >= 1
    actions: Ints  # `[T - 1]` the index of the action between each two sights

    @classmethod
    def of(cls, sights: Sequence[int] | Ints, actions: Sequence[int] | Ints) -> Walk:
        """The walk with these sights and actions.

        Raises:
            WorldError: no sight, negative numbers, or not one action fewer than sights.
        """
        x, a = np.asarray(sights, dtype=np.int64), np.asarray(actions, dtype=np.int64)
        if x.ndim != 1 or not x.size or a.shape != (x.size - 1,):
            raise WorldError(f"a walk has one action fewer than sights; got {x.size} sights and {a.size} actions")
        if min(x.min(), a.min(initial=0)) < 0:
            raise WorldError("a walk numbers its sights and actions from 0; got a negative number")
        return cls(x, a)

    def __len__(self) -> int:
        return self.sights.size

    @cached_property
    def triples(self) -> Ints:
        """`[N, 3]` the distinct (sight, action, next sight), in lexicographic order."""
        return self._numbered[0]

    @cached_property
    def which(self) -> Ints:
        """`[T - 1]` the row of `triples` that each step is."""
        return self._numbered[1]

    @cached_property
    def _numbered(self) -> tuple[Ints, Ints]:
        return distinct(np.stack([self.sights[:-1], self.actions, self.sights[1:]], axis=1))


@dataclass(frozen=True)
class Triples:
    """The (sight, action, next sight) that have a block of their own in a model."""

    rows: Ints  # `[N, 3]` distinct, in lexicographic order

    def __len__(self) -> int:
        return len(self.rows)

    @cached_property
    def starts(self) -> Ints:
        """`[G]` the first triple of each (sight, action)."""
        return np.flatnonzero(self._new)

    @cached_property
    def group(self) -> Ints:
        """`[N]` which (sight, action) each triple belongs to."""
        return np.cumsum(self._new) - 1

    @cached_property
    def sizes(self) -> Ints:
        """`[G]` how many triples each (sight, action) has."""
        return np.bincount(self.group, minlength=len(self.starts))

    @cached_property
    def heads(self) -> Ints:
        """`[G, 2]` each (sight, action)."""
        return self.rows[self.starts, :2]

    @cached_property
    def number(self) -> dict[tuple[int, int, int], int]:
        """The row of each triple."""
        return {(s, a, r): k for k, (s, a, r) in enumerate(self.rows.tolist())}

    def steps(self, walk: Walk) -> Ints:
        """`[T - 1]` the row that each step of `walk` is; all of them must be there."""
        if len(self) == len(walk.triples):
            return walk.which
        rows = np.array([self.number[s, a, r] for s, a, r in walk.triples.tolist()], dtype=np.int64)
        return rows[walk.which]

    @cached_property
    def _new(self) -> NDArray[np.bool_]:
        new = np.ones(len(self.rows), dtype=bool)
        new[1:] = (self.rows[1:, :2] != self.rows[:-1, :2]).any(axis=1)
        return new


def distinct(rows: Ints) -> tuple[Ints, Ints]:
    """The distinct rows in lexicographic order, and the number of each row among them."""
    found, which = np.unique(rows, axis=0, return_inverse=True)
    return found, which.reshape(-1)
