"""The append-only log of everything that was ever added to a map."""

from collections.abc import Hashable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .errors import CogmapError

GrowthKind = Literal["time", "sight", "position", "place", "bind", "unbind", "retract"]

KINDS: tuple[GrowthKind, ...] = ("time", "sight", "position", "place", "bind", "unbind", "retract")
"""All kinds of growth."""


@dataclass(frozen=True, slots=True)
class GrowthEvent:
    """One addition to the model."""

    step: int  # time step at which it happened
    # `time` (variables and factors of a step), `sight` (a value of o), `position` (a value of p), `place` (a
    # value of s), `bind` (a place known before gets its position: static growth), `unbind` (it was given by
    # mistake), `retract` (the last places were imagined by mistake, and are gone)
    kind: GrowthKind
    index: int  # the number that the new step, value or place has from now on; for `retract`, how many places went
    label: Hashable = None  # the sight or the position as the agent knows it; for a place, its position or None
    source: int | None = None  # the place from which it was seen or entered, or None
    action: int | None = None  # index of the action that leads there from `source`, or None
    sensor: str | None = None  # for a `sight`, the name of the sensor whose label it is


def check_growth(rows: NDArray[Any], *, places: int, actions: int, sensors: int) -> None:
    """Refuse what is no log of growth of a map with so many places.

    Args:
        rows: `[events, 7]` step, kind, index, source, action, numbers of label and sensor; -1 for None.
        places, actions, sensors: how many there are.

    Raises:
        CogmapError: a number is out of range, or what came and went does not leave so many places.
    """
    fits = rows.ndim == 2 and rows.shape[1] == 7 and rows.dtype.kind == "i" and bool((rows >= -1).all())
    fits = fits and bool((rows[:, :3] >= 0).all() and (rows[:, 1] < len(KINDS)).all())
    fits = fits and bool((rows[:, 4] < actions).all() and (rows[:, 6] < sensors).all())
    fits = fits and bool((np.diff(rows[:, 0]) >= 0).all())
    if not (fits and _size_after(rows) == places):
        raise CogmapError("map: the log of growth is none of this map; save it again")


def _size_after(rows: NDArray[Any]) -> int:
    """How many places there are after these events; -1 where one is about a place that is not there."""
    size = 0
    of_places = rows[rows[:, 1] >= KINDS.index("place")]
    for kind, index, source in of_places[:, 1:4].tolist():
        what = KINDS[kind]
        fits = index == size if what == "place" else index <= size if what == "retract" else index < size
        if not fits or source >= size + (what == "place"):
            return -1
        size += 1 if what == "place" else -index if what == "retract" else 0
    return size
