"""What learning has changed, read from the log of changes."""

from collections.abc import Iterable
from dataclasses import dataclass

from .changes import Change, Entry
from .dirichlet import EMPTY, SparseDirichlet


@dataclass(frozen=True, slots=True)
class ParameterUpdate:
    """One change of a count."""

    table: str  # `A_o`, `A_p` or `B_s`, or that of another sensor
    outcome: int  # sight, position or next place, by number
    place: int  # the place in whose column the count changed
    action: int | None  # the action, for `B_s`
    amount: float  # what was added to the count


def updates(entries: Iterable[Entry]) -> list[ParameterUpdate]:
    """The counts that changed, one by one and in order; what has faded is left out."""
    found: list[ParameterUpdate] = []
    for entry in entries:
        if isinstance(entry, Change) and isinstance(entry.store, SparseDirichlet) and entry.where is not None:
            (row, _), (before, _, old), (after, _, new) = entry.where, entry.old, entry.new
            if new != old:
                place, action = divmod(row, entry.store.rows_each)
                outcome = before if after == EMPTY else after
                found.append(
                    ParameterUpdate(
                        entry.store.name, outcome, place, action if entry.store.rows_each > 1 else None, new - old
                    )
                )
    return found
