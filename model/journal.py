"""Which rows of a table changed, for those who keep something beside it."""

from __future__ import annotations

MOST = 1000
"""Changes that are remembered at least; who comes later hears that any row may have changed."""


class Journal:
    """The rows that changed, in order. Readers remember how far they have read: any number of them, known or not."""

    __slots__ = ("_forgotten", "_rows")

    def __init__(self) -> None:
        self._rows: list[int] = []
        self._forgotten = 0

    def note(self, row: int | None) -> None:
        """Counts of a row changed, or one of its slots got a name; None: of any row."""
        if row is None:
            self._forgotten += len(self._rows) + 1
            self._rows.clear()
            return
        self._rows.append(row)
        if len(self._rows) > 2 * MOST:
            del self._rows[:MOST]
            self._forgotten += MOST

    def since(self, read: int) -> tuple[list[int] | None, int]:
        """The rows that changed since so many changes were read, None where any may have; and how many there are now.

        Who has read nothing yet says -1.
        """
        now = self._forgotten + len(self._rows)
        return (None if read < self._forgotten else self._rows[read - self._forgotten :]), now
