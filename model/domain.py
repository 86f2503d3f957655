"""Labelled domains that grow as their labels are met."""

from collections.abc import Collection, Hashable, Iterable, Iterator
from typing import final

from .errors import CogmapError


@final
class Forgotten:
    """The kind of `FORGOTTEN`, of which there is one: what has the number of a label that was forgotten."""

    __slots__ = ()

    def __repr__(self) -> str:
        return "(forgotten)"

    def __reduce__(self) -> str:
        return "FORGOTTEN"  # copies are the one, too


FORGOTTEN = Forgotten()


class Domain:
    """Distinct hashable labels, numbered as they are met; numbers of labels that were forgotten are given again."""

    __slots__ = ("_free", "_index", "_labels", "name")

    def __init__(self, name: str, labels: Iterable[Hashable] = ()) -> None:
        self.name = name
        self._labels: list[Hashable] = []
        self._index: dict[Hashable, int] = {}
        self._free: list[int] = []  # numbers that no label has, the least first
        self.extend(labels)

    def __len__(self) -> int:
        return len(self._labels)

    def __iter__(self) -> Iterator[Hashable]:
        return iter(self._labels)

    def __getitem__(self, index: int) -> Hashable:
        return self._labels[index]

    def __contains__(self, label: Hashable) -> bool:
        return self.find(label) is not None

    def __repr__(self) -> str:
        return f"{self.name}{{{', '.join(map(repr, self._labels))}}}"

    def find(self, label: Hashable) -> int | None:
        """The number of `label`, or None where it was never met. Raises CogmapError: the label is not hashable."""
        try:
            return self._index.get(label)
        except TypeError as error:
            raise CogmapError(
                f"{self.name}: {type(label).__name__} is not hashable; label with str, int or tuple"
            ) from error

    def index(self, label: Hashable) -> int:
        """The number of `label`. Raises CogmapError: the label was never met."""
        found = self.find(label)
        if found is None:
            known = ", ".join(repr(known) for known in self._labels[:8])
            raise CogmapError(f"{self.name}: {label!r} was never met; known are {known}{', …' * (len(self) > 8)}")
        return found

    def indices(self, labels: Iterable[Hashable]) -> list[int]:
        """The numbers of `labels`. Raises CogmapError: one was never met."""
        labels = list(labels)
        try:
            return list(map(self._index.__getitem__, labels))
        except (KeyError, TypeError):
            return [self.index(label) for label in labels]

    def extend(self, labels: Iterable[Hashable]) -> None:
        """Append those of `labels` that are new."""
        labels = list(labels)
        try:
            index = dict(zip(labels, range(len(labels)), strict=True))
        except TypeError:
            index = dict[Hashable, int]()
        if self._labels or len(index) < len(labels):  # one by one where any may be known, or cannot be a label
            for label in labels:
                self.add(label)
        else:
            self._labels, self._index = labels, index

    def take(self, labels: Iterable[Hashable]) -> None:
        """Have these labels and no others; `FORGOTTEN` may stand for several of them.

        Raises:
            CogmapError: one is not hashable, or there twice.
        """
        labels = list(labels)
        free = [number for number, label in enumerate(labels) if label is FORGOTTEN]
        known = Domain(self.name, (label for label in labels if label is not FORGOTTEN))
        if len(known) + len(free) < len(labels):
            raise CogmapError(f"map: two labels of {self.name} are the same; save it again")
        index = {label: number for number, label in enumerate(labels) if label is not FORGOTTEN}
        self._labels, self._index, self._free = labels, index, free

    def forget(self, used: Collection[int], *, least: int) -> list[Hashable]:
        """Forget the labels whose numbers are not among `used`, if they are `least` or more; which they were."""
        gone = [number for number in self._index.values() if number not in used]
        if len(gone) < least:
            return []
        labels, before = self._labels.copy(), [self._labels[number] for number in gone]
        for number in gone:
            labels[number] = FORGOTTEN
        index = {label: number for label, number in self._index.items() if labels[number] is not FORGOTTEN}
        free = sorted((*self._free, *gone))
        self._labels, self._index, self._free = labels, index, free  # in one go
        return before

    def savepoint(self) -> tuple[int, list[int]]:
        """What `go_back` needs: numbers that were given, and those that no label has."""
        return len(self), self._free.copy()

    def go_back(self, point: tuple[int, list[int]]) -> None:
        """Have the labels of then, wherever it was left."""
        length, free = point
        labels = self._labels[:length]
        for number in free:
            labels[number] = FORGOTTEN
        index = {label: number for number, label in enumerate(labels) if label is not FORGOTTEN}
        self._labels, self._index, self._free = labels, index, free.copy()

    def add(self, label: Hashable) -> int:
        """The number of `label`, which is appended where it is new."""
        found = self.find(label)
        if found is not None:
            return found
        if self._free:
            number = self._free.pop(0)
            self._index[label], self._labels[number] = number, label
            return number
        self._index[label] = len(self._labels)
        self._labels.append(label)
        return len(self._labels) - 1
