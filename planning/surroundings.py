"""Which places a plan takes in: those near by, and the ways to the nearest promising ones further off."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..model import CognitiveMap
from .outlook import Outlook
from .transitions import Ints

FAR = 8
"""Promising places beyond the look-ahead that a plan takes in, at most."""

Promising = Callable[[Ints], NDArray[np.bool_]]


def surroundings(
    map_: CognitiveMap,
    outlook: Outlook,
    places: Ints,
    look_ahead: int,
    promising: Promising,
    *,
    hopeful: bool = True,
) -> Ints:
    """Places that a plan takes in, ascending.

    These are all within `look_ahead` steps of `places`; where none of them promises anything, also the shortest known
    ways to the nearest that do, if there may be any (`hopeful`). Costs what it touches, whatever the size of the map.
    """
    near = _ball(map_, places, look_ahead)
    if not hopeful or promising(near).any():
        return near
    return np.union1d(near, _ways(outlook, places, promising))


def _ball(map_: CognitiveMap, places: Ints, look_ahead: int) -> Ints:
    """Places within `look_ahead` steps, however improbable, ascending."""
    size, keys = len(map_.motions), map_.B_s.keys
    frontier = places.tolist()
    known = set(frontier)
    for _ in range(look_ahead):
        ahead = {
            after for place in frontier for after in keys(slice(place * size, (place + 1) * size)).ravel().tolist()
        }
        frontier = [place for place in ahead - known if place >= 0]
        known.update(frontier)
    return np.array(sorted(known), dtype=np.int64)


def _ways(outlook: Outlook, places: Ints, promising: Promising) -> Ints:
    """The places on the shortest likely ways to the nearest promising places."""
    parent: dict[int, int] = {
        -1: -1,
        **{place: place for place in places.tolist()},
    }  # nowhere is no place to go on from
    frontier = places
    while len(frontier):
        found = promising(frontier)
        if found.any():
            return _traced(parent, frontier[found][:FAR].tolist())
        frontier = _next(outlook, frontier, parent)
    return places[:0]


def _next(outlook: Outlook, frontier: Ints, parent: dict[int, int]) -> Ints:
    """The places one likely step further, in the order in which they are met; enters their parents."""
    reached: list[int] = []
    for place, row in zip(frontier.tolist(), outlook.ways(frontier).tolist(), strict=True):
        for after in row:
            if after not in parent:
                parent[after] = place
                reached.append(after)
    return np.array(reached, dtype=np.int64)


def _traced(parent: dict[int, int], ends: list[int]) -> Ints:
    """All places on the ways to `ends`."""
    ways: set[int] = set()
    for end in ends:
        at = end
        while at not in ways:
            ways.add(at)
            at = parent[at]
    return np.array(sorted(ways), dtype=np.int64)
