"""How a tracker works, how its best hypothesis has changed, and what undoes a step."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from ...model import CogmapError, is_number

if TYPE_CHECKING:
    from .hypothesis import Hypothesis


TINY = 1e-15


@dataclass(frozen=True, slots=True)
class TrackerOptions:
    """Options of the tracker: how many hypotheses it keeps.

    Attributes:
        most: at most so many.
        least: those less probable than this, beside the most probable one, are dropped.
        doubt: while all others are less probable than this, beside the most probable one, nothing is in doubt, and
            that one is kept alone; once something is, the last steps are gone through again for what was passed over.
        folded: hypotheses in which look-alikes are tried to be united, besides those that found a new place.
        fragments: parts of a map that nothing joins to the rest, and that were walked through once and never come back
            to: of more than so many the oldest are forgotten, now and then.
        calm: steps that leave no doubt take a short way; the result is the same.

    Raises:
        CogmapError: a number is out of range.
    """

    most: int = 32
    least: float = 1e-5
    folded: int = 2
    doubt: float = 1e-3
    calm: bool = True
    fragments: int = 64

    def __post_init__(self) -> None:
        numbers = self.most, self.folded, self.fragments
        whole = all(type(number) is int for number in numbers) and isinstance(self.calm, bool)  # pyright: ignore[reportUnnecessaryIsInstance]
        shares = all(is_number(share, TINY, 1.0 - TINY) for share in (self.least, self.doubt))
        if not (whole and shares and min(self.most, self.fragments) >= 1 and self.folded >= 0):
            raise CogmapError(
                f"tracker: {self} cannot work; give whole numbers most >= 1, fragments >= 1 and "
                "folded >= 0, numbers 0 < least < 1 and 0 < doubt < 1, and a truth value calm"
            )


@dataclass(frozen=True, slots=True)
class Change:
    """How the best hypothesis follows from the best one before."""

    # `extended` if it is that one and this step, so that of its records only those of `places` have changed;
    # `revised` if another one has won, or places were united or taken away, or charts joined
    kind: Literal["extended", "revised"]
    places: tuple[int, ...] = ()  # numbers of the records that this step has changed or added; empty if it is `revised`


@dataclass(frozen=True, slots=True)
class Checkpoint:
    """What undoes one step of a tracker; see `Tracker.checkpoint`.

    Attributes:
        time: when it was taken.
        hypotheses, weights: those that there were.
        kept: the tracker's own numbers.
    """

    time: int
    hypotheses: tuple[Hypothesis, ...]
    weights: tuple[float, ...]
    kept: tuple[Any, ...]
