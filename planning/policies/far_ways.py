"""Where what is near is not the best: the ways to what is worth more, further off."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...model import Floats, Ints
from ..local import Surroundings

FAR = 8  # promising places beyond the look-ahead that a plan takes in, at most
PROMISING = 0.1  # P(o | s) of a preferred sight from which a place is promising
LONG = 24  # steps of a search from which on it is kept, to go on from
MORE = 1.1  # by how much what is further off must be worth more than all that is nearer


def far_ways(around: Surroundings) -> Ints:
    """The places on the shortest likely ways to places beyond look-ahead that are worth more than all that is nearer.

    Worth something is what was never entered, and what is preferred. Only likely ways count, as they are sensed: what
    lies behind a shut door is as far off as the way round. Costs what it touches, whatever the size of the map; on a
    long way that was found before, what is near.
    """
    map_, preferences = around.map, around.preferences
    if not (preferences.known or around.tries) and len(map_.visited_places) >= len(map_.places):
        return around.near[:0]
    search = _Search(around, _most(around))
    search.go_on(around.look_ahead + 1)
    before: _Found | None = around.cache.found
    if before is not None and search.lasts and before.holds(around, search.best):
        return before.places
    search.go_on()
    found = _traced(search.parent, search.ends)
    long = search.steps > LONG and len(search.ends) > 0
    around.cache.found = _Found(found, tuple(search.ends), search.best, around) if long else None
    return found


@dataclass(slots=True)
class _Search:
    """Breadth first along likely ways, until nothing can be worth more than the best that was met."""

    around: Surroundings  # what is searched
    most: float  # what any place may be worth
    best: float = 0.0  # the greatest worth so far
    steps: int = 0  # from the start to the places that come next, `frontier`
    # places beyond look-ahead that are worth more than all before them
    ends: list[int] = field(default_factory=list[int])
    frontier: Ints = field(init=False)
    parent: dict[int, int] = field(init=False)  # the place before each on the way there

    def __post_init__(self) -> None:
        self.frontier = self.around.starts
        # nowhere is no place to go on from
        self.parent = {-1: -1, **{place: place for place in self.frontier.tolist()}}

    @property
    def lasts(self) -> bool:
        """Whether something more may be found."""
        return len(self.frontier) > 0 and MORE * self.best < self.most and len(self.ends) < FAR

    def go_on(self, until: int | None = None) -> None:
        """Search on, up to so many steps from the start."""
        around, cache = self.around, self.around.cache
        while self.lasts and (until is None or self.steps < until):
            worth = promise(around, self.frontier)
            if self.steps > around.look_ahead:
                self.ends += self.frontier[worth > MORE * self.best][: FAR - len(self.ends)].tolist()
            self.best = max(self.best, float(worth.max()))
            ahead = cache.likely(self.frontier) if self.steps else around.sensed()
            self.frontier, self.steps = _next(self.frontier, ahead, self.parent), self.steps + 1


class _Found:
    """What a long search found, as long as it would be found again from a place on the way.

    Args:
        places: on the ways.
        ends: of the ways.
        best: the greatest worth of an end.
        around: of the search.
    """

    __slots__ = ("_best", "_ends", "_links", "_preferences", "places")

    def __init__(self, places: Ints, ends: tuple[int, ...], best: float, around: Surroundings) -> None:
        self.places, self._ends, self._best = places, np.array(ends), best
        self._links, self._preferences = around.cache.links, around.preferences

    def holds(self, around: Surroundings, near: float) -> bool:
        """Whether the agent is on the way, ways and preferences are the same, and nothing as good is near."""
        if (around.cache.links, around.preferences) != (self._links, self._preferences) or MORE * near >= self._best:
            return False
        worth = promise(around, self._ends)
        on = np.isin(around.starts, self.places).all() and len(around.starts) == 1
        return bool(on and worth.max() >= self._best and self._leads_on(around))

    def _leads_on(self, around: Surroundings) -> bool:
        """Whether the ways from where the agent is are sensed as the map has them."""
        return bool((around.sensed() == around.cache.likely(around.starts)).all())


def _most(around: Surroundings) -> float:
    """What any place may be worth, but for one that is new and looks as is preferred."""
    map_, preferences, unseen = around.map, around.preferences, float(around.cache.unseen()[1])
    sights = max((value for key, value in preferences.sights.items() if key >= 0), default=0.0)
    places = [value + unseen * (not map_.visited[place]) for place, value in preferences.places.items()]
    new = unseen if len(map_.visited_places) < len(map_.places) else 0.0
    new = max([new, *around.tries.values()])
    return max(max(places) + max(sights, 0.0), new) if places else max(sights, new)


def promise(around: Surroundings, places: Ints) -> Floats:
    """`[n]` nats hoped for in each of `places`.

    That is what its sight would teach where it is new, what is preferred, and the way that is most worth a try.
    """
    map_, cache, preferences, tries = around.map, around.cache, around.preferences, around.tries
    worth = np.where(map_.visited[places], 0.0, cache.unseen()[1])
    if tries:
        worth += [tries.get(place, 0.0) for place in places.tolist()]
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
