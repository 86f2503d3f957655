"""Which numbers there are, for arrays so short that the bookkeeping of `np.unique` outweighs the sorting."""

import numpy as np

from .arrays import Ints

FEW = 16  # numbers up to which numpy costs more than what it does


def distinct(values: Ints) -> tuple[Ints, Ints]:
    """The distinct values, ascending, and `[n]` the index of each value among them."""
    if len(values) == 1:
        return values, np.zeros(1, dtype=np.int64)
    if len(values) <= FEW:
        listed = values.tolist()
        found = sorted(set(listed))
        at = {value: k for k, value in enumerate(found)}
        return np.array(found, dtype=np.int64), np.array([at[value] for value in listed], dtype=np.int64)
    order = values.argsort(kind="stable")
    ordered = values[order]
    first = np.ones(len(values), dtype=np.bool_)
    np.not_equal(ordered[1:], ordered[:-1], out=first[1:])
    index = np.empty(len(values), dtype=np.int64)
    index[order] = first.cumsum() - 1
    return ordered[first], index
