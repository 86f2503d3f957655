"""Discrete variables with labelled domains."""

from collections.abc import Hashable, Mapping
from dataclasses import dataclass, field
from typing import cast

from ..errors import CogmapError


@dataclass(frozen=True, slots=True)
class Variable:
    """A discrete variable: a name and the labels it may take.

    Raises:
        CogmapError: the name is empty, or the domain is empty, repeats a label or holds an unhashable one.
    """

    name: str  # unique within a graph; graphs, evidence and posteriors speak of it by this name
    # the labels, any hashable values, at least one, none twice (`1`, `1.0` and `True` are one label)
    domain: tuple[Hashable, ...]
    time: int | None = None  # the time step the variable belongs to, if any; inference eliminates along it
    observed: bool = False  # an observation: it has one label only, or evidence must be given for it
    _indices: Mapping[Hashable, int] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        if not isinstance(cast(object, self.name), str) or not self.name:
            raise CogmapError(f"variable {self.name!r}: the name must be a non-empty string")
        if isinstance(self.domain, str):
            raise CogmapError(f"variable {self.name!r}: the domain is a string; give a tuple of labels")
        if isinstance(self.domain, set | frozenset):
            raise CogmapError(f"variable {self.name!r}: the domain is a set, it has no order; give a tuple of labels")
        try:
            object.__setattr__(self, "domain", tuple(self.domain))
            indices = {label: index for index, label in enumerate(self.domain)}
        except TypeError as error:
            raise CogmapError(
                f"variable {self.name!r}: the domain must be a sequence of hashable labels ({error})"
            ) from error
        if not indices:
            raise CogmapError(f"variable {self.name!r}: the domain is empty; give at least one label")
        if len(indices) < len(self.domain):
            twice = next(label for i, label in enumerate(self.domain) if indices[label] != i)
            raise CogmapError(f"variable {self.name!r}: the label {twice!r} stands twice in the domain")
        object.__setattr__(self, "_indices", indices)

    @property
    def cardinality(self) -> int:
        """Number of labels."""
        return len(self.domain)

    def index(self, label: Hashable) -> int:
        """Index of `label` in the domain; `CogmapError` where it is not in it."""
        try:
            return self._indices[label]
        except (KeyError, TypeError):
            raise CogmapError(
                f"variable {self.name!r} has no label {label!r}; choose one of {shortened(self.domain)}"
            ) from None


def shortened(labels: tuple[Hashable, ...], most: int = 8) -> str:
    """The labels for an error message, the long tail left out."""
    shown = ", ".join(repr(label) for label in labels[:most])
    return shown if len(labels) <= most else f"{shown}, … ({len(labels)} in all)"
