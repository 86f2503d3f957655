"""The likely shortest ways to places never entered, and which of them are worth taking."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..local import Frontier, Surroundings

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MOST = 64
"""Options that are weighed, the nearest, and equals of the last of them."""

DOUBT = 4.0
"""Steps that it is worth to see where a way leads, for each standard deviation that it would be long."""

SAMPLE = 512
"""Other places never entered to which the way back is measured, at most, spread evenly over all."""


def frontier_of(around: Surroundings, *, weight: float, most: int, beyond: int = 0) -> Frontier | None:
    """The best options from where the agent is; None where there are none, or one within `beyond` steps.

    Breadth first along likely ways of places that were entered; what was never entered ends an option. Costs what it
    touches: places within (1 + weight) / (1 - weight) times the way to the nearest option.
    """
    map_ = around.map
    if map_.visited.all() and not map_.pose.guessed(map_.transitions):
        return None
    search = _Search(around, (1.0 + weight) / (1.0 - weight))
    ends = search.ends
    if not ends:
        return _doubted(around, search, most)
    if search.depth[ends[0]] <= beyond:
        return None
    depth = np.array([search.depth[end] for end in ends], dtype=np.float64)
    back = _back(around, np.array(ends, dtype=np.int64), search)
    worth = depth - weight * back
    best = np.argsort(worth, kind="stable")
    kept = [ends[i] for i in best[:most].tolist()]
    ties = worth[best] <= worth[best[0]] + 1e-9
    kept = kept if int(ties.sum()) <= most else [ends[i] for i in best[ties].tolist()]
    paths = tuple(search.path(end) for end in kept)
    on = {place for end in kept for place in search.walk(end)}
    return Frontier(paths, tuple(sorted(on)), {end: float(back[ends.index(end)]) for end in kept})


def _doubted(around: Surroundings, search: _Search, most: int) -> Frontier | None:
    """Where nothing new is left, ways that are only thought to lead where they do; None if there are none."""
    met = [
        (search.depth[place] + 1 - DOUBT * doubt, place, action)
        for place, action, doubt in around.map.pose.guessed(around.map.transitions)
        if place in search.depth
    ]
    if not met:
        return None
    kept = [(place, action) for steps, place, action in sorted(met) if steps < min(met)[0] + 1e-9][:most]
    on = {place for at, _ in kept for place in search.walk(at)}
    return Frontier(tuple((*search.path(place), action) for place, action in kept), tuple(sorted(on)), {})


@dataclass(slots=True, init=False)
class _Search:
    """Breadth first from the place where the agent most probably is.

    Attributes:
        depth: steps to each place that was met.
        ends: places never entered, the nearest first.
    """

    depth: dict[int, int]
    ends: list[int]
    _before: dict[int, tuple[int, int]]  # place and action

    def __init__(self, around: Surroundings, reach: float) -> None:
        map_, cache = around.map, around.cache
        visited, start = map_.visited, int(around.starts[0])
        self.depth, self.ends, self._before = {start: 0}, [], {}
        level, steps, most = [start], 0, np.inf
        while level and steps < most and len(self.ends) < MOST:
            steps += 1
            rows = (cache.likely(np.array(level)) if steps > 1 else around.sensed()).tolist()
            ahead: list[int] = []
            for place, row in zip(level, rows, strict=True):
                for action, after in enumerate(row):
                    if after >= 0 and after not in self.depth:
                        self.depth[after], self._before[after] = steps, (place, action)
                        (ahead if visited[after] else self.ends).append(after)
            if self.ends and most == np.inf:
                most = reach * steps + 1.0
            level = ahead

    def path(self, end: int) -> tuple[int, ...]:
        """The actions that lead there."""
        actions: list[int] = []
        while end in self._before:
            end, action = self._before[end]
            actions.append(action)
        return tuple(reversed(actions))

    def walk(self, end: int) -> list[int]:
        """The places on the way there."""
        places = [end]
        while places[-1] in self._before:
            places.append(self._before[places[-1]][0])
        return places


def _back(around: Surroundings, ends: Ints, search: _Search) -> Floats:
    """`[n]` how far it is from each end to what else was never entered, on average, in steps."""
    places, where = around.cache.where.never_entered()
    mine = around.cache.where.of(ends)
    if not len(places) or np.isnan(mine).any():
        return _back_on_map(around, ends, search)
    if len(places) > SAMPLE:
        some = np.linspace(0, len(places) - 1, SAMPLE).astype(np.int64)
        places, where = places[some], where[some]
    apart = np.sqrt(np.square(mine[:, None] - where[None]).sum(axis=2))
    others = (ends[:, None] != places[None]).sum(axis=1)
    longest = max(around.map.pose.longest, 1e-12)
    return np.asarray(apart.sum(axis=1) / np.maximum(others, 1) / longest)


def _back_on_map(around: Surroundings, ends: Ints, search: _Search) -> Floats:
    """The same without positions: none."""
    return np.zeros(len(ends))
