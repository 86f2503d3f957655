"""Actions that lead nowhere around here: what is never open is not imagined to be."""

import numpy as np
from numpy.typing import NDArray

from ...model import EMPTY, Motions
from .cache import WayRows
from .transitions import Floats, Ints
from .view import MapView

RARE = 0.1  # P(open) below which a way of a place never entered is no way
STRENGTH = 2.0  # looks that the rate of all actions counts for, in the rate of one

UNKNOWN = 0.4, 0.6
"""P(blocked) in between which nothing is known of a way."""


def dormant(blocked: Floats, motions: Motions) -> NDArray[np.bool_]:
    """`[K]` actions that were found shut wherever one looked, so often that they hardly are open elsewhere.

    P(open) of an action is a Beta distribution, about the rate of all actions together: where the list of actions is
    long and few of them are ever open, a look or two is enough.

    Args:
        blocked: `[n, K]` P(blocked | s, a) of the places that were entered.
        motions: the actions; one whose inverse was open is as good as open itself.
    """
    least, most = UNKNOWN
    opened, shut = (blocked < least).sum(axis=0), (blocked > most).sum(axis=0)
    opened[motions.stay] = shut[motions.stay] = 0
    every, looks = int(opened.sum()), int(shut.sum()) + int(opened.sum())
    rate = (every + 1.0) / (looks + 2.0)
    back = np.where(np.array(motions.inverse) >= 0, opened[list(motions.inverse)], 0)
    asleep = (opened + back == 0) & (STRENGTH * rate < RARE * (shut + STRENGTH))
    asleep[motions.stay] = False
    return asleep


def leave_out_dormant(map_: MapView, places: Ints, rows: WayRows, entered: NDArray[np.bool_]) -> None:
    """Let the ways of places never entered be shut where the action is dormant, and looks at them teach nothing."""
    ahead, asleep = np.flatnonzero(~entered), dormant(rows.blocked[:-1][entered], map_.motions)
    if not len(ahead) or not asleep.any():
        return
    least, most = UNKNOWN
    blocked = rows.blocked[ahead]
    at, action = np.nonzero(asleep & (blocked > least) & (blocked < most))
    if not len(at):
        return
    place = ahead[at]
    taught = map_.transitions.looks(int(places[place[0]]), int(action[0]), rows.ways.shape[1] - 1)
    rows.successors[place, action], rows.probability[place, action] = EMPTY, 0.0
    rows.successors[place, action, 0], rows.probability[place, action, 0] = places[place], 1.0
    rows.blocked[place, action], rows.likely[place, action] = 1.0, -1
    rows.ways[:-1] -= np.bincount(place, minlength=len(places))[:, None] * taught
