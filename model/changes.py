"""The log of everything that is written into a map: read by cursor, and what a step that is broken off goes back by."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple, Protocol

from numpy.typing import NDArray

from .growth_event import GrowthEvent

KEPT = 1000  # entries that are kept at least, for readers who come late


class Store(Protocol):
    """Anything that the log of changes can restore: a table, a column, or the places of a map."""

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

    def touched(self, where: Any) -> Iterable[int] | None:
        """The places whose columns a change at `where` is about; None: any of them."""
        ...


class Change(NamedTuple):
    """One stored cell that was changed.

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
    """The append-only log of changes of one map. Only a whole step can be cut off at its end."""

    def __init__(self) -> None:
        self._entries: list[Entry] = []
        self._dropped = 0
        self._holding = False

    def __len__(self) -> int:
        """Entries so far, those that were dropped included."""
        return self._dropped + len(self._entries)

    def append(self, entry: Entry) -> None:
        """Log what was written, or what has grown."""
        self._entries.append(entry)
        self._trim()

    def since(self, cursor: int) -> tuple[Sequence[Entry] | None, int]:
        """The entries after `cursor`, None where some of them are gone, and the cursor to go on from; begin with -1."""
        first = cursor - self._dropped
        return (None if first < 0 else self._entries[first:]), len(self)

    # -- steps that are broken off ---------------------------------------------------------------------------

    def hold(self) -> int:
        """Drop nothing until `release`; returns what `held` and `cut` take."""
        self._holding = True
        return len(self._entries)

    def held(self, point: int) -> Sequence[Entry]:
        """The entries since then."""
        return self._entries[point:]

    def cut(self, point: int) -> None:
        """Be as then: what was read since is not true any more."""
        del self._entries[point:]
        self._holding = False

    def release(self) -> None:
        """Drop again what nobody needs."""
        self._holding = False
        self._trim()

    def _trim(self) -> None:
        """Drop all but the last `KEPT` entries, now and then."""
        if self._holding or len(self._entries) <= 2 * KEPT:
            return
        drop = len(self._entries) - KEPT
        self._dropped += drop  # first: where an interrupt comes between, readers look at too much, never at too little
        del self._entries[:drop]
