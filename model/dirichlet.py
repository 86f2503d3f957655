"""Sparse growing tables of Dirichlet counts."""

from __future__ import annotations

from functools import reduce
from math import inf
from operator import add

import numpy as np
from numpy.typing import NDArray

from .errors import CogmapError
from .journal import Journal

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

EMPTY = -2
"""Key of an unused slot."""


def _grown(array: NDArray[np.generic], shape: tuple[int, int], fill: float) -> NDArray[np.generic]:
    larger = np.full(shape, fill, dtype=array.dtype)
    larger[: array.shape[0], : array.shape[1]] = array
    return larger


class SparseDirichlet:
    """Rows of Dirichlet counts over a growing domain; only outcomes with counts of their own are stored.

    The concentration of an outcome is `background + prior + evidence`. Outcomes without a slot have the
    background alone, times `outcomes` of them. Evidence never falls below zero, so counts never fall below
    their prior. Appending rows is amortised: storage doubles. Prior and evidence of a row, and their sum, are added up
    when they change, not when they are read.

    Attributes:
        background: concentration of every outcome of the domain, whether it has a slot or not.
        outcomes: size of the domain; matters only where `background` is positive.
        journal: of the rows that change.
    """

    __slots__ = ("_alpha", "_evidence", "_keys", "_prior", "_rows", "_total", "background", "journal", "outcomes")

    def __init__(self, *, slots: int, background: float = 0.0, outcomes: int = 0) -> None:
        self.background = background
        self.outcomes = outcomes
        self.journal = Journal()
        self._rows = 0
        self._keys: Ints = np.full((8, slots), EMPTY, dtype=np.int64)
        self._prior: Floats = np.zeros((8, slots))
        self._evidence: Floats = np.zeros((8, slots))
        self._alpha: Floats = np.zeros((8, slots))  # prior + evidence
        self._total: Floats = np.zeros(8)  # of each row of `_alpha`

    def __len__(self) -> int:
        return self._rows

    @property
    def nbytes(self) -> int:
        """Bytes of storage in use."""
        return self._rows * (self._keys.shape[1] * 32 + 8)

    def append(self, rows: int) -> int:
        """Append empty rows; returns the index of the first."""
        first = self._rows
        self._rows += rows
        capacity, slots = self._keys.shape
        if self._rows > capacity:
            self._resize(max(self._rows, 2 * capacity), slots)
        return first

    def shrink(self, rows: int) -> None:
        """Keep the first `rows` rows."""
        self._keys[rows : self._rows] = EMPTY
        for array in (self._prior, self._evidence, self._alpha, self._total):
            array[rows : self._rows] = 0.0
        self._rows = rows
        self.journal.note(None)

    def _add_up(self, rows: Ints | slice = slice(None)) -> None:
        self._alpha[rows] = self._prior[rows] + self._evidence[rows]
        self._total[rows] = reduce(add, self._alpha[rows].T)  # slot by slot, as `_set` does

    def _set(self, row: int, slot: int, *, prior: float, evidence: float) -> None:
        self._prior[row, slot], self._evidence[row, slot] = prior, evidence
        self._alpha[row, slot] = prior + evidence
        self._total[row] = reduce(add, self._alpha[row].tolist())
        self.journal.note(row)

    def _resize(self, rows: int, slots: int) -> None:
        self._keys = _grown(self._keys, (rows, slots), EMPTY).astype(np.int64)
        self._prior = _grown(self._prior, (rows, slots), 0.0).astype(np.float64)
        self._evidence = _grown(self._evidence, (rows, slots), 0.0).astype(np.float64)
        self._alpha, self._total = np.zeros((rows, slots)), np.zeros(rows)
        self._add_up()

    def _slot(self, row: int, key: int) -> int:
        """Slot of `key` in `row`; taken anew where it has none."""
        keys = self._keys[row].tolist()
        if key in keys:
            return keys.index(key)
        if EMPTY not in keys:
            self._resize(self._keys.shape[0], 2 * self._keys.shape[1])
            return self._slot(row, key)
        slot = keys.index(EMPTY)
        self._keys[row, slot] = key
        return slot

    def expect(self, row: int, key: int, prior: float) -> None:
        """Give outcome `key` of `row` a prior of its own."""
        slot = self._slot(row, key)
        self._set(row, slot, prior=prior, evidence=self._evidence.item(row, slot))

    def rename(self, row: int, old: int, new: int) -> None:
        """Let the slot of outcome `old` stand for `new`, with the counts it has.

        Raises:
            CogmapError: `new` has a slot of its own.
        """
        if new in self._keys[row].tolist():
            raise CogmapError(f"table: outcome {new} of row {row} has counts already; rename to an outcome without")
        slot = self._slot(row, old)  # may put larger arrays in place
        self._keys[row, slot] = new
        self.journal.note(row)

    def add(self, row: int, key: int, amount: float, *, most: float = inf) -> float:
        """Add evidence (negative takes away) for `key` in `row`, `most` in all; returns what was really added."""
        if amount <= 0.0 and self.evidence(row, key) == 0.0:
            return 0.0
        slot = self._slot(row, key)
        before = self._evidence.item(row, slot)
        after = min(max(before + amount, 0.0), max(before, most))
        if after != before:
            self._set(row, slot, prior=self._prior.item(row, slot), evidence=after)
        return after - before

    def evidence(self, row: int, key: int) -> float:
        """Evidence for `key` in `row`, prior left out."""
        keys = self._keys[row].tolist()
        return self._evidence.item(row, keys.index(key)) if key in keys else 0.0

    def counts(self, row: int) -> dict[int, float]:
        """Evidence of `row` by outcome, prior left out."""
        return dict(zip(self._keys[row].tolist(), self._evidence[row].tolist(), strict=True))

    def fade(self, rows: Ints | slice, keep: float) -> None:
        """Multiply the evidence of `rows` by `keep`, in [0, 1]: what was learned long ago fades."""
        self._evidence[rows] *= keep
        self._add_up(rows)
        self.journal.note(None)

    def keys(self, rows: Ints | slice) -> Ints:
        """`[n, slots]` outcomes that have a slot in `rows` (`EMPTY` where unused)."""
        return self._keys[rows]

    def total(self, rows: Ints) -> Floats:
        """`[n]` counts of `rows` in all, background left out."""
        return self._total[rows]

    def concentrations(self, row: int) -> dict[int, float]:
        """Prior and evidence of `row` by outcome, background left out."""
        return dict(zip(self._keys[row].tolist(), self._alpha[row].tolist(), strict=True))

    def concentration(self, rows: Ints) -> tuple[Ints, Floats, Floats]:
        """Counts of `rows`.

        Returns:
            keys `[n, slots]` (`EMPTY` where unused), concentrations `[n, slots]` (zero where unused), and
            the number of outcomes without a slot, `[n]`, each of concentration `background`.
        """
        keys, alpha = self._keys[rows], self._alpha[rows]
        used = keys != EMPTY
        if self.background:
            alpha += self.background * used
        return keys, alpha, np.maximum(float(self.outcomes) - used.sum(axis=1), 0.0)

    def mean(self, rows: Ints) -> tuple[Ints, Floats, Floats]:
        """Expected probabilities of `rows`: keys and P `[n, slots]`, and P `[n]` of one outcome without a slot.

        A row that has no counts at all gives zero to every outcome.
        """
        keys, p, mass = self._keys[rows], self._alpha[rows], self._mass(rows)
        if self.background:
            p += self.background * (keys != EMPTY)
        p /= mass[:, None]
        return keys, p, self.background / mass

    def probability(self, key: int | Ints, rows: Ints) -> Floats:
        """Expected probability `[n]` of outcome `key` (one, or one a row) in `rows`."""
        match = self._keys[rows] == (key if isinstance(key, int) else np.reshape(key, (-1, 1)))
        alpha = np.einsum("ns,ns->n", self._alpha[rows], match)
        return (alpha + self.background) / self._mass(rows)

    def _mass(self, rows: Ints) -> Floats:
        """`[n]` concentrations of `rows` in all; one where there are none."""
        if self.background:
            return self._total[rows] + self.background * self.outcomes
        mass = self._total[rows]
        mass[mass == 0.0] = 1.0
        return mass

    def dense(self, outcomes: int) -> Floats:
        """Expected probabilities `[outcomes + 1, rows]`; the last line is everything not among the first ones."""
        table = np.zeros((outcomes + 1, self._rows))
        keys, p, other = self.mean(np.arange(self._rows))
        table[:-1] = other
        for row, (row_keys, row_p) in enumerate(zip(keys.tolist(), p.tolist(), strict=True)):
            for key, value in zip(row_keys, row_p, strict=True):
                if 0 <= key < outcomes:
                    table[key, row] = value
        table[-1] = np.maximum(1.0 - table[:-1].sum(axis=0), 0.0)
        return table

    def state(self) -> dict[str, NDArray[np.generic]]:
        """Copies of the arrays that hold every count, for saving."""
        rows = slice(self._rows)
        parts = {"keys": self._keys, "prior": self._prior, "evidence": self._evidence}
        return {name: part[rows].copy() for name, part in parts.items()}

    def restore(self, state: dict[str, NDArray[np.generic]]) -> None:
        """Take over what `state` returned."""
        self._keys = state["keys"].astype(np.int64)
        self._prior = state["prior"].astype(np.float64)
        self._evidence = state["evidence"].astype(np.float64)
        self._rows = self._keys.shape[0]
        self._alpha, self._total = np.zeros_like(self._prior), np.zeros(self._rows)
        self._add_up()
        self.journal.note(None)
