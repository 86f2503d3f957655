"""Arrays that grow along with the places or positions of a map."""

from collections.abc import Iterable, Mapping
from math import inf
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from .changes import Change, Changes
from .errors import CogmapError


class Column:
    """A numpy array that grows along its first axis. Its values are logged, its length is not.

    Args:
        name: unique in its map.
        dtype: of the array.
        width: of a row; None for one number a row.
        fill: what new rows hold.
        changes: the log that is told; none unless given.
    """

    __slots__ = ("_array", "_changes", "_fill", "_length", "name")

    def __init__(
        self,
        name: str,
        dtype: DTypeLike,
        *,
        width: int | None = None,
        fill: float = 0,
        changes: Changes | None = None,
    ) -> None:
        self.name = name
        self._fill = fill
        self._changes = changes
        self._array = np.full((8,) if width is None else (8, width), fill, dtype=dtype)
        self._length = 0

    def __len__(self) -> int:
        return self._length

    @property
    def values(self) -> NDArray[Any]:
        """View of the rows in use; what is written to it is not logged."""
        return self._array[: self._length]

    def resize(self, length: int) -> None:
        """Have so many rows: new ones are appended, or the last are dropped."""
        self._make_room(length)
        self._array[self._length : length] = self._fill
        self._length = length

    def _make_room(self, length: int) -> None:
        if length > len(self._array):  # twice as much, or just enough for what is loaded
            more = max(length - len(self._array), len(self._array))
            room = np.full((more, *self._array.shape[1:]), self._fill, dtype=self._array.dtype)
            self._array = np.concatenate([self._array, room])

    def append(self, value: object) -> int:
        """Append one row; returns its index."""
        at = self._length
        self._make_room(at + 1)
        self._array[at] = value
        self._length = at + 1  # last, so that there never is a row without its value
        return at

    def set(self, where: int | tuple[int, int], value: float) -> None:
        """Write one cell."""
        old = self._array.item(where)
        if old != value:
            if self._changes is not None:  # first, so that what is half done can be undone
                self._changes.append(Change(self, where, old, value))
            self._array[where] = value

    def write(self, row: int, values: NDArray[Any]) -> None:
        """Write a whole row; one entry of the log, if it is news."""
        old = self._array[row].copy()
        if (old != values).any():
            if self._changes is not None:  # first, as above
                self._changes.append(Change(self, row, old, values))
            self._array[row] = values

    def put(self, where: int | tuple[int, int], value: float | NDArray[Any]) -> None:
        """Write one cell, or a row, without telling the log."""
        self._array[where] = value

    def savepoint(self) -> int:
        """How many rows it has."""
        return self._length

    def go_back(self, point: int) -> None:
        """Be as long as it was."""
        self.resize(point)

    def touched(self, where: int | tuple[int, int]) -> Iterable[int]:
        """The row, where rows are places."""
        return (where[0] if isinstance(where, tuple) else where,)

    def state(self) -> dict[str, NDArray[Any]]:
        """A copy of the rows in use, for saving."""
        return {"values": self.values.copy()}

    def restore(self, state: Mapping[str, NDArray[Any]], *, least: float = -inf, bound: float = inf) -> None:
        """Take over what `state` returned of a column of as many rows, each value in [least, bound).

        Raises:
            CogmapError: they are others.
        """
        values = state["values"]
        fits = values.shape == self.values.shape and values.dtype.kind in (
            "f" if self.values.dtype.kind == "f" else "ib"
        )
        if not (fits and bool(((values >= least) & (values < bound)).all())):
            raise CogmapError(
                f"map: {self.name} does not fit {len(self)} rows of {least:g} to {bound:g}; save it again"
            )
        self.values[:] = values
