"""What an agent can do: named actions, each a displacement in Z^n."""

from __future__ import annotations

import operator
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from .errors import CogmapError

Position = tuple[int, ...]


class MotionSpec(Protocol):
    """Anything that names actions and gives their displacements, such as `world.motions`."""

    @property
    def names(self) -> Sequence[str]:
        """Action names, in the order of the action indices."""
        ...

    @property
    def displacements(self) -> Sequence[Sequence[int]]:
        """One displacement in Z^n an action."""
        ...


@dataclass(frozen=True, slots=True)
class Motions:
    """The actions: names, displacements in Z^n, and who undoes whom.

    Attributes:
        names: action names, in the order of the action indices.
        displacements: one vector of `n` integers an action; exactly one is zero (`stay`).
        inverse: for each action the index of the action that undoes it.
        stay: index of the action that goes nowhere.

    Raises:
        CogmapError: names repeat, vectors differ in length, an action has no inverse, or there is
            not exactly one that stays.
    """

    names: tuple[str, ...]
    displacements: tuple[Position, ...]
    inverse: tuple[int, ...] = field(init=False)
    stay: int = field(init=False)

    def __post_init__(self) -> None:
        self._check_shape()
        where = {displacement: i for i, displacement in enumerate(self.displacements)}
        if len(where) < len(self.names):
            raise CogmapError(f"motions: two of {self.names} have the same displacement; give each its own")
        inverse: list[int] = []
        for name, displacement in zip(self.names, self.displacements, strict=True):
            opposite = tuple(-x for x in displacement)
            if opposite not in where:
                raise CogmapError(f"motions: {name!r} has no inverse; add an action with {opposite}")
            inverse.append(where[opposite])
        zero = tuple(0 for _ in self.displacements[0])
        if zero not in where:
            raise CogmapError(f"motions: no action stays; add one with displacement {zero}")
        object.__setattr__(self, "inverse", tuple(inverse))
        object.__setattr__(self, "stay", where[zero])

    def _check_shape(self) -> None:
        if not self.names or len(self.names) != len(self.displacements):
            raise CogmapError("motions: give at least one action, and one displacement for each name")
        if len(set(self.names)) < len(self.names):
            raise CogmapError(f"motions: names repeat in {self.names}; make them unique")
        lengths = {len(displacement) for displacement in self.displacements}
        if len(lengths) != 1 or lengths == {0}:
            raise CogmapError("motions: displacements differ in length; use vectors of one Z^n, n >= 1")

    @classmethod
    def of(cls, spec: MotionSpec | Mapping[str, Sequence[int]]) -> Motions:
        """Motions from `world.motions`, or from a mapping such as `{"left": (-1,), "right": (1,), "stay": (0,)}`."""
        if isinstance(spec, Motions):
            return spec
        try:
            names, given = (tuple(spec), tuple(spec.values())) if isinstance(spec, Mapping) else _listed(spec)
            vectors = tuple(tuple(operator.index(x) for x in vector) for vector in given)
        except (AttributeError, TypeError) as error:
            raise CogmapError(
                f"motions: {type(spec).__name__} is no set of motions in whole numbers; give world.motions or "
                "{name: displacement}"
            ) from error
        return cls(names, vectors)

    def __len__(self) -> int:
        return len(self.names)

    def move(self, position: Position, action: int) -> Position:
        """The position that `action` leads to from `position` where the way is free."""
        return tuple(x + dx for x, dx in zip(position, self.displacements[action], strict=True))

    def undone(self, position: Position, action: int) -> Position:
        """The position from which `action` leads to `position`."""
        return self.move(position, self.inverse[action])


def _listed(spec: MotionSpec) -> tuple[tuple[str, ...], tuple[Sequence[int], ...]]:
    return tuple(spec.names), tuple(spec.displacements)
