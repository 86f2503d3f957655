"""Walks grown on the map itself, towards the places that promise something."""

from __future__ import annotations

from dataclasses import dataclass
from operator import itemgetter

import numpy as np

from ...model.errors import CogmapError
from ..reach import Reach
from .base import Policies, check_look_ahead, padded

DEFAULT_BEAM = 64
LEAST = 1e-3  # nats; a lesser promise is none
PROMISING = 0.1  # nor is one below this share of the greatest in reach
GREAT = 0.5  # share of the greatest promise that a start must have within look-ahead, or it looks beyond
HYPOTHESES = 8  # places that the agent may be at, at most
HYPOTHESIS = 0.05  # and the belief each needs
BEYOND = 4  # places with a great promise to head for when none is within look-ahead
BLOCKED = 0.6  # P(blocked) from which an unknown way is not tried

Path = tuple[int, ...]
# (value of stopping here, how early it was collected, place, bit mask of promises collected, path)
Prefix = tuple[float, float, int, int, Path]
# per place: masks and values of the prefixes that already lead there
Archive = dict[int, list[tuple[int, float]]]


def map_guided(reach: Reach, *, beam: int = DEFAULT_BEAM) -> Policies:
    """A prefix tree over `reach.successor` from each place the agent may be at.

    The value of a prefix is the promise of the places on it, each counted once, plus the utility of its
    visits (staying at its end) less its risk of collision. Every kept prefix is a policy that then stays.

    - A walk may return on its track (dead ends need it), and never tries a way known to be blocked.
    - A prefix is merged into one that is at the same place as early or earlier, has collected all that
      it has, and is worth as much.
    - Of what is left, each level keeps the `beam` best by value, then by how early it was collected.
    - Beside each place the best prefix may end with one step through a way that the map knows nothing of.
    - If a start has no great promise within `look_ahead`, the shortest paths to the nearest places
      beyond that have one are added, so L may exceed `look_ahead`.

    Args:
        reach: the tables within reach.
        beam: prefixes kept a level, shared by the starts.

    Returns:
        Policies, `cut` the number of prefixes that the beam dropped.

    Raises:
        CogmapError: `beam` or `look_ahead` is below one.
    """
    check_look_ahead("map_guided", reach.look_ahead)
    if beam < 1:
        raise CogmapError(f"map_guided: beam is {beam}; give 1 or more")
    skeleton = _Skeleton.of(reach)
    starts = _starts(reach)
    paths: list[Path] = []
    cut = 0
    for start in starts:
        grown, dropped, found = _grow(skeleton, start, reach.look_ahead, max(1, beam // len(starts)))
        paths += grown
        cut += dropped
        if not found:
            paths += _beyond(skeleton, start)
    return Policies(padded(paths, stay=reach.motions.stay, length=reach.look_ahead), cut)


@dataclass(frozen=True, slots=True)
class _Skeleton:
    """The map as lists, which are quicker than arrays one element at a time.

    `ways[i]` holds (action, place it leads to, risk in nats), `unknown[i]` actions that lead nobody knows
    where, `bit[i]` is the place's bit (0: promises nothing), `promise[i]` and `utility[i]` are in nats,
    and a promise of `great` nats is worth going beyond the look-ahead.
    """

    ways: list[list[tuple[int, int, float]]]
    unknown: list[list[int]]
    bit: list[int]
    promise: list[float]
    utility: list[float]
    great: float

    @classmethod
    def of(cls, reach: Reach) -> _Skeleton:
        successor, moves = reach.successor, np.arange(len(reach.motions)) != reach.motions.stay
        ways: list[list[tuple[int, int, float]]] = [[] for _ in successor]
        unknown: list[list[int]] = [[] for _ in successor]
        known = (successor >= 0) & (successor != np.arange(len(successor))[:, None]) & moves
        place, action = np.nonzero(known)
        risk = reach.collision[place, action] * reach.collision_cost
        rows = zip(place.tolist(), action.tolist(), successor[place, action].tolist(), risk.tolist(), strict=True)
        for i, a, after, nats in rows:
            ways[i].append((a, after, nats))
        place, action = np.nonzero((successor < 0) & (reach.collision < BLOCKED) & moves)
        for i, a in zip(place.tolist(), action.tolist(), strict=True):
            unknown[i].append(a)
        greatest = float(reach.promise.max())
        floor = max(PROMISING * greatest, LEAST)
        promise = reach.promise.tolist()
        bit = [1 << i if worth > floor else 0 for i, worth in enumerate(promise)]
        return cls(ways, unknown, bit, promise, reach.utility.tolist(), max(GREAT * greatest, LEAST))


def _starts(reach: Reach) -> list[int]:
    """The places the agent may be at, the most probable first."""
    order = np.argsort(-reach.belief, kind="stable")[:HYPOTHESES].tolist()
    least = min(HYPOTHESIS, float(reach.belief[order[0]]) / 2)
    return [i for i in order if reach.belief[i] >= least]


def _grow(skeleton: _Skeleton, start: int, look_ahead: int, beam: int) -> tuple[list[Path], int, bool]:
    """The paths from `start`, the prefixes that the beam dropped, and whether a great promise was among them."""
    first: Prefix = (look_ahead * skeleton.utility[start], 0.0, start, skeleton.bit[start], ())
    archive: Archive = {start: [(first[3], first[0])]}
    level, paths, cut, found = [first], [()], 0, False
    for left in range(look_ahead, 0, -1):
        paths += _into_the_unknown(skeleton, level)
        candidates = _children(skeleton, level, left)
        level, dropped = _select(candidates, archive, beam)
        cut += dropped
        paths += [prefix[4] for prefix in level]
        ends = {prefix[2] for prefix in level} - {start}
        found = found or any(skeleton.promise[place] >= skeleton.great for place in ends)
    return paths, cut, found


def _children(skeleton: _Skeleton, level: list[Prefix], left: int) -> list[Prefix]:
    """Each prefix by one step, `left` steps before the end."""
    ways, bit, promise, utility = skeleton.ways, skeleton.bit, skeleton.promise, skeleton.utility
    children: list[Prefix] = []
    for value, early, place, mask, path in level:
        base = value - left * utility[place]
        for action, after, risk in ways[place]:
            worth = base + left * utility[after] - risk
            if bit[after] & ~mask:
                gain = promise[after]
                child = (worth + gain, early + left * gain, after, mask | bit[after], (*path, action))
            else:
                child = (worth, early, after, mask, (*path, action))
            children.append(child)
    return children


def _select(candidates: list[Prefix], archive: Archive, beam: int) -> tuple[list[Prefix], int]:
    """The `beam` best that nothing dominates; of two alike the first stays. Updates `archive`."""
    # best first, so that whatever dominates a candidate was archived before it
    candidates.sort(key=itemgetter(0, 1), reverse=True)
    kept: list[Prefix] = []
    dropped = 0
    for prefix in candidates:
        value, _, place, mask, _ = prefix
        rivals = archive.setdefault(place, [])
        for collected, worth in rivals:
            if worth >= value - 1e-9 and collected & mask == mask:
                break
        else:
            if len(kept) < beam:
                kept.append(prefix)
                rivals.append((mask, value))
            else:
                dropped += 1
    return kept, dropped


def _into_the_unknown(skeleton: _Skeleton, level: list[Prefix]) -> list[Path]:
    """The best prefix at each place, and one step through each way that the map knows nothing of."""
    best: dict[int, Path] = {}
    for prefix in level:
        best.setdefault(prefix[2], prefix[4])
    return [(*path, action) for place, path in best.items() for action in skeleton.unknown[place]]


def _beyond(skeleton: _Skeleton, start: int) -> list[Path]:
    """Shortest paths to the nearest great promises; if there are none, into the nearest unknown ways."""
    shortest: dict[int, Path] = {start: ()}
    queue = [start]
    for place in queue:
        for action, after, _ in skeleton.ways[place]:
            if after not in shortest:
                shortest[after] = (*shortest[place], action)
                queue.append(after)
    del shortest[start]
    promising = [path for place, path in shortest.items() if skeleton.promise[place] >= skeleton.great]
    unknown = [(*path, a) for place, path in shortest.items() for a in skeleton.unknown[place]]
    return (promising or unknown)[:BEYOND]
