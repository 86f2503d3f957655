"""Spaces of what is observed that Gymnasium has none for."""

from collections.abc import Hashable, Iterable
from typing import Any

import numpy as np
from gymnasium import spaces


def label_space(labels: Iterable[Hashable]) -> spaces.Space[Any]:
    """The space of these labels: `Discrete` of whole numbers, `Text` of words, else `Labels`."""
    found = set(labels)
    if all(type(label) is int and label >= 0 for label in found):
        return spaces.Discrete(max((label for label in found if isinstance(label, int)), default=0) + 1)
    words = [label for label in found if isinstance(label, str) and label]
    if len(words) == len(found):
        return spaces.Text(max(map(len, words)), charset=frozenset("".join(words)))
    return Labels(found)


class Labels(spaces.Space[Any]):
    """One of some labels, whatever they are."""

    def __init__(self, labels: Iterable[Hashable]) -> None:
        super().__init__()
        self.labels = tuple(sorted(labels, key=repr))

    def sample(self, mask: Any = None, probability: Any = None) -> Any:
        """A label drawn evenly."""
        return self.labels[int(self.np_random.integers(len(self.labels)))]

    def contains(self, x: Any) -> bool:
        """Whether `x` is one of the labels."""
        return x in self.labels


class PerWay(spaces.Space[dict[Any, Any]]):
    """A value for each way of the present place, by the label of the way.

    Args:
        labels: all labels that ways have anywhere.
        numbers: whether the values are bearings or lengths; else they are True, False or None (not looked at).
    """

    def __init__(self, labels: Iterable[Hashable], *, numbers: bool = False) -> None:
        super().__init__()
        self.labels = frozenset(labels)
        self.numbers = numbers

    def sample(self, mask: Any = None, probability: Any = None) -> dict[Any, Any]:
        """Some of the labels with values drawn evenly."""
        chosen = [label for label in sorted(self.labels, key=repr) if self.np_random.random() < 0.5]
        drawn = self.np_random.uniform(0.0, 360.0, size=len(chosen)).tolist()
        return {label: value if self.numbers else value < 180.0 for label, value in zip(chosen, drawn, strict=True)}

    def contains(self, x: Any) -> bool:
        """Whether `x` has values for labels of ways alone."""
        if not isinstance(x, dict) or not self.labels.issuperset(x):
            return False
        if self.numbers:
            return all(isinstance(value, float) and np.isfinite(value) for value in x.values())
        return all(value is None or isinstance(value, bool) for value in x.values())


class PerAction(spaces.Space[tuple[float | None, ...]]):
    """A bearing, or a length, for each action, None where it has no way.

    Args:
        actions: how many there are.
    """

    def __init__(self, actions: int) -> None:
        super().__init__()
        self.actions = actions

    def sample(self, mask: Any = None, probability: Any = None) -> tuple[float | None, ...]:
        """Numbers drawn evenly for some of the actions."""
        drawn = self.np_random.uniform(0.0, 720.0, size=self.actions).tolist()
        return tuple(value if value < 360.0 else None for value in drawn)

    def contains(self, x: Any) -> bool:
        """Whether `x` has a finite number or None for each action."""
        listed = isinstance(x, tuple) and len(x) == self.actions  # pyright: ignore[reportUnknownArgumentType]
        return listed and all(value is None or (isinstance(value, float) and np.isfinite(value)) for value in x)
