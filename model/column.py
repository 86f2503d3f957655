"""Arrays that grow by appending."""

from __future__ import annotations

import numpy as np
from numpy.typing import DTypeLike, NDArray


class Column:
    """A numpy array that grows along its first axis; appending is amortised."""

    __slots__ = ("_array", "_length")

    def __init__(self, dtype: DTypeLike, *, width: int | None = None) -> None:
        self._array = np.zeros((8,) if width is None else (8, width), dtype=dtype)
        self._length = 0

    def __len__(self) -> int:
        return self._length

    @property
    def values(self) -> NDArray[np.generic]:
        """View of what was appended; writing to it writes here."""
        return self._array[: self._length]

    def append(self, value: object) -> int:
        """Append one entry (or one row); returns its index."""
        if self._length == len(self._array):
            self._array = np.concatenate([self._array, np.zeros_like(self._array)])
        self._array[self._length] = value
        self._length += 1
        return self._length - 1

    def shrink(self, length: int) -> None:
        """Keep the first `length` entries."""
        self._length = length

    def restore(self, values: NDArray[np.generic]) -> None:
        """Take over `values`."""
        self._array = np.concatenate([values.astype(self._array.dtype), np.zeros_like(self._array[:8])])
        self._length = len(values)
