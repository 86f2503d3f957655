"""The prefix tree of some policies: what they share is rolled out once."""

from dataclasses import dataclass

import numpy as np

from ..model import Ints


@dataclass(frozen=True, slots=True)
class Prefixes:
    """The `N` distinct prefixes of some policies, the empty one first, then level by level."""

    parent: Ints  # `[N]` the prefix that is one step shorter; the empty one is its own
    action: Ints  # `[N]` the last action; of the empty prefix it means nothing
    # `[L + 2]` where the prefixes of each length begin, and `N`: those of length t are `level[t]` to `level[t +
    # 1] - 1`
    level: list[int]
    of: Ints  # `[P, L]` the prefix of each policy after each step

    def __len__(self) -> int:
        return len(self.parent)

    @property
    def levels(self) -> list[tuple[int, int, int]]:
        """For each length from 1 on: where the prefixes one step shorter begin, and where these begin and end."""
        return list(zip(self.level, self.level[1:], self.level[2:], strict=False))


def prefixes_of(actions: Ints) -> Prefixes:
    """The prefix tree of policies `[P, L]`, in any order."""
    order = np.lexsort(actions.T[::-1])
    rows = actions[order]
    new = np.ones(rows.shape, dtype=np.bool_)  # a row begins a prefix where it differs from the row before, or has
    np.logical_or.accumulate(rows[1:] != rows[:-1], axis=1, out=new[1:])
    level = [0, 1, *(1 + new.sum(axis=0).cumsum()).tolist()]
    at = new.cumsum(axis=0) + (np.array(level[1:-1]) - 1)
    depth, row = np.nonzero(new.T)
    parent = np.zeros(len(row) + 1, dtype=np.int64)
    parent[1:] = np.where(depth > 0, at[row, depth - 1], 0)
    action = np.append(0, rows[row, depth])
    of = np.empty_like(at)
    of[order] = at
    return Prefixes(parent, action, level, of)
