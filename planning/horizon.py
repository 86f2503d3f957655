"""Cuts out of the map what a plan can see: the places within reach of the belief, and their tables."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..model import ELSEWHERE, CognitiveMap
from ..model.dirichlet import EMPTY
from ..model.distinct import distinct
from ..model.errors import CogmapError
from .outlook import Doors, Outlook
from .preferences import Preferences
from .reach import Floats, Ints, Reach
from .surroundings import surroundings
from .transitions import Transitions

STARTS = 32
"""Places that the agent may be at from which a plan sets out, at most, unless told."""

PROMISING = 0.1
"""Nats that a first visit must be worth for a place to be a goal of long ways."""


def cut_reach(
    map_: CognitiveMap,
    places: Ints,
    belief: Floats,
    *,
    open_: Sequence[bool],
    look_ahead: int,
    preferences: Preferences,
    discount: float = 1.0,
    information_weight: float = 1.0,
    starts: int = STARTS,
    outlook: Outlook | None = None,
) -> Reach:
    """The generative model over what policies can lead to from `belief` over `places`, with the doors `open_` now.

    Everything within `look_ahead` steps is in it; where nothing promising is among that, the way goes on to the
    nearest places that are. Of a belief over more than `starts` places the likeliest remain (see `Reach.dropped`).
    What an `outlook` of the map has kept from the last step is not worked out again.

    Raises:
        CogmapError: the outlook is of another map or tells of fewer visits than `look_ahead`, or `starts` is below one.
    """
    outlook = outlook or Outlook(map_, look_ahead)
    outlook.check(map_, look_ahead)
    if starts < 1:
        raise CogmapError(f"plan: starts is {starts}; give 1 or more places to set out from")
    outlook.refresh()
    places, belief, dropped = _likeliest_starts(places, belief, starts)
    hopeful = preferences.known or len(map_.visited_places) < len(map_.places)
    within = surroundings(map_, outlook, places, look_ahead, partial(_promising, map_, preferences), hopeful=hopeful)
    R, at = len(within), within.searchsorted(places)
    local = np.append(within, ELSEWHERE)
    q = np.zeros(R + 1)
    q[at] = belief
    A, multiplicity, log_C = _sights(map_, within, preferences)
    log_C_place = preferences.log_C_place(local)
    doors, of_doors = outlook.doors(within)
    _sense(doors, within, at, open_)
    of_sights, of_positions = outlook.sights(within)
    nothing = np.zeros((1, look_ahead + 1))
    of_sights = np.concatenate([of_sights[:, : look_ahead + 1], outlook.unseen()[None, : look_ahead + 1]])
    B, successor, collision = _ways(within, doors, map_.motions.stay)
    return Reach(
        motions=map_.motions,
        look_ahead=look_ahead,
        places=local,
        belief=q,
        A=A,
        multiplicity=multiplicity,
        log_C=log_C,
        log_C_place=log_C_place,
        B=B,
        collision=collision,
        collision_cost=preferences.collision_cost,
        sight_information=of_sights,
        position_information=np.concatenate([of_positions[:, : look_ahead + 1], nothing]),
        transition_information=np.concatenate([of_doors[:, : look_ahead + 1], nothing]),
        successor=successor,
        promise=information_weight * of_sights[:, 1] + _hope(A, multiplicity, log_C) + np.maximum(log_C_place, 0.0),
        frontier=_frontier(map_, within),
        discount=discount,
        information_weight=information_weight,
        dropped=dropped,
    )


def _likeliest_starts(places: Ints, belief: Floats, most: int) -> tuple[Ints, Floats, float]:
    """The likeliest places, ascending, their share of the belief, and the belief in the others."""
    if len(places) <= most:
        return places, belief, 0.0
    # of equals, some from everywhere: places with near numbers are near each other, and look alike
    order = np.lexsort((np.arange(len(places)) * 0.6180339887498949 % 1.0, -belief))
    kept = np.sort(order[:most])
    mass = float(belief[kept].sum())
    return places[kept], belief[kept] / mass, max(float(belief.sum()) - mass, 0.0)


def _promising(map_: CognitiveMap, preferences: Preferences, places: Ints) -> NDArray[np.bool_]:
    promising = ~map_.visited[places]
    for place, value in preferences.places.items():
        if value > 0.0:
            promising |= places == place
    for sight, value in preferences.sights.items():
        if value > 0.0 and sight >= 0:
            promising |= map_.A_o.probability(sight, places) > PROMISING
    return promising


def _sights(map_: CognitiveMap, places: Ints, preferences: Preferences) -> tuple[Floats, Floats, Floats]:
    """A over the outcomes that places in reach (or preferences) tell apart, and one row for all the rest."""
    keys, p, other = map_.A_o.mean(places)
    preferred, log_preferred, log_other = preferences.log_C(map_.A_o.outcomes)
    row, slot = np.nonzero(keys >= 0)
    outcomes, index = distinct(np.concatenate([keys[row, slot], preferred]))
    told, total = len(outcomes), map_.A_o.outcomes
    rest = total - told
    A = np.full((told + 1, len(places) + 1), 1.0 / total)
    A[:, :-1] = other
    A[index[: len(row)], row] = p[row, slot]
    A[-1] *= rest
    log_C = np.full(told + 1, log_other)
    log_C[index[len(row) :]] = log_preferred
    multiplicity = np.ones(told + 1)
    multiplicity[-1] = rest
    return (A, multiplicity, log_C) if rest else (A[:-1], multiplicity[:-1], log_C[:-1])


def _hope(A: Floats, multiplicity: Floats, log_C: Floats) -> Floats | float:
    """`[R + 1]` by how much the sights of a place are preferred over any."""
    if not log_C.any():
        return 0.0
    return np.maximum(log_C @ A - (log_C @ multiplicity) / multiplicity.sum(), 0.0)


def _frontier(map_: CognitiveMap, places: Ints) -> Floats:
    """`[R + 1]` squared distance from the origin of places never entered, -1 for others; empty where there are none."""
    new = np.flatnonzero(~map_.visited[places])
    if not len(new):
        return np.zeros(0)
    frontier = np.full(len(places) + 1, -1.0)
    for i, place in zip(new.tolist(), places[new].tolist(), strict=True):
        position = map_.position(place)
        if position is not None:
            frontier[i] = sum(x * x for x in position)
    return frontier


def _sense(doors: Doors, places: Ints, sensing: Ints, open_: Sequence[bool]) -> None:
    """Let the doors of `sensing` be as they are sensed now: shut, or not the place itself beyond."""
    here = places[sensing]
    is_open = np.array(open_, dtype=np.bool_)
    keys, p = doors.successors[sensing], doors.probability[sensing]
    own = keys == here[:, None, None]
    beyond = (p * ~own).sum(axis=2, keepdims=True)
    p = np.where(own & (beyond > 0.0), 0.0, p / np.where(beyond > 0.0, beyond, 1.0))
    keys[:, ~is_open], p[:, ~is_open] = EMPTY, 0.0
    keys[:, ~is_open, 0], p[:, ~is_open, 0] = here[:, None], 1.0
    sensed = Doors.of(here, keys, p)
    for name in Doors.__slots__:
        getattr(doors, name)[sensing] = getattr(sensed, name)


def _ways(places: Ints, doors: Doors, stay: int) -> tuple[Transitions, Ints, Floats]:
    """B, the likeliest successors and P(blocked), over `places` and, last, everywhere never imagined."""
    size, actions, slots = doors.successors.shape
    at = _local(places, np.concatenate([doors.successors, doors.likely[:, :, None]], axis=2))
    successors = np.full((size + 1, actions, slots), size)
    probability = np.zeros((size + 1, actions, slots))
    successors[:-1], probability[:-1], probability[-1, :, 0] = at[:, :, :-1], doors.probability, 1.0
    successor = np.full((size + 1, actions), -1)
    successor[:-1] = np.where(doors.likely >= 0, at[:, :, -1], -1)
    successor[:-1, stay] = np.arange(size)
    collision = np.zeros((size + 1, actions))
    collision[:-1] = doors.blocked
    collision[:, stay] = 0.0
    return Transitions(successors, probability), successor, collision


def _local(places: Ints, keys: Ints) -> Ints:
    """`[R, ...]` places of the map by their index in reach, `R` for one never imagined.

    One that is out of reach becomes the place that leads to it (the first axis): no policy is meant to go there.
    """
    size = len(places)
    at = places.searchsorted(keys)
    at[at == size] = 0
    here = np.arange(size).reshape(-1, *(1,) * (keys.ndim - 1))
    return np.where(places[at] == keys, at, np.where(keys == ELSEWHERE, size, here))
