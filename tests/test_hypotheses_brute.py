"""Trackers beside brute force: every history of branches, none joined, none dropped, in a corridor."""

from __future__ import annotations

from math import exp, inf

import pytest
from cogmap.inference.hypotheses import Hypothesis, Sensed, Tracker, TrackerOptions, WayScheme
from cogmap.inference.hypotheses.branches import branches
from cogmap.inference.hypotheses.chances import Chances
from cogmap.inference.hypotheses.extending import begin, extend

CORRIDOR = WayScheme(2, (1, 0), ((1,), (-1,)))
EAST, WEST = 0, 1


def histories(steps: list[Sensed], labels: int) -> list[Hypothesis]:
    """What may have happened, in every way that is named at all."""
    first = Hypothesis(CORRIDOR)
    first.chances = Chances(first.counts, [labels + 1])
    begin(first, steps[0], 0)
    found = [first]
    for time, sensed in enumerate(steps[1:], start=1):
        ahead: list[Hypothesis] = []
        for h in found:
            h.chances = Chances(h.counts, [labels + 1], size=h.size)
            for branch in branches(h, sensed, drop=inf):
                child = h.fork()
                extend(child, branch, sensed, time)
                ahead.append(child)
        found = ahead
    return found


def been_here(found: list[Hypothesis], times: int) -> list[float]:
    """P(the agent is where it was at a time), for each time."""
    total = sum(exp(h.weight) for h in found)
    at = [(exp(h.weight) / total, h.places[h.here].recent) for h in found]
    return [sum(p for p, recent in at if time in recent) for time in range(times)]


def percept(label: int, east: float, west: float, action: int | None = None) -> Sensed:
    return Sensed((label,), (east, west), action)


WALKS = {
    "there and back": [percept(0, 1, 0), percept(1, 1, 1, EAST), percept(0, 1, 0, WEST), percept(1, 1, 1, EAST)],
    "a move that fails": [percept(0, 1, 0), percept(1, 1, 1, EAST), percept(1, 1, 1, EAST), percept(0, 1, 0, WEST)],
    "a sight misread": [percept(0, 1, 0), percept(1, 1, 1, EAST), percept(2, 1, 0, WEST), percept(1, 1, 1, EAST)],
    "put back": [percept(0, 1, 0), percept(1, 1, 1, EAST), percept(2, 0, 1, EAST), percept(0, 1, 0, None)],
    "alike": [percept(0, 1, 1), percept(0, 1, 1, EAST), percept(1, 1, 1, EAST), percept(0, 1, 1, WEST)],
}


@pytest.mark.parametrize("walk", WALKS)
def test_where_it_is_is_what_all_histories_together_say(walk):
    steps = [*WALKS[walk], percept(1, 1, 1, EAST)]
    found = histories(steps, 3)
    tracker = Tracker(CORRIDOR, TrackerOptions(folded=0))
    for sensed in steps:
        tracker.step(sensed, [3])
    expected = been_here(found, len(steps))
    assert len(found) > 100
    assert been_here(tracker.hypotheses, len(steps)) == pytest.approx(expected, abs=0.02)
