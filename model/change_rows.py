"""The part of the log of changes that can be undone, as numbers and back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .changes import Change, Changes, Entry, Store
from .errors import CogmapError
from .growth_event import GrowthEvent

Arrays = dict[str, NDArray[Any]]

_EVENT = -1
"""In place of the store of an entry: it is a growth event."""

_ALL = -2
"""In place of the cell: everything in the store."""


def change_arrays(changes: Changes, stores: Sequence[Store], growth: Sequence[GrowthEvent]) -> Arrays:
    """`changes.rows [n, 9]`: store, cell (two numbers), and what was there and is there (three each).

    Of a growth event the row has its number in `growth`. `changes.first` is where the rows begin, `changes.marks` can
    be undone to, `changes.undone [k, 2]` are the spans that were, `changes.faded.i` all evidence of a table before.
    """
    first, entries, marks, undone = changes.undoable()
    rows, faded = np.zeros((len(entries), 9)), list[NDArray[Any]]()
    number = {id(store): at for at, store in enumerate(stores)}
    event = len(growth) - sum(isinstance(entry, GrowthEvent) for entry in entries)
    for row, entry in zip(rows, entries, strict=True):
        if isinstance(entry, GrowthEvent):
            row[:3] = _EVENT, event, -1
            event += 1
            continue
        store, where, old, new = entry
        row[0] = number[id(store)]
        row[1:3] = (_ALL, -1) if where is None else where if isinstance(where, tuple) else (where, -1)
        for at, value in ((3, old), (6, new)):
            if isinstance(value, np.ndarray):
                row[at] = len(faded)
                row[at + 1] = 1  # the number of an array
                faded.append(value)
            else:
                row[at : at + 3] = value if isinstance(value, tuple) else (value, 0, 0)
    arrays = {f"changes.faded.{i}": values for i, values in enumerate(faded)}
    spans = np.array(undone, dtype=np.int64).reshape(-1, 2)
    numbers = {"first": np.array([first]), "marks": np.array(marks, dtype=np.int64), "undone": spans, "rows": rows}
    return {f"changes.{name}": values for name, values in numbers.items()} | arrays


def restore_changes(
    changes: Changes,
    arrays: Mapping[str, NDArray[Any]],
    stores: Sequence[Store],
    growth: Sequence[GrowthEvent],
    *,
    places: int,
) -> None:
    """Give an empty log what `change_arrays` took from another, of a map that has so many places now.

    Raises:
        CogmapError: the rows are not about these stores.
        KeyError: an array is missing.
    """
    rows, first, marks, undone = (arrays[f"changes.{name}"] for name in ("rows", "first", "marks", "undone"))
    fits = rows.ndim == 2 and rows.shape[1] == 9 and rows.dtype.kind == "f" and np.isfinite(rows).all()
    for numbers in (first, marks, undone.ravel()):
        fits = fits and numbers.ndim == 1 and (numbers.dtype.kind == "i" or not numbers.size)
        fits = fits and bool((np.diff(numbers) >= 0).all())
        fits = fits and len(first) == 1 and bool(((numbers >= first) & (numbers <= first + len(rows))).all())
    fits = fits and undone.ndim == 2 and undone.shape[1] == 2
    if not (fits and ((rows[:, 0] >= _EVENT) & (rows[:, 0] < len(stores))).all()):
        raise CogmapError("changes: the rows are not about this map; save it again")
    entries = [_entry(row, arrays, stores, growth) for row in rows.tolist()]
    _check(entries, stores[0], places)
    changes.restore(int(first[0]), entries, marks.tolist(), [(begin, end) for begin, end in undone.tolist()])


def _check(entries: Sequence[Entry], places_store: Store, places: int) -> None:
    """Go back through the entries, as undoing them does, and see that each could be."""
    for entry in reversed(entries):
        if isinstance(entry, GrowthEvent):
            continue
        store, where, old, _ = entry
        if not store.fits(where, old, places):
            raise CogmapError(f"changes: one of {store.name} cannot be undone; save it again")
        if store is places_store:
            places += 1 if old else -1


def _entry(
    row: list[float], arrays: Mapping[str, Any], stores: Sequence[Store], growth: Sequence[GrowthEvent]
) -> Entry:
    where: Any = (int(row[1]), int(row[2])) if row[2] >= 0 else int(row[1])
    if row[0] == _EVENT and 0 <= where < len(growth):
        return growth[where]
    if row[0] == _EVENT:
        raise CogmapError("changes: a row is about growth that was not; save it again")
    store = stores[int(row[0])]
    if where == _ALL:
        old, new = (arrays[f"changes.faded.{int(row[at])}"] if row[at + 1] else row[at] for at in (3, 6))
        return Change(store, None, old, new)
    old, new = (store.value(row[at : at + 3]) for at in (3, 6))
    return Change(store, where, old, new)
