"""Which way the ways of a place lead: what a place is known by that looks like many others."""

import sys
from collections.abc import Hashable, Sequence
from typing import Any, cast

import numpy as np

from ..errors import CogmapError
from ..rates import is_number
from .base import Context, Floats, Ints
from .sight import Sight
from .transition import Transition

NONE = -1  # stands for an action that has no way here


class Bearings(Sight):
    """A sensor of the bearing of each way, in degrees clockwise from north: `bearings` in observations.

    That is one number an action, None where there is no way. All together are the label that the place shows.
    """

    def __init__(self, name: str = "bearings", *, prior: float | None = None) -> None:
        super().__init__(name, prior=prior)

    def join(self, context: Context, transitions: Transition) -> None:
        super().join(context, transitions)
        self._actions = len(context.motions)

    def likelihood(self, places: Ints, reading: Any) -> Floats:
        """`[n]` P(o | s); a place never entered shows those of another as often as that happened so far."""
        told = super().likelihood(places, reading)
        fresh = ~self.context.visits.visited.values[places]
        if isinstance(reading, int) and fresh.any():
            told = np.where(fresh, self._of_new(reading), told)
        return told

    def log_predictive(self, reading: Any) -> float:
        return float(np.log(self._of_new(reading))) if isinstance(reading, int) else super().log_predictive(reading)

    def _of_new(self, reading: int) -> float:
        shown, _ = self.candidates(reading)
        kinds, entered = len(self.labels) - (not len(shown)), len(self.context.visits.order)
        again = (entered - kinds + 0.5) / (entered + 1.0)
        return again / max(kinds, 1) if len(shown) else 1.0 - again

    def check(self, value: Any) -> Hashable:
        """The bearings as a tuple, -1 for none. Raises CogmapError: not degrees, or None, for each action."""
        listed = isinstance(value, Sequence | np.ndarray) and not isinstance(value, str | bytes)
        given = list(cast(Sequence[Any], value)) if listed else []
        if len(given) != self._actions or not all(map(_is_bearing, given)):
            raise CogmapError(
                f"observation: {self.name} are {value!r}; give degrees for each of {self._actions} actions, "
                "None where there is no way"
            )
        return tuple(NONE if each is None else _degrees(float(each)) for each in given)


def _is_bearing(value: Any) -> bool:
    return value is None or is_number(value, -sys.float_info.max, sys.float_info.max)


def _degrees(value: float) -> int | float:
    whole = round(value % 360.0, 3) % 360.0
    return int(whole) if whole == int(whole) else whole
