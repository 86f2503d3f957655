"""Sparse growing tables of Dirichlet counts."""

from collections.abc import Iterable, Mapping, Sequence
from functools import reduce
from math import inf
from operator import add
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .arrays import Floats, Ints
from .changes import Change, Changes
from .errors import CogmapError

EMPTY = -2
"""Key of an unused slot."""

LARGEST = 1e301  # what no count reaches, so that all those of a row have a finite sum


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

    Args:
        slots: outcomes of a row that there is room for; more is made when it is needed.
        background: concentration of every outcome of the domain, whether it has a slot or not.
        outcomes: size of the domain; matters only where `background` is positive.
        name: symbol of the table, unique in its map.
        rows_each: rows that a place has.
        changes: the log that is told what changes; none unless given.

    Attributes:
        name, background, outcomes, rows_each: as given; only `outcomes` may be set.
    """

    __slots__ = (
        "_alpha",
        "_changes",
        "_evidence",
        "_keys",
        "_prior",
        "_rows",
        "_total",
        "background",
        "name",
        "outcomes",
        "rows_each",
    )

    def __init__(
        self,
        *,
        slots: int,
        background: float = 0.0,
        outcomes: int = 0,
        name: str = "table",
        rows_each: int = 1,
        changes: Changes | None = None,
    ) -> None:
        self.name = name
        self.background = background
        self.outcomes = outcomes
        self.rows_each = rows_each
        self._changes = changes
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

    def resize(self, rows: int) -> None:
        """Have so many rows: empty ones are appended, or the last are dropped; not logged."""
        capacity, slots = self._keys.shape
        if rows > capacity:
            self._resize(max(rows, 2 * capacity), slots)
        self._keys[rows : self._rows] = EMPTY
        for array in (self._prior, self._evidence, self._alpha, self._total):
            array[rows : self._rows] = 0.0
        self._rows = rows

    def begin(self, rows: slice, keys: Ints, prior: Floats) -> None:
        """What rows that were just appended know: outcomes `[n, k]` and their priors; not logged."""
        width = keys.shape[1]
        self._keys[rows, :width], self._prior[rows, :width] = keys, prior
        self._add_up(rows)

    def _add_up(self, rows: Ints | slice = slice(None)) -> None:
        self._alpha[rows] = self._prior[rows] + self._evidence[rows]
        self._total[rows] = reduce(add, self._alpha[rows].T)  # slot by slot, as `_set` does

    def _set(self, row: int, slot: int, key: int, prior: float, evidence: float) -> None:
        old = self._keys.item(row, slot), self._prior.item(row, slot), self._evidence.item(row, slot)
        new = key, prior, evidence
        if new != old:
            if self._changes is not None:  # first, so that what is half done can be undone
                self._changes.append(Change(self, (row, slot), old, new))
            self.put((row, slot), new)

    def write(self, rows: Ints, keys: Ints, prior: Floats, evidence: Floats) -> None:
        """Have these rows say this, `[n, slots]` each; one entry of the log, however many they are."""
        new = keys, prior, evidence
        if self._changes is not None:  # first, so that what is half done can be undone
            self._changes.append(Change(self, rows, (self._keys[rows], self._prior[rows], self._evidence[rows]), new))
        self.put(rows, new)

    def put(self, where: tuple[int, int] | Ints | None, value: tuple[Any, Any, Any] | Floats | float) -> None:
        """Write one slot, or rows: outcome, prior and evidence; or all evidence, or the factor it is multiplied by."""
        if isinstance(where, np.ndarray):
            assert isinstance(value, tuple)
            stores = zip((self._keys, self._prior, self._evidence), value, (EMPTY, 0.0, 0.0), strict=True)
            for array, values, unused in stores:
                width = values.shape[1]  # there may be more slots by now
                array[where, :width], array[where, width:] = values, unused
            self._add_up(where)
            return
        if isinstance(value, tuple):
            row, slot = where or (0, 0)
            self._keys[row, slot], self._prior[row, slot], self._evidence[row, slot] = value
            self._alpha[row, slot] = value[1] + value[2]
            self._total[row] = reduce(add, self._alpha[row].tolist())
            return
        evidence = self._evidence[: self._rows]
        if isinstance(value, np.ndarray):
            evidence[:] = 0.0
            evidence[:, : value.shape[1]] = value
        else:
            evidence *= value
        self._add_up()

    def savepoint(self) -> tuple[int, int, int]:
        """Rows, slots, and the size of the domain."""
        return self._rows, self._keys.shape[1], self.outcomes

    def level(self) -> None:
        """Have as much room in every array, where it was left while there was made more."""
        arrays = self._keys, self._prior, self._evidence
        rows, slots = (max(array.shape[axis] for array in arrays) for axis in (0, 1))
        if {array.shape for array in (*arrays, self._alpha)} != {(rows, slots)} or len(self._total) != rows:
            self._resize(rows, slots)
        self._rows = min(self._rows, rows)

    def go_back(self, point: tuple[int, int, int]) -> None:
        """Be as it was, once the old values are back."""
        rows, slots, self.outcomes = point
        self.resize(rows)
        for name in ("_keys", "_prior", "_evidence"):
            setattr(self, name, getattr(self, name)[:, :slots].copy())
        self._alpha, self._total = np.zeros_like(self._prior), np.zeros(len(self._keys))
        self._add_up()

    def touched(self, where: tuple[int, int] | Ints | None) -> Iterable[int] | None:
        """The place whose row it is, or the places of rows."""
        if isinstance(where, np.ndarray):
            return set((where // self.rows_each).tolist())
        return None if where is None else (where[0] // self.rows_each,)

    def _resize(self, rows: int, slots: int) -> None:
        self._keys = _grown(self._keys, (rows, slots), EMPTY).astype(np.int64)
        self._prior = _grown(self._prior, (rows, slots), 0.0).astype(np.float64)
        self._evidence = _grown(self._evidence, (rows, slots), 0.0).astype(np.float64)
        self._alpha, self._total = np.zeros((rows, slots)), np.zeros(rows)
        self._add_up()

    def _slot(self, row: int, key: int) -> int:
        """Slot of `key` in `row`; a free one where it has none."""
        keys = self._keys[row].tolist()
        if key in keys:
            return keys.index(key)
        if EMPTY not in keys:
            self._resize(self._keys.shape[0], 2 * self._keys.shape[1])
            return len(keys)
        return keys.index(EMPTY)

    def expect(self, row: int, key: int, prior: float) -> None:
        """Give outcome `key` of `row` a prior of its own."""
        slot = self._slot(row, key)
        self._set(row, slot, key, prior, self._evidence.item(row, slot))

    def rename(self, row: int, old: int, new: int) -> None:
        """Let the slot of outcome `old` stand for `new`, with the counts it has.

        Raises:
            CogmapError: `new` has a slot of its own.
        """
        if new in self._keys[row].tolist():
            raise CogmapError(f"table: outcome {new} of row {row} has counts already; rename to an outcome without")
        slot = self._slot(row, old)
        self._set(row, slot, new, self._prior.item(row, slot), self._evidence.item(row, slot))

    def add(self, row: int, key: int, amount: float, *, most: float = inf) -> float:
        """Add evidence (negative takes away) for `key` in `row`, `most` in all; returns what was really added."""
        if amount <= 0.0 and self.evidence(row, key) == 0.0:
            return 0.0
        slot = self._slot(row, key)
        before = self._evidence.item(row, slot)
        after = min(max(before + amount, 0.0), max(before, most))
        if after != before:
            self._set(row, slot, key, self._prior.item(row, slot), after)
        return after - before

    def unite(self, row: int, old: int, new: int) -> None:
        """Give outcome `new` of `row` the prior and the evidence that `old` has besides, which has none any more."""
        one, other = self._slot(row, old), self._slot(row, new)
        prior = self._prior.item(row, one) + self._prior.item(row, other)
        evidence = self._evidence.item(row, one) + self._evidence.item(row, other)
        self._set(row, other, new, prior, evidence)
        self._set(row, one, EMPTY, 0.0, 0.0)

    def clear(self, row: int, keys: Sequence[int] = (), prior: float = 0.0) -> None:
        """Take everything away from `row` but these outcomes, which have this prior and no evidence."""
        for slot in range(self._keys.shape[1]):
            kept = slot < len(keys)
            self._set(row, slot, self._keys.item(row, slot), self._prior.item(row, slot), 0.0)
            self._set(row, slot, keys[slot] if kept else EMPTY, prior if kept else 0.0, 0.0)

    def make_room(self, row: int, most: int, *, of: Sequence[int]) -> None:
        """Have `row` have `most` outcomes of its own at most once it has these: those with the least evidence go."""
        keys = self._keys[row].tolist()
        if len(keys) < most:
            return
        used = [(self._evidence.item(row, slot), slot) for slot, key in enumerate(keys) if key not in (EMPTY, *of)]
        for _, slot in sorted(used)[: max(len(used) + len(of) - most, 0)]:
            self._set(row, slot, EMPTY, 0.0, 0.0)

    def evidence(self, row: int, key: int) -> float:
        """Evidence for `key` in `row`, prior left out."""
        keys = self._keys[row].tolist()
        return self._evidence.item(row, keys.index(key)) if key in keys else 0.0

    def counts(self, row: int) -> dict[int, float]:
        """Evidence of `row` by outcome, prior left out."""
        return dict(zip(self._keys[row].tolist(), self._evidence[row].tolist(), strict=True))

    def slots(self, rows: Ints) -> tuple[Ints, Floats, Floats]:
        """`[n, slots]` outcomes, priors and evidence of rows, as `write` takes them."""
        return self._keys[rows], self._prior[rows], self._evidence[rows]

    def fade(self, keep: float) -> None:
        """Multiply all evidence by `keep`, in [0, 1]: what was learned long ago fades."""
        old = self._evidence[: self._rows].copy()
        if self._changes is not None:
            self._changes.append(Change(self, None, old, keep))
        self.put(None, keep)

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

    def state(self) -> dict[str, NDArray[Any]]:
        """Copies of the arrays that hold every count, for saving."""
        rows = slice(self._rows)
        parts = {"keys": self._keys, "prior": self._prior, "evidence": self._evidence}
        return {name: part[rows].copy() for name, part in parts.items()}

    def restore(self, state: Mapping[str, NDArray[Any]], *, outcomes: float = inf, least: int = 0) -> None:
        """Take over what `state` returned of a table of as many rows, over outcomes in [least, outcomes).

        Raises:
            CogmapError: it is of another table, holds what is no count, or an outcome of a row twice.
        """
        keys, prior, evidence = (state[part] for part in ("keys", "prior", "evidence"))
        fits = keys.ndim == 2 and len(keys) == self._rows and keys.shape == prior.shape == evidence.shape
        fits = fits and keys.shape[1] > 0 and all(_within(counts, 0, LARGEST) for counts in (prior, evidence))
        if not (fits and keys.dtype.kind == "i" and _sound(keys, (prior != 0.0) | (evidence != 0.0), least, outcomes)):
            where = f"{self._rows} rows of {outcomes:g} outcomes"
            raise CogmapError(f"map: the counts of {self.name} do not fit {where}; save it again")
        self._keys = keys.astype(np.int64)
        self._prior, self._evidence = prior.astype(np.float64), evidence.astype(np.float64)
        self._alpha, self._total = np.zeros_like(self._prior), np.zeros(self._rows)
        self._add_up()


def _sound(keys: Ints, counted: NDArray[np.bool_], least: int, bound: float) -> bool:
    """Whether each key is an outcome, no row has one twice, and no slot without has counts."""
    used = keys != EMPTY
    ordered = np.sort(keys, axis=1)
    twice = (ordered[:, 1:] == ordered[:, :-1]) & (ordered[:, 1:] != EMPTY)
    inside = (keys >= least) & (keys < bound)
    return bool((inside | ~used).all() and not twice.any() and not (counted & ~used).any())


def _within(numbers: NDArray[Any], least: float, bound: float) -> bool:
    """Whether all numbers are in [least, bound); a NaN is not."""
    return numbers.dtype.kind in "ibf" and bool(((numbers >= least) & (numbers < bound)).all())
