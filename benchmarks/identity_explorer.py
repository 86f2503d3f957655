"""An explorer for measurements: to the nearest frontier of the best hypothesis, then where hypotheses differ."""

from __future__ import annotations

import math
from collections import deque

import numpy as np
from cogmap.inference.hypotheses import NOWHERE, Hypothesis, Tracker
from identity_world import believed

URGENT, WORTH = 0.35, 0.002
"""Nats a step from which on hypotheses are told apart before anything else, and when nothing else is to be done."""

TOGETHER = 8
"""Hypotheses that are told apart."""


def telling(tracker: Tracker, *, depth: int = 8, most: int = 400) -> tuple[int | None, float]:
    """First action of the walk that tells hypotheses apart best for its length, and its worth in nats a step.

    The hypotheses walk side by side; what they expect to sense divides them into classes, whose entropy is the worth.
    """
    top = tracker.hypotheses[:TOGETHER]
    weights = [math.exp(h.weight) for h in top]
    total = sum(weights)
    weights = [w / total for w in weights]
    if weights[0] > 0.995:
        return None, 0.0
    start = tuple(h.here for h in top)
    queue, seen = deque([(start, -1, 0)]), {start}
    best: tuple[int | None, float] = (None, 0.0)
    while queue and len(seen) < most:
        state, first, steps = queue.popleft()
        if steps >= depth or (best[0] is not None and 0.7 / (steps + 1) < best[1]):
            continue
        for way in range(tracker.scheme.count):
            ahead, classes = [], {}
            for h, number, w in zip(top, state, weights, strict=True):
                to, _ = believed(h, number, way)
                seen_there = expected(h, to, way)
                classes[seen_there] = classes.get(seen_there, 0.0) + w
                ahead.append(number if to == NOWHERE else to)
            worth = -sum(w * math.log(w) for w in classes.values() if w > 0.0) / (steps + 1)
            if worth > best[1] + 1e-9:
                best = (way if first < 0 else first, worth)
            state_ = tuple(ahead)
            if state_ not in seen and len(classes) == 1:
                seen.add(state_)
                queue.append((state_, way if first < 0 else first, steps + 1))
    return best


def expected(h: Hypothesis, number: int, way: int) -> object:
    """What is sensed in a place: its sight and its ways, as far as they are known."""
    if number == NOWHERE:
        return None
    place = h.places[number]
    return place.label(), tuple(w.net > 0.0 for w in place.ways if w.open + w.blocked > 0.0)


class Explorer:
    """Answers with the next action."""

    def __init__(self, tracker: Tracker, seed: int, *, doors: bool = True) -> None:
        self.tracker, self.doors = tracker, doors
        self.rng = np.random.default_rng(seed)
        self.walked: dict[tuple[int, int], int] = {}

    def act(self) -> int:
        """The next action."""
        h = self.tracker.best
        told, worth = telling(self.tracker) if len(self.tracker.hypotheses) > 1 else (None, 0.0)
        action = told if told is not None and worth > URGENT else self._frontier(h)
        if action is None:
            action = told if told is not None and worth > WORTH else self._test(h)
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
                    if to == NOWHERE or self._unknown(h, number, way):
                        first = sorted(firsts or {way})
                        found.append((_outward(h, number, way, centre), int(self.rng.choice(first))))
                    elif to != number and to not in seen:
                        ahead.setdefault(to, set()).update(firsts or {way})
            if found:
                best = max(score for score, _ in found)
                ties = [action for score, action in found if score >= best - 1e-9]
                return ties[int(self.rng.integers(len(ties)))]
            seen.update(ahead)
            level = ahead
        return None

    def _unknown(self, h: Hypothesis, number: int, way: int) -> bool:
        """Nothing is known of a way, nor of a place beyond it."""
        place = h.places[number]
        return place.ways[way].net == 0.0 and h.neighbour(place, way) == NOWHERE

    def _test(self, h: Hypothesis) -> int:
        """The way that was walked least, near."""
        best, chosen = float("inf"), 0
        parents: dict[int, tuple[int, int]] = {}
        queue, depth = deque([h.here]), {h.here: 0}
        while queue:
            number = queue.popleft()
            place = h.places[number]
            for way in self.rng.permutation(h.scheme.count).tolist():
                to, p = believed(h, number, way)
                if to == NOWHERE:
                    continue
                if p < 0.8:
                    score = 10.0 * p - 20.0 + depth[number]
                elif to == number:
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
