"""Labelled domains that grow as their labels are met."""

from collections.abc import Hashable, Iterable, Iterator

from .errors import CogmapError


class Domain:
    """An append-only list of distinct hashable labels, numbered as they are met."""

    __slots__ = ("_index", "_labels", "name")

    def __init__(self, name: str, labels: Iterable[Hashable] = ()) -> None:
        self.name = name
        self._labels: list[Hashable] = []
        self._index: dict[Hashable, int] = {}
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

    def cut(self, length: int) -> None:
        """Have the first so many labels only, wherever it was left."""
        self._labels = self._labels[:length]
        self._index = {label: number for number, label in enumerate(self._labels)}

    def add(self, label: Hashable) -> int:
        """The number of `label`, which is appended where it is new."""
        found = self.find(label)
        if found is not None:
            return found
        self._index[label] = len(self._labels)
        self._labels.append(label)
        return len(self._labels) - 1
