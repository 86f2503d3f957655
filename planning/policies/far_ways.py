"""Where what is near is not the best: the ways to what is worth more, further off."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..local import LocalCache, MapView, Preferences, Surroundings

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

FAR = 8
"""Promising places beyond the look-ahead that a plan takes in, at most."""

PROMISING = 0.1
"""P(o | s) of a preferred sight from which a place is promising."""

MORE = 1.1
"""By how much what is further off must be worth more than all that is nearer."""


def far_ways(around: Surroundings) -> Ints:
    """The places on the shortest likely ways to places beyond look-ahead that are worth more than all that is nearer.

    Worth something is what was never entered, and what is preferred. Only likely ways count, as they are sensed: what
    lies behind a shut door is as far off as the way round. Costs what it touches, whatever the size of the map.
    """
    map_, preferences = around.map, around.preferences
    if not preferences.known and len(map_.visited_places) >= len(map_.places):
        return around.near[:0]
    most = _most(around)
    # nowhere is no place to go on from
    parent: dict[int, int] = {-1: -1, **{place: place for place in around.starts.tolist()}}
    frontier, best, steps, ends = around.starts, 0.0, 0, list[int]()
    while len(frontier) and MORE * best < most and len(ends) < FAR:
        worth = promise(map_, around.cache, preferences, frontier)
        if steps > around.look_ahead:
            ends += frontier[worth > MORE * best][: FAR - len(ends)].tolist()
        best = max(best, float(worth.max()))
        ahead = around.cache.likely(frontier) if steps else around.sensed()
        frontier, steps = _next(frontier, ahead, parent), steps + 1
    return _traced(parent, ends)


def _most(around: Surroundings) -> float:
    """What any place may be worth, but for one that is new and looks as is preferred."""
    map_, preferences, unseen = around.map, around.preferences, float(around.cache.unseen()[1])
    sights = max((value for key, value in preferences.sights.items() if key >= 0), default=0.0)
    places = [value + unseen * (not map_.visited[place]) for place, value in preferences.places.items()]
    new = unseen if len(map_.visited_places) < len(map_.places) else 0.0
    return max(max(places) + max(sights, 0.0), new) if places else max(sights, new)


def promise(map_: MapView, cache: LocalCache, preferences: Preferences, places: Ints) -> Floats:
    """`[n]` nats hoped for in each of `places`: what its sight would teach where it is new, and what is preferred."""
    worth = np.where(map_.visited[places], 0.0, cache.unseen()[1])
    for place, value in preferences.places.items():
        if value > 0.0:
            worth[places == place] += value
    for sight, value in preferences.sights.items():
        if value > 0.0 and sight >= 0:
            p = map_.A_o.probability(sight, places)
            worth += np.where(p > PROMISING, p * value, 0.0)
    return worth


def _next(frontier: Ints, ahead: Ints, parent: dict[int, int]) -> Ints:
    """The places one likely step further, in the order in which they are met; enters their parents."""
    reached: list[int] = []
    for place, row in zip(frontier.tolist(), ahead.tolist(), strict=True):
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
