"""Nearest-frontier search (Yamauchi 1997, A frontier-based approach for autonomous exploration)."""

from collections.abc import Callable, Sequence

from .explorer import Explorer
from .reckoning import Place


class FrontierAgent(Explorer):
    """Goes by a shortest known way to the nearest place seen through a door but not entered.

    Draws are settled at random, alike for each pair of nearest place and first action towards it. Stays
    when there is nothing left to enter, or no open way to it. With a preference it goes to the nearest place where it
    has seen what it prefers, and stays; while it knows of none it explores.
    """

    def _choose(self, is_open: Sequence[bool]) -> int:
        ways = self._ways()
        return ways[int(self._rng.integers(len(ways)))][1] if ways else self._reckoner.stay

    def _ways(self) -> list[tuple[Place, int]]:
        sights = self._reckoner.track.sights
        to_goal = self._nearest(lambda place: sights.get(place) in self._wanted) if self._wanted else []
        return to_goal or self._nearest(lambda place: place not in sights)

    def _nearest(self, sought: Callable[[Place], bool]) -> list[tuple[Place, int]]:
        """Each nearest place that is sought with each first action on a shortest way to it."""
        track = self._reckoner.track
        level: dict[Place, set[int]] = {track.place: set()}
        seen = {track.place}
        while level:
            ahead: dict[Place, set[int]] = {}
            for place, firsts in level.items():
                for action in range(len(self._reckoner.vectors)):
                    other = track.edges[place, action]
                    if other not in seen:
                        ahead.setdefault(other, set()).update(firsts or {action})
            ways = [(place, first) for place in ahead if sought(place) for first in ahead[place]]
            if ways:
                return sorted(ways)
            seen.update(ahead)
            level = {place: firsts for place, firsts in ahead.items() if place in track.sights}
        return []
