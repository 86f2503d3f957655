"""A mapping that forks at the price of its differences."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

K = TypeVar("K", bound=Hashable)
V = TypeVar("V")

LOGGED = 1024
"""Changes of a shared layer that can be looked behind, at least."""


class Shared(dict[K, V]):
    """A shared layer, and what it held before its last changes."""

    __slots__ = ("cut", "log")

    def __init__(self) -> None:
        super().__init__()
        self.log: list[tuple[K, V | None]] = []
        self.cut = 0

    @property
    def mark(self) -> int:
        """Number of changes so far."""
        return self.cut + len(self.log)

    def change(self, key: K, value: V | None) -> None:
        """Put an entry in, or take it away."""
        self.log.append((key, self.get(key)))
        if value is None:
            self.pop(key, None)
        else:
            self[key] = value

    def forget(self) -> None:
        """Let go of what was logged long ago."""
        if len(self.log) > 2 * LOGGED:
            self.cut += len(self.log) - LOGGED
            self.log = self.log[-LOGGED:]


@dataclass(frozen=True, slots=True)
class Stamp(Generic[K]):
    """When a mapping was looked at.

    Attributes:
        shared: its shared layer.
        mark: the state of that.
        own: the keys of its own entries.
    """

    shared: object
    mark: int
    own: frozenset[K]


@dataclass(frozen=True)
class Kept(Generic[K]):
    """The keys of entries that are the same in two mappings.

    Attributes:
        shared: what both go back to.
        changed: the keys of entries that are not.
    """

    shared: Mapping[K, object]
    changed: set[K]

    def __contains__(self, key: K) -> bool:
        return key in self.shared and key not in self.changed


class Layered(Generic[K, V]):
    """A mapping of a shared layer and of one's own entries above it; None stands for an entry taken away."""

    __slots__ = ("_base", "_own")

    def __init__(self, base: Shared[K, V] | None = None, own: dict[K, V | None] | None = None) -> None:
        self._base: Shared[K, V] = Shared() if base is None else base
        self._own: dict[K, V | None] = {} if own is None else own

    def fork(self) -> Layered[K, V]:
        """One that changes apart from this one from now on."""
        return Layered(self._base, self._own.copy())

    def settle(self) -> None:
        """Put the own entries into the shared layer; only for the one that is left of those that share it."""
        for key, value in self._own.items():
            self._base.change(key, value)
        self._own = {}
        self._base.forget()

    @property
    def mark(self) -> int:
        """The state of the shared layer, for `as_of`."""
        return self._base.mark

    def as_of(self, mark: int) -> Layered[K, V] | None:
        """A fork that sees the shared layer as it was; None where that is forgotten."""
        if mark < self._base.cut:
            return None
        own = dict(reversed(self._base.log[mark - self._base.cut :]))
        own.update(self._own)
        return Layered(self._base, own)

    @property
    def stamp(self) -> Stamp[K]:
        """What `changed_since` needs to know of it as it is now."""
        return Stamp(self._base, self._base.mark, frozenset(self._own))

    def changed_since(self, stamp: Stamp[K]) -> set[K] | None:
        """The keys of all entries that may be others than in the mapping of that stamp; None where nobody knows."""
        if stamp.shared is not self._base or stamp.mark < self._base.cut:
            return None
        return {*stamp.own, *self._own, *(key for key, _ in self._base.log[stamp.mark - self._base.cut :])}

    @property
    def layers(self) -> tuple[Shared[K, V], dict[K, V | None]]:
        """The shared layer, and the own entries above it; for files."""
        return self._base, self._own

    @staticmethod
    def settle_alike(many: Sequence[Layered[K, V]]) -> None:
        """Put what all of those that share a layer have in common into it."""
        first, *others = (one._own for one in many)
        alike = [key for key, value in first.items() if all(key in own and own[key] is value for own in others)]
        for key in alike:
            many[0]._base.change(key, first[key])
        for one in many:
            own = one._own.copy()
            for key in alike:
                del own[key]
            one._own = own
        many[0]._base.forget()

    def kept(self, other: Layered[K, V]) -> Kept[K] | None:
        """What is the same object in both; None if these do not share a layer."""
        if self._base is not other._base:
            return None
        keys = {**self._own, **other._own}
        return Kept(self._base, {key for key in keys if self.get(key) is not other.get(key)})

    def get(self, key: K) -> V | None:
        """The entry, or None."""
        return self._own[key] if key in self._own else self._base.get(key)

    def __getitem__(self, key: K) -> V:
        value = self._own.get(key)
        return self._base[key] if value is None else value

    def __setitem__(self, key: K, value: V) -> None:
        self._own[key] = value

    def __delitem__(self, key: K) -> None:
        self._own[key] = None

    def __iter__(self) -> Iterator[K]:
        for key in self._base:
            if key not in self._own:
                yield key
        for key, value in self._own.items():
            if value is not None:
                yield key

    def __reversed__(self) -> Iterator[K]:
        """What changed last first."""
        for key, value in reversed(self._own.items()):
            if value is not None:
                yield key
        for key in reversed(self._base):
            if key not in self._own:
                yield key
