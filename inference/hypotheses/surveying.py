"""Surveying: the walk so far gone through once more, as if each label were one place, and slips as common as may be.

Where most moves go astray, each explains so little at first that a place which comes by again is taken for one more
that looks like it; and then looks repeat, so that the next is cheap to explain so too. That the world was slippery all
along is found only if it is asked of the whole walk: where places lie to each other that every move leads between.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from heapq import nlargest
from itertools import pairwise
from math import lgamma
from operator import add
from operator import sub as minus
from typing import NamedTuple

from .branches import Alternative, branches
from .chances import Chances
from .evidence import log_predictive
from .extending import begin, extend
from .hypothesis import EVEN, ROUND, Hypothesis
from .records import NOWHERE, Position
from .replaying import History
from .scheme import Sensed, WayScheme

BEAM = 64
"""Ways to lay places out that are kept while one place after another is laid down."""

MOST = 64
"""Labels up to which places are laid out; with more of them a walk is too short to come by each of them often."""

ODD = -8.0
"""Nats for a move between places that do not lie beside each other."""

Moves = Mapping[tuple[int, int], Counter[int]]
"""From one label to another, how often each way was to be taken."""


def surveyed(like: Hypothesis, history: History, *, floor: float) -> Hypothesis | None:
    """The map of the whole walk in which each label of the first sensor is a place of its own.

    Args:
        like: a hypothesis beside which it is weighed; its ways have displacements.
        history: every step from the first to the one now.
        floor: log P(walk) below which it is nothing.

    Returns:
        The hypothesis, its weight log P(walk, hypothesis); None where a label was not read, or there are too many,
        or below the floor.
    """
    steps = list(history)
    labels = [label for _, sensed in steps if isinstance(label := sensed.sights[0], int)]
    if len(labels) < len(steps) or len(set(labels)) > MOST:
        return None
    at, h, start = _laid_out(like, [sensed for _, sensed in steps], labels), like.emptied(), None
    for (time, sensed), label in zip(steps, labels, strict=True):
        if start is None:
            start, h.weight = at[label], log_predictive(h, sensed, None, None, NOWHERE)
            begin(h, sensed, time)
        else:
            there = tuple(map(minus, at[label], start))
            branch = max(_followed(h, sensed, there), key=lambda one: one.weight, default=None)
            if branch is None or branch.weight < floor:
                return None
            extend(h, branch, sensed, time)
        h.chances = Chances(h.counts, like.chances.labels, size=h.size)
    return h


def _followed(h: Hypothesis, sensed: Sensed, there: Position) -> Iterator[Alternative]:
    """The branches that lead to a place, or to a new one there."""
    known = h.at.get((0, there))
    for branch in branches(h, sensed, drop=100.0):
        if branch.crowd is None and (
            branch.to == known
            if known is not None
            else branch.charted and h.beyond(h.places[h.here], branch.way) == (0, there)
        ):
            yield branch


class _Layout(NamedTuple):
    """Where labels lie, how often each way led along each, and log P(moves) of that."""

    at: Mapping[int, Position]
    led: Mapping[tuple[int, int], int]
    score: float


def _laid_out(like: Hypothesis, steps: Sequence[Sensed], labels: Sequence[int]) -> Mapping[int, Position]:
    """Where each label lies, one after another, that first which most moves join to those that are laid down."""
    moves, beside = dict[tuple[int, int], Counter[int]](), Counter[tuple[int, int]]()
    for (before, label), sensed in zip(pairwise(labels), steps[1:], strict=True):
        if sensed.action is not None and not sensed.told:
            if label != before:
                moves.setdefault((before, label), Counter())[sensed.action] += 1
            beside.update(((before, label), (label, before)))
    left = set(labels)
    first = max(sorted(left), key=lambda label: sum(n for (one, _), n in beside.items() if one == label))
    beam, left = [_Layout({first: like.scheme.origin}, {}, 0.0)], left - {first}
    while left:
        placed = beam[0].at
        label = max(sorted(left), key=lambda label: sum(beside[label, other] for other in placed))
        longer = (more for layout in beam for more in _with(like, moves, layout, label))
        beam, left = nlargest(BEAM, longer, key=_score), left - {label}
    return beam[0].at


def _with(like: Hypothesis, moves: Moves, layout: _Layout, label: int) -> Iterator[_Layout]:
    """The layout with one label more, in each place beside those from or to which moves lead."""
    displacements, taken = like.scheme.displacements, {*layout.at.values()}
    assert displacements is not None
    ways = {displacements[way]: way for way in like.awake}
    near = {other: at for other, at in layout.at.items() if (other, label) in moves or (label, other) in moves}

    def free(places: Iterable[Position]) -> set[Position]:
        return {tuple(map(add, at, by)) for at in places for by in ways} - taken

    for there in sorted(free(near.values()) or free(taken)):  # somewhere else where all places beside those are taken
        led = dict(layout.led)
        for other, at in near.items():
            for one, to, by in (
                (other, label, tuple(map(minus, there, at))), (label, other, tuple(map(minus, at, there)))
            ):  # fmt: skip
                for given, times in moves.get((one, to), {}).items():
                    key = given, ways.get(by, NOWHERE)
                    led[key] = led.get(key, 0) + times
        yield _Layout({**layout.at, label: there}, led, _evidence(like.scheme, led))


def _score(layout: _Layout) -> float:
    return layout.score


def _evidence(scheme: WayScheme, led: Mapping[tuple[int, int], int]) -> float:
    """log P(ways taken | ways given), the table integrated out."""
    score, totals = 0.0, dict[int, int]()
    for (given, taken), times in led.items():
        if taken == NOWHERE:
            score += ODD * times
        else:
            prior = 1.0 if taken == given else ROUND if scheme.inverse and scheme.inverse[given] == taken else EVEN
            score += lgamma(prior + times) - lgamma(prior)
            totals[given] = totals.get(given, 0) + times
    whole = 1.0 + EVEN * (scheme.count - 1) + ROUND
    return score - sum(lgamma(whole + times) - lgamma(whole) for times in totals.values())
