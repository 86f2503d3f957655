"""Which rows of a table changed, for those who keep something beside it."""

from __future__ import annotations

MOST = 1000
"""Rows that are noted one by one; beyond that, any may have changed."""


class Journal:
    """The rows that changed since it was last read; at first, any may have."""

    __slots__ = ("__weakref__", "_rows")

    def __init__(self) -> None:
        self._rows: list[int] | None = None

    def note(self, row: int | None) -> None:
        """Counts of a row changed, or one of its slots got a name; None: of any row."""
        if row is None:
            self._rows = None
        elif self._rows is not None:
            self._rows.append(row)
            if len(self._rows) > MOST:
                self._rows = None

    def take(self) -> list[int] | None:
        """The rows since the last call, or None where any may have changed."""
        taken, self._rows = self._rows, []
        return taken
