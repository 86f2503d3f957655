"""The append-only log of everything that is written into a map: undone, and read by cursor."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple, Protocol

from numpy.typing import NDArray

from .errors import CogmapError
from .growth_event import GrowthEvent

KEPT = 1000
"""Entries that are kept at least, for readers who come late."""

STEPS = 50
"""Marks that can be undone, the last ones."""


class Store(Protocol):
    """What the log can put back: a table, a column, or the places of a map."""

    @property
    def name(self) -> str:
        """Unique in its map."""
        ...

    def put(self, where: Any, value: Any) -> None:
        """Write `value`, as `Change` has it, without telling the log."""
        ...

    def state(self) -> dict[str, NDArray[Any]]:
        """Copies of the arrays that hold it, for saving."""
        ...

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Take over what `state` gave of one with as many rows."""
        ...

    def value(self, numbers: Sequence[float]) -> Any:
        """A value as `put` takes it, from the numbers that a file has of it."""
        ...

    def fits(self, where: Any, value: Any, places: int) -> bool:
        """Whether `put` could take this, where there are so many places."""
        ...

    def touched(self, where: Any) -> Iterable[int] | None:
        """The places whose columns a change at `where` is about; None: any of them."""
        ...


class Change(NamedTuple):
    """One stored cell that was written.

    Attributes:
        store: the table or column.
        where: the cell in it; the store knows what that means.
        old: what was there.
        new: what is there now.
    """

    store: Store
    where: Any
    old: Any
    new: Any


Entry = Change | GrowthEvent


class Changes:
    """The log of one map. What is undone is logged too, so that nothing that was read ever becomes untrue."""

    def __init__(self) -> None:
        self._entries: list[Entry] = []
        self._dropped = 0
        self._room = 2 * KEPT
        self._marks: deque[int] = deque(maxlen=STEPS)
        self._undone: list[tuple[int, int]] = []  # spans that come to nothing
        self._holding = False

    def __len__(self) -> int:
        """Entries so far, those that were dropped included."""
        return self._dropped + len(self._entries)

    def append(self, entry: Entry) -> None:
        """Log what was written, or what has grown."""
        self._entries.append(entry)
        if len(self._entries) > self._room and not self._holding:
            self._trim()

    def since(self, cursor: int) -> tuple[Sequence[Entry] | None, int]:
        """The entries after `cursor`, None where some of them are gone, and the cursor to go on from; begin with -1."""
        first = cursor - self._dropped
        return (None if first < 0 else self._entries[first:]), len(self)

    # -- going back ----------------------------------------------------------------------------------------

    def mark(self) -> int:
        """A point to which `undo` can return, as long as it is among the last `STEPS` ones."""
        self._marks.append(len(self))
        return self._marks[-1]

    def undo(self, mark: int) -> list[Change]:
        """Put everything back to what it was at `mark`.

        Returns:
            The changes that were undone, in the order in which they were made.

        Raises:
            CogmapError: it is no mark, or older than the last `STEPS` ones.
        """
        if mark not in self._marks:
            oldest = f"the oldest is {self._marks[0]}" if self._marks else "there are none"
            raise CogmapError(f"changes: {mark} is no mark that is kept; {oldest}, call mark() sooner")
        while self._marks[-1] > mark:
            self._marks.pop()
        changes = self._take_back(self._written(mark))
        self._undone = [(begin, end) for begin, end in self._undone if end <= mark] + [(mark, len(self))]
        return changes

    def _written(self, since: int) -> list[Change]:
        """The changes since then, but for those that were undone."""
        found: list[Entry] = []
        for begin, end in self._undone:
            if begin >= since:
                found += self._entries[since - self._dropped : begin - self._dropped]
                since = end
        found += self._entries[since - self._dropped :]
        return [entry for entry in found if isinstance(entry, Change)]

    def _take_back(self, changes: Sequence[Change]) -> list[Change]:
        for store, where, old, new in reversed(changes):
            self.append(Change(store, where, new, old))
            store.put(where, old)
        return list(changes)

    def undoable(self) -> tuple[int, list[Entry], list[int], list[tuple[int, int]]]:
        """Where the oldest mark is, the entries since then, the marks, and the spans of entries that were undone."""
        first = self._marks[0] if self._marks else len(self)
        undone = [span for span in self._undone if span[0] >= first]
        return first, self._entries[first - self._dropped :], list(self._marks), undone

    def restore(
        self, first: int, entries: Iterable[Entry], marks: Sequence[int], undone: Iterable[tuple[int, int]]
    ) -> None:
        """Take over what `undoable` gave of another log."""
        self._entries, self._marks, self._undone = list(entries), deque(marks, maxlen=STEPS), list(undone)
        self._dropped = first

    # -- holding -------------------------------------------------------------------------------------------

    def hold(self) -> tuple[Any, ...]:
        """Drop nothing until `release`; returns what `held` and `cut` take."""
        self._holding = True
        return len(self._entries), tuple(self._marks), list(self._undone)

    def held(self, point: tuple[Any, ...]) -> Sequence[Entry]:
        """The entries since then."""
        return self._entries[point[0] :]

    def cut(self, point: tuple[Any, ...]) -> None:
        """Be as then: what was read since is not true any more."""
        count, marks, undone = point
        del self._entries[count:]
        self._marks, self._undone, self._holding = deque(marks, maxlen=STEPS), list(undone), False

    def release(self) -> None:
        """Drop again what nobody needs."""
        self._holding = False
        if len(self._entries) > self._room:
            self._trim()

    def _trim(self) -> None:
        """Drop what no mark needs, but for the last `KEPT` entries."""
        needed = [len(self) - KEPT, *([self._marks[0]] if self._marks else [])]
        drop = max(min(needed) - self._dropped, 0)
        entries, dropped = self._entries[drop:], self._dropped + drop
        self._entries, self._dropped = entries, dropped  # in one go
        self._undone = [span for span in self._undone if span[0] >= self._dropped]
        self._room = 2 * max(len(self._entries), KEPT)
