"""Numbers that learning goes by: concentrations before evidence, and counts that evidence adds."""

from dataclasses import astuple, dataclass, fields

import numpy as np

from .errors import CogmapError

_TINY, _LARGE = 1e-300, 1e12
_LEAST_FLOOR = 1e-15  # of doors: one minus less than this is one, and what is certain can never be otherwise


def is_number(value: object, least: float, most: float) -> bool:
    """Whether a value is a number in [least, most]. Truth values, NaN, text and arrays are not."""
    kind = isinstance(value, int | float | np.integer | np.floating) and not isinstance(value, bool)
    return kind and bool(least <= value <= most)  # type: ignore[operator]


def is_whole(value: object, least: int, most: int) -> bool:
    """Whether it is a whole number in [least, most]; a truth value is none."""
    return isinstance(value, int | np.integer) and not isinstance(value, bool) and bool(least <= value <= most)


@dataclass(frozen=True, slots=True)
class Priors:
    """Dirichlet concentrations before any evidence.

    Attributes:
        sight: of each sight in a column of A_o. Small: a room has one sight, it is only unknown which; after
            one look the probability of another sight is about this, so that one contradiction is telling.
        position: of a place's own position in A_p; every other position has none.
        transition: of each way a door can turn out (blocked, or the place beyond) in B_s. Well below one, since a
            door is either open or not; how far below matters little (docs/decisions).
        door_floor: a door is never believed open or blocked beyond `1 - door_floor`.

    Raises:
        CogmapError: a number is not positive, or `door_floor` below 1e-15 or above a half.
    """

    sight: float = 1e-9
    position: float = 1.0
    transition: float = 1e-6
    door_floor: float = 1e-6

    def __post_init__(self) -> None:
        for name, value in zip((field.name for field in fields(self)), astuple(self), strict=True):
            least, most = (_LEAST_FLOOR, 0.5) if name == "door_floor" else (_TINY, _LARGE)
            if not is_number(value, least, most):
                raise CogmapError(f"settings: priors.{name} is {value!r}; use a number from {least:g} to {most:g}")


@dataclass(frozen=True, slots=True)
class Rates:
    """Counts that one piece of evidence adds; each pair is (forward, reverse).

    Attributes:
        possible: a transition that was walked.
        impossible: a way that was found blocked; negative, taken from the transition, and added to staying.
        imagined: a transition behind a door that was sensed open.
        likelihood: a sight or position met in a place.
        ceiling: counts of one transition at most, however often it was walked: what one look at a closed door takes
            away (ours; docs/decisions).

    Raises:
        CogmapError: a pair is not two finite numbers, or `likelihood` or `ceiling` is out of range.
    """

    possible: tuple[float, float] = (7.0, 5.0)
    impossible: tuple[float, float] = (-7.0, -5.0)
    imagined: tuple[float, float] = (5.0, 3.0)
    likelihood: float = 1.0
    ceiling: float = 7.0

    def __post_init__(self) -> None:
        for name in ("possible", "impossible", "imagined"):
            pair: object = getattr(self, name)
            fine = (
                isinstance(pair, tuple | list) and len(pair) == 2 and all(is_number(x, -_LARGE, _LARGE) for x in pair)
            )
            if not fine:
                raise CogmapError(
                    f"settings: rates.{name} is {pair!r}; use two numbers of {_LARGE:g} at most, such as {(7.0, 5.0)}"
                )
        for name, least in (("likelihood", 0.0), ("ceiling", _TINY)):
            if not is_number(value := getattr(self, name), least, _LARGE):
                raise CogmapError(f"settings: rates.{name} is {value!r}; use a number from {least:g} to {_LARGE:g}")


TABLE_RATES = Rates()
"""The paper's table."""

TEXT_RATES = Rates(possible=(10.0, 7.0), impossible=(-10.0, -7.0), ceiling=10.0)
"""The paper's running text, which differs from its table."""

PAPER_RATES = Rates(ceiling=_LARGE)
"""The paper's table, as its agent goes by it: counts add up for ever."""
