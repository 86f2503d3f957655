"""Where nothing promising is near: the ways to the nearest promising places further off."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..local import LocalCache, MapView, Preferences, Surroundings

Ints = NDArray[np.int64]

FAR = 8
"""Promising places beyond the look-ahead that a plan takes in, at most."""

PROMISING = 0.1
"""P(o | s) of a preferred sight from which a place is promising."""


def far_ways(around: Surroundings) -> Ints:
    """The places on the shortest likely ways to the nearest promising places; none where a near one is promising.

    Promising is what was never entered, and what is preferred. Costs what it touches, whatever the size of the map.
    """
    map_, preferences = around.map, around.preferences
    hopeful = preferences.known or len(map_.visited_places) < len(map_.places)
    if not hopeful or promising(map_, preferences, around.near).any():
        return around.near[:0]
    parent: dict[int, int] = {
        -1: -1,
        **{place: place for place in around.starts.tolist()},
    }  # nowhere is no place to go on from
    frontier = around.starts
    while len(frontier):
        found = promising(map_, preferences, frontier)
        if found.any():
            return _traced(parent, frontier[found][:FAR].tolist())
        frontier = _next(around.cache, frontier, parent)
    return frontier


def promising(map_: MapView, preferences: Preferences, places: Ints) -> NDArray[np.bool_]:
    """`[n]` whether there is something to be hoped for in each of `places`."""
    found = ~map_.visited[places]
    for place, value in preferences.places.items():
        if value > 0.0:
            found |= places == place
    for sight, value in preferences.sights.items():
        if value > 0.0 and sight >= 0:
            found |= map_.A_o.probability(sight, places) > PROMISING
    return found


def _next(cache: LocalCache, frontier: Ints, parent: dict[int, int]) -> Ints:
    """The places one likely step further, in the order in which they are met; enters their parents."""
    reached: list[int] = []
    for place, row in zip(frontier.tolist(), cache.likely(frontier).tolist(), strict=True):
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
