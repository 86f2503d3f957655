"""Beginning anew: the later steps told to a tracker that knows nothing, and what its map makes of all before them.

What was taken for one place too early is seldom taken apart again, for all that came later was put on top of it, and
such a map grows for ever. A map of the later steps alone does not have that fault. By the chain rule

    log P(all steps) = log P(later steps) + log P(earlier steps | map of the later ones)

it is weighed against the map that there is, so that what was learned early is given up only where it was worth nothing.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from operator import add
from operator import sub as minus

from ...model import Periods
from .hypothesis import Hypothesis, settle_alike
from .rates import ASTRAY, ELSEWHERE, FAILS, MOVED, RELINKED, UNDONE
from .records import Place

TRIED, LATER = (32, 48, 72, 108, 162, 243, 364, 546), 256
"""Steps after which it is tried, each time half as late again so that steps are told few times, and how often then."""

LARGEST = 128
"""Places of a map that is begun anew at most: it takes as long as the steps that are told."""

SHARES = (0.5, 0.25, 0.125)
"""Shares of the steps that are left out, in turn."""

ODD = 0.5
"""How many oddities make a map doubtful."""


def is_odd(h: Hypothesis, tries: int) -> bool:
    """Whether ways lead off the chart or not back, or were thought to lead elsewhere, or the agent was moved.

    Moves that fail or go astray are common, and maps are mostly right then: these count every other time.
    """
    counts = h.counts
    odd = counts.yes[ELSEWHERE] + counts.yes[MOVED] + counts.yes[RELINKED] + counts.no[UNDONE]
    return odd + (tries % 2) * (counts.of(FAILS)[0] + counts.of(ASTRAY)[0]) > ODD


def is_known(h: Hypothesis, start: int) -> bool:
    """Whether the map is small enough to be begun anew, and all of it was seen in the steps that are remembered."""
    return h.size <= LARGEST and all(h.places[number].recent[-1] >= start for number in h.places)


def tries_until(time: int) -> int:
    """How many times it is begun anew until a step."""
    later = max(time - TRIED[-1], 0) // LATER
    return bisect_right(TRIED, time) + later


def first_told(start: int, time: int, tries: int) -> int:
    """The first of the steps that are told."""
    return start + 1 + int(SHARES[tries % len(SHARES)] * (time - start))


def lay_over(hypotheses: Sequence[Hypothesis], frame: int, here: Place) -> None:
    """Lay a chart over the first one, which is gone: the agent is where it was there, as the best one has it."""
    place, laid = hypotheses[0].places[hypotheses[0].here], dict[tuple[int, Periods], Place]()
    known = here.frame == 0 and place.frame == frame
    shift = tuple(map(minus, here.position, place.position)) if known else (0,) * len(place.position)
    for h in hypotheses:
        periods = h.periods.get(frame, ())
        if periods:
            h.periods[0] = h.periods.pop(frame)
        numbers = [number for number in h.places if h.places[number].frame == frame]
        for number in numbers:
            before = h.places[number]
            del h.at[frame, before.position]
            position = h.canonical(0, tuple(map(add, before.position, shift)))[1]
            after = before._replace(frame=0, position=position)
            h.at[0, position] = number
            h.put(number, laid.setdefault((id(before), periods), after))
    settle_alike(hypotheses)
