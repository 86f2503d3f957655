"""What every policy generator returns, and the few steps they share."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...model.errors import CogmapError
from ..prefixes import Prefixes, prefixes_of

Ints = NDArray[np.int64]
MAX_POLICIES = 2_000_000


@dataclass(frozen=True)
class Policies:
    """The action sequences to compare.

    Attributes:
        actions: `[P, L]` action indices, rows unique; a policy that ends early stays to the end.
        cut: promising prefixes that a bound on the search left out (zero: nothing was left out).

    Raises:
        CogmapError: `actions` is not a non-empty two-dimensional array of integers.
    """

    actions: Ints
    cut: int = 0

    def __post_init__(self) -> None:
        shape, kind = np.shape(self.actions), np.asarray(self.actions).dtype.kind
        if len(shape) != 2 or 0 in shape or kind not in "iu":
            raise CogmapError(
                f"policies: actions have shape {shape} and kind {kind!r}; give integers [P, L], P and L >= 1"
            )

    def __len__(self) -> int:
        return len(self.actions)

    @cached_property
    def span(self) -> tuple[int, int]:
        """The least and the greatest action index."""
        return int(self.actions.min()), int(self.actions.max())

    @cached_property
    def prefixes(self) -> Prefixes:
        """Their prefix tree; worked out once, however often they are evaluated."""
        return prefixes_of(self.actions)


def padded(paths: Iterable[tuple[int, ...]], *, stay: int, length: int) -> Ints:
    """`[P, L]` unique paths as rows that stay until the end, L the longest path or `length` if longer."""
    unique = list(dict.fromkeys(paths))
    length = max(length, max(map(len, unique)))
    rest = (stay,) * length
    return np.array([path + rest[len(path) :] for path in unique], dtype=np.int64)


def frozen(actions: Ints) -> Policies:
    """Policies that may be shared between calls, since nobody can write to them."""
    actions.setflags(write=False)
    return Policies(actions)


def check_count(name: str, count: int, look_ahead: int) -> None:
    """Refuse to list more policies than memory and patience allow."""
    if count > MAX_POLICIES:
        raise CogmapError(
            f"{name}: more than {MAX_POLICIES:,} policies at look-ahead {look_ahead}; "
            "look less far ahead, or use 'map_guided'"
        )


def check_look_ahead(name: str, look_ahead: int) -> None:
    """Refuse to plan for no step at all."""
    if look_ahead < 1:
        raise CogmapError(f"{name}: look_ahead is {look_ahead}; give 1 or more steps")
