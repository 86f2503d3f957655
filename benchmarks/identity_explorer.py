"""An explorer for measurements: to the nearest frontier of the best hypothesis, then where hypotheses differ."""

from __future__ import annotations

from collections import deque

import numpy as np

from cogmap.inference.hypotheses import NOWHERE, Hypothesis, Tracker
from identity_world import believed


class Explorer:
    """Answers with the next action."""

    def __init__(self, tracker: Tracker, seed: int, *, doors: bool = True) -> None:
        self.tracker, self.doors = tracker, doors
        self.rng = np.random.default_rng(seed)
        self.walked: dict[tuple[int, int], int] = {}

    def act(self) -> int:
        h = self.tracker.best
        action = self._frontier(h)
        if action is None:
            action = self._test(h)
        self.walked[h.here, action] = self.walked.get((h.here, action), 0) + 1
        return action

    def _frontier(self, h: Hypothesis) -> int | None:
        """First action of a shortest way to a way that is open and leads to no known place; ties go outward."""
        centre = _centre(h)
        level: dict[int, set[int]] = {h.here: set()}
        seen = {h.here}
        while level:
            ahead: dict[int, set[int]] = {}
            found: list[tuple[float, int]] = []
            for number, firsts in level.items():
                for way in range(h.scheme.count):
                    to, _ = believed(h, number, way)
                    if to == NOWHERE:
                        found.append((_outward(h, number, way, centre), 0 if firsts else 0))
                        first = firsts or {way}
                        found[-1] = (found[-1][0], int(self.rng.choice(sorted(first))))
                    elif to != number and to not in seen:
                        ahead.setdefault(to, set()).update(firsts or {way})
            if found:
                best = max(score for score, _ in found)
                ties = [action for score, action in found if score >= best - 1e-9]
                return ties[int(self.rng.integers(len(ties)))]
            seen.update(ahead)
            level = ahead
        return None

    def _test(self, h: Hypothesis) -> int:
        """The way that was walked least, near."""
        best, chosen = float("inf"), 0
        parents: dict[int, tuple[int, int]] = {}
        queue, depth = deque([h.here]), {h.here: 0}
        while queue:
            number = queue.popleft()
            place = h.places[number]
            for way in self.rng.permutation(h.scheme.count).tolist():
                to, _ = believed(h, number, way)
                if to == NOWHERE:
                    continue
                if to == number:
                    if self.doors:
                        continue
                    score = -place.ways[way].net + 0.1 * depth[number]
                else:
                    score = place.ways[way].walks + 0.1 * depth[number]
                score += 0.01 * self.rng.random()
                if score < best:
                    best, chosen = score, self._first(parents, h.here, number, way)
                if to not in depth:
                    depth[to] = depth[number] + 1
                    parents[to] = (number, way)
                    queue.append(to)
        return chosen

    def _first(self, parents: dict[int, tuple[int, int]], here: int, number: int, way: int) -> int:
        while number != here:
            number, way = parents[number]
        return way


def _centre(h: Hypothesis) -> tuple[float, ...] | None:
    if h.scheme.displacements is None:
        return None
    frame = h.places[h.here].frame
    positions = [h.places[k].position for k in h.places if h.places[k].frame == frame]
    return tuple(sum(axis) / len(positions) for axis in zip(*positions, strict=True))


def _outward(h: Hypothesis, number: int, way: int, centre: tuple[float, ...] | None) -> float:
    if centre is None or h.scheme.displacements is None:
        return 0.0
    place = h.places[number]
    moved = zip(place.position, h.scheme.displacements[way], centre, strict=True)
    return sum(abs(x + d - c) for x, d, c in moved)
