"""Which ways of two places lead to each other, by where the places lie and which way their ways point."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

EXACT = 0.6  # degrees within which a way points at a place
ROUGH = 1.6  # the same of bearings in whole degrees that were made different from each other


class Between(NamedTuple):
    """A way of a place, and a way of another, that may be one.

    Attributes:
        other: index of the other place.
        action: the way there.
        back: the way of the other place that leads back.
        rough: whether they point past each other by more than rounding does, as far as it is known where the two lie.
    """

    other: int
    action: int
    back: int
    rough: bool


def between(here: Floats, mine: Floats, where: Floats, theirs: Floats, *, miss: Floats) -> list[Between]:
    """The ways that may be one, the most probable first: those that point at each other exactly, the shortest first.

    Args:
        here: `[3]` where the place is.
        mine: `[K]` bearings of its ways; below 0 where there is none.
        where: `[n, 3]` where the others are.
        theirs: `[n, K]` bearings of theirs.
        miss: `[n]` degrees by which a way may miss each, since nobody knows for sure where it lies.
    """
    across = where - here
    angle = np.rad2deg(np.arctan2(across[:, 0], across[:, 1]))
    there = _apart(mine[None] - angle[:, None], mine[None] < 0.0)
    back = _apart(theirs - angle[:, None] - 180.0, theirs < 0.0)
    within = ROUGH + miss
    rows = np.flatnonzero((there.min(axis=1) <= within) & (back.min(axis=1) <= within))
    length = np.linalg.norm(across, axis=1)
    found: list[tuple[float, Between]] = []
    for i in rows.tolist():
        for action in np.flatnonzero(there[i] <= within[i]).tolist():
            for its in np.flatnonzero(back[i] <= within[i]).tolist():
                if miss[i] and abs((mine[action] - theirs[i, its]) % 360.0 - 180.0) > ROUGH:
                    continue  # wherever the two lie, they do not point at each other
                rough = max(there[i, action], back[i, its]) > EXACT + miss[i]
                found.append((float(length[i]), Between(i, action, its, rough)))
    return [pair for _, pair in sorted(found, key=lambda each: (each[1].rough, each))]


def _apart(degrees: Floats, none: NDArray[np.bool_]) -> Floats:
    """How far an angle is from 0, up to 180."""
    apart = np.abs((degrees + 180.0) % 360.0 - 180.0)
    return np.where(none, np.inf, apart)
