"""What every policy generator returns, and the few steps they share."""

from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from ...model import CogmapError, Ints, Motions
from ..local import LocalModel, Surroundings
from ..prefixes import Prefixes, prefixes_of

MAX_POLICIES = 2_000_000
MAX_LOOK_AHEAD = 1_000


@dataclass(frozen=True)
class Policies:
    """The action sequences to compare.

    Raises:
        CogmapError: `actions` is not a non-empty two-dimensional array of integers.
    """

    actions: Ints  # `[P, L]` action indices, rows unique; a policy that ends early stays to the end
    cut: int = 0  # promising prefixes that a bound on the search left out (zero: nothing was left out)

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


class PolicyGenerator(ABC):
    """Makes the policies of a plan; its options are fields.

    Attributes:
        name: on the command line, in files and in errors.
    """

    name: ClassVar[str]

    @abstractmethod
    def make(self, model: LocalModel) -> Policies:
        """The policies that are to be compared in this local model."""

    @abstractmethod
    def count(self, motions: Motions, look_ahead: int) -> int:
        """How many policies it would make, at most; asked before any work is done."""

    def beyond(self, around: Surroundings) -> Ints:
        """Places further off than the look-ahead that the local model has to have; none, unless told otherwise."""
        return around.near[:0]

    def check(self, motions: Motions, look_ahead: int) -> None:
        """Refuse to plan for no step at all, or for more policies than memory and patience allow.

        Raises:
            CogmapError: naming the generator.
        """
        if not 1 <= look_ahead <= MAX_LOOK_AHEAD:
            raise CogmapError(f"{self.name}: look_ahead is {look_ahead}; give 1 to {MAX_LOOK_AHEAD:,} steps")
        if self.count(motions, look_ahead) > MAX_POLICIES:
            raise CogmapError(
                f"{self.name}: more than {MAX_POLICIES:,} policies at look-ahead {look_ahead} "
                f"with {len(motions)} actions; look less far ahead, or use 'map_guided'"
            )
