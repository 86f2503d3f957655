"""What an agent can do: named actions, each a displacement in Z^n."""

from __future__ import annotations

import operator
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol, cast

from .errors import CogmapError
from .rates import is_whole

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

    Where actions have no displacements, each pair that undoes each other, and each action of which that is not known,
    is given an axis of its own, so that there are some; they say nothing, and only `NoPose()` goes with them.

    Raises:
        CogmapError: names repeat, vectors differ in length, an action has no inverse, there is not exactly one that
            stays, or `reverse` is none.
    """

    names: tuple[str, ...]  # action names, in the order of the action indices
    displacements: tuple[Position, ...] = ()  # one vector of `n` integers an action; exactly one is zero (`stay`)
    # without displacements, the index of the action that undoes each, -1 where nobody knows; () of all
    reverse: tuple[int, ...] = ()
    # for each action what the agent carries after it, None where that stays as it is; () of all (see `Carried`)
    takes: tuple[str | None, ...] = ()
    placed: bool = field(init=False)  # whether displacements were given
    # for each action the index of the action that undoes it, -1 where nobody knows
    inverse: tuple[int, ...] = field(init=False)
    stay: int = field(init=False)  # index of the action that goes nowhere; without displacements the one of that name

    def __post_init__(self) -> None:
        if not self.names:
            raise CogmapError("motions: give at least one action, and one displacement for each name")
        if not all(isinstance(name, str) for name in self.names):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise CogmapError(f"motions: names are {self.names}; give each action a word")
        if len(set(self.names)) < len(self.names):
            raise CogmapError(f"motions: names repeat in {self.names}; make them unique")
        words = all(isinstance(what, str | None) for what in self.takes)  # pyright: ignore[reportUnnecessaryIsInstance]
        if self.takes and not (words and len(self.takes) == len(self.names)):
            raise CogmapError(f"motions: takes is {self.takes}; give each action a word for what it takes, or None")
        object.__setattr__(self, "placed", bool(self.displacements))
        if self.placed:
            self._place()
        else:
            self._pair()

    def _place(self) -> None:
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

    def _pair(self) -> None:
        """Inverses as told, and an axis for each pair."""
        if "stay" not in self.names:
            raise CogmapError("motions: without displacements one action must be called 'stay'; add it")
        stay, count = self.names.index("stay"), len(self.names)
        inverse = list(self.reverse or (-1,) * count)
        inverse[stay : stay + 1] = [stay]
        known = all(isinstance(back, int) and -1 <= back < count for back in inverse)  # pyright: ignore[reportUnnecessaryIsInstance]
        pairs = known and all(back < 0 or inverse[back] in (-1, i) for i, back in enumerate(inverse))
        if len(self.reverse or inverse) != count or not pairs or inverse.count(stay) > 1:
            raise CogmapError(f"motions: reverse is {self.reverse}; give the action that undoes each, -1 for unknown")
        axes = dict.fromkeys(min(i, back) if back >= 0 else i for i, back in enumerate(inverse) if i != stay)
        place = {action: axis for axis, action in enumerate(axes)}
        vectors: list[Position] = []
        for i, back in enumerate(inverse):
            first = min(i, back) if back >= 0 else i
            vectors.append(
                tuple((1 if i == first else -1) * (place.get(first) == axis) for axis in range(max(len(axes), 1)))
            )
        object.__setattr__(self, "reverse", tuple(inverse))
        object.__setattr__(self, "displacements", tuple(vectors))
        object.__setattr__(self, "inverse", tuple(inverse))
        object.__setattr__(self, "stay", stay)

    def _check_shape(self) -> None:
        if len(self.names) != len(self.displacements):
            raise CogmapError("motions: give at least one action, and one displacement for each name")
        lengths = {len(displacement) for displacement in self.displacements}
        if len(lengths) != 1 or lengths == {0}:
            raise CogmapError("motions: displacements differ in length; use vectors of one Z^n, n >= 1")

    @classmethod
    def of(cls, spec: MotionSpec | Mapping[str, Sequence[int]]) -> Motions:
        """Motions from `world.motions`, or from a mapping such as `{"left": (-1,), "right": (1,), "stay": (0,)}`.

        Raises:
            CogmapError: displacements that are no vectors of whole numbers, all of one length; or neither.
        """
        if isinstance(spec, Motions):
            return spec
        try:
            names, given = (tuple(spec), tuple(spec.values())) if isinstance(spec, Mapping) else _listed(spec)
            vectors = tuple(tuple(operator.index(x) for x in vector) for vector in given)
            reverse = tuple(operator.index(x) for x in getattr(spec, "reverse", ())) if not vectors else ()
        except (AttributeError, TypeError) as error:
            raise CogmapError(
                f"motions: {type(spec).__name__} is no set of motions in whole numbers; give world.motions or "
                "{name: displacement}"
            ) from error
        return cls(names, vectors, reverse, tuple(getattr(spec, "takes", ())))

    def __len__(self) -> int:
        return len(self.names)

    def index(self, action: object) -> int | None:
        """The index of an action given by name or index; None of what is none."""
        if is_whole(action, 0, len(self) - 1):
            return int(cast(int, action))
        return self.names.index(action) if isinstance(action, str) and action in self.names else None

    def move(self, position: Position, action: int) -> Position:
        """The position that `action` leads to from `position` where the way is free."""
        return tuple(x + dx for x, dx in zip(position, self.displacements[action], strict=True))

    def undone(self, position: Position, action: int) -> Position:
        """The position from which `action` leads to `position`."""
        return self.move(position, self.inverse[action])


def _listed(spec: MotionSpec) -> tuple[tuple[str, ...], tuple[Sequence[int], ...]]:
    return tuple(spec.names), tuple(spec.displacements)
