"""A mapping that forks at the price of its differences."""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from typing import Generic, TypeVar

K = TypeVar("K", bound=Hashable)
V = TypeVar("V")


class Layered(Generic[K, V]):
    """A mapping of a shared layer and of one's own entries above it; None stands for an entry taken away."""

    __slots__ = ("_base", "_own")

    def __init__(self, base: dict[K, V] | None = None, own: dict[K, V | None] | None = None) -> None:
        self._base: dict[K, V] = {} if base is None else base
        self._own: dict[K, V | None] = {} if own is None else own

    def fork(self) -> Layered[K, V]:
        """One that changes apart from this one from now on."""
        return Layered(self._base, self._own.copy())

    def settle(self) -> None:
        """Put the own entries into the shared layer; only for the one that is left of those that share it."""
        for key, value in self._own.items():
            if value is None:
                self._base.pop(key, None)
            else:
                self._base[key] = value
        self._own = {}

    @property
    def layers(self) -> tuple[dict[K, V], dict[K, V | None]]:
        """The shared layer, and the own entries above it; for files."""
        return self._base, self._own

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
