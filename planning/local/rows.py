"""Rows that are worked out once, and again where what they come from has changed."""

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...model import Ints

Columns = tuple[NDArray[Any], ...]


class Rows:
    """Rows of several arrays, by number, kept from the first time that they are asked for until they are forgotten.

    Args:
        compute: the rows of given numbers, `[n, ...]` each; all widths may change together from call to call.
    """

    __slots__ = ("_columns", "_compute", "_known")

    def __init__(self, compute: Callable[[Ints], Columns]) -> None:
        self._compute = compute
        self._known = np.zeros(0, dtype=np.bool_)
        self._columns: list[NDArray[Any]] = []

    def forget(self, rows: Iterable[int] | None = None) -> None:
        """These rows, or all of them, are worked out again when they are next asked for."""
        if rows is None:
            self._known[:] = False
            return
        for row in rows:
            if row < len(self._known):
                self._known[row] = False

    def known(self, rows: Iterable[int]) -> Ints:
        """Those of the rows that are kept."""
        many = len(self._known)
        return np.array([row for row in rows if row < many and self._known[row]], dtype=np.int64)

    def column(self, which: int, wanted: Ints) -> NDArray[Any]:
        """The rows of these numbers, copied, of one of the arrays."""
        self._know(wanted)
        return self._columns[which][wanted] if self._columns else wanted

    def columns(self, wanted: Ints) -> list[NDArray[Any]]:
        """The rows of these numbers, copied, of all arrays, each with a row of zeros at the end."""
        self._know(wanted)
        found: list[NDArray[Any]] = []
        for column in self._columns:
            rows = np.zeros((len(wanted) + 1, *column.shape[1:]), column.dtype)
            column.take(wanted, axis=0, out=rows[:-1], mode="clip")
            found.append(rows)
        return found

    def _know(self, wanted: Ints) -> None:
        if len(wanted) and (most := int(wanted.max())) >= len(self._known):
            self._make_room(most + 1)
        known = self._known[wanted]
        if not known.all():
            self._take_in(wanted[~known], wanted)

    def _take_in(self, missing: Ints, wanted: Ints) -> None:
        values = self._compute(missing)
        if [value.shape[1:] for value in values] != [column.shape[1:] for column in self._columns]:
            self.forget()
            missing, values = wanted, self._compute(wanted)
            self._columns = [np.empty((len(self._known), *value.shape[1:]), value.dtype) for value in values]
        for column, value in zip(self._columns, values, strict=True):
            column[missing] = value
        self._known[missing] = True

    def _make_room(self, rows: int) -> None:
        more = max(rows, 2 * len(self._known)) - len(self._known)
        self._known = np.append(self._known, np.zeros(more, dtype=np.bool_))
        self._columns = [np.concatenate([c, np.empty((more, *c.shape[1:]), c.dtype)]) for c in self._columns]
