"""What learning has changed, read from the log of changes."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

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
            if isinstance(entry.where, np.ndarray):
                found += _of_rows(entry, entry.store)
                continue
            (row, _), (before, _, old), (after, _, new) = entry.where, entry.old, entry.new
            if new != old:
                found.append(_update(entry.store, before if after == EMPTY else after, row, new - old))
    return found


def _of_rows(entry: Change, table: SparseDirichlet) -> Iterable[ParameterUpdate]:
    (before, _, old), (after, _, new) = entry.old, entry.new
    at = np.nonzero(old != new)
    outcomes, amounts = np.where(new[at] == 0.0, before[at], after[at]), new[at] - old[at]
    for row, outcome, amount in zip(entry.where[at[0]].tolist(), outcomes.tolist(), amounts.tolist(), strict=True):
        yield _update(table, outcome, row, amount)


def _update(table: SparseDirichlet, outcome: int, row: int, amount: float) -> ParameterUpdate:
    place, action = divmod(row, table.rows_each)
    return ParameterUpdate(table.name, outcome, place, action if table.rows_each > 1 else None, amount)
