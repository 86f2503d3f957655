"""Walks grown on the map itself, towards the places where a first visit is worth something."""

from __future__ import annotations

from dataclasses import dataclass
from operator import itemgetter
from typing import ClassVar

import numpy as np

from ...model import CogmapError, Floats, Motions
from ..local import LocalModel, Surroundings
from .base import MAX_POLICIES, Ints, Policies, PolicyGenerator, padded
from .far_ways import MORE, far_ways
from .telling import telling_walks

LEAST = 1e-3  # nats; a first visit that is worth less is worth nothing
SHARE = 0.1  # nor is one below this share of the greatest value in the model
GREAT = 0.5  # share of the greatest value that a start must have within look-ahead, or it looks beyond
HYPOTHESES = 8  # places that the agent may be at, at most
HYPOTHESIS = 0.05  # and the belief each needs
BEYOND = 4  # places of great value to head for when none is within look-ahead
AFTER = 8  # prefixes kept a level, of those that go on after a walk that tells hypotheses apart
BLOCKED = 0.6  # P(blocked) from which an unknown way is not tried

Path = tuple[int, ...]
# (value of stopping here, how early it was collected, place, bit mask of first visits collected, path)
Prefix = tuple[float, float, int, int, Path]
# per place: masks and values of the prefixes that already lead there
Archive = dict[int, list[tuple[int, float]]]


@dataclass(frozen=True, slots=True)
class MapGuided(PolicyGenerator):
    """Policies that follow the map: a prefix tree over `LocalModel.successor` from each place the agent may be in.

    The value of a prefix is the first-visit value of the places on it, each counted once, plus the utility of its
    visits (staying at its end) less its risk of collision. Every kept prefix is a policy that then stays.

    - A walk may return on its track (dead ends need it), and never tries a way known to be blocked.
    - A prefix is merged into one that is at the same place as early or earlier, has collected all that
      it has, and is worth as much.
    - Of what is left, each level keeps the `beam` best by value, then by how early it was collected.
    - A step along a way that no look has told of is worth what it teaches, once.
    - Beside each place the best prefix may end with one step through a way that the map knows nothing of.
    - If a start has no place of great value within `look_ahead`, the shortest paths to the nearest places
      beyond that have one are added, so L may exceed `look_ahead`; and always those to the nearest places beyond that
      are worth more than all that is nearer.
    - Where hypotheses about the map are open, the walks that tell them apart are added (`telling_walks`), however far,
      each going on as is best in the map.

    `Policies.cut` is the number of prefixes that the beam dropped.

    Raises:
        CogmapError: `beam` is no whole number from 1 to `MAX_POLICIES`.
    """

    name: ClassVar[str] = "map_guided"
    beam: int = 64  # prefixes kept a level, shared by the starts

    def __post_init__(self) -> None:
        whole = isinstance(self.beam, int | np.integer)  # pyright: ignore[reportUnnecessaryIsInstance]
        if not whole or isinstance(self.beam, bool) or not 1 <= self.beam <= MAX_POLICIES:
            raise CogmapError(f"map_guided: beam is {self.beam!r}; give a whole number from 1 to {MAX_POLICIES:,}")

    def make(self, model: LocalModel) -> Policies:
        self.check(model.motions, model.look_ahead)
        starts = _starts(model)
        if model.kept is None or not _calm(model):
            return self._made(model, starts)
        key = self, model.look_ahead, model.collision_cost, tuple(starts)
        if key not in model.kept.policies:
            model.kept.policies[key] = self._made(model, starts)
        return model.kept.policies[key]

    def _made(self, model: LocalModel, starts: list[int]) -> Policies:
        skeleton = _Skeleton.of(model)
        beam = max(1, self._width(model.motions, model.look_ahead) // len(starts))
        paths: list[Path] = []
        cut = 0
        for start in starts:
            grown, dropped, best = _grow(skeleton, start, model.look_ahead, beam)
            paths += grown
            cut += dropped
            if MORE * best < skeleton.greatest:
                paths += _beyond(skeleton, start, best)
        if model.structure is not None:
            for path in telling_walks(model.structure):
                paths += _telling(skeleton, starts[0], path, model.look_ahead)
        return Policies(padded(paths, stay=model.motions.stay, length=model.look_ahead), cut)

    def count(self, motions: Motions, look_ahead: int) -> int:
        return 1 + look_ahead * len(motions) * self._width(motions, look_ahead)

    def _width(self, motions: Motions, look_ahead: int) -> int:
        """Prefixes kept a level, so that a beam of any width is within the bound on policies."""
        return min(self.beam, max(1, (MAX_POLICIES - 1) // (look_ahead * len(motions))))

    def beyond(self, around: Surroundings) -> Ints:
        far = far_ways(around)
        if around.structure is None:
            return far
        walks = telling_walks(around.structure)
        return np.union1d(far, [place for walk in walks for place in _along(around, walk)]).astype(np.int64)


def first_visit_value(model: LocalModel) -> Floats:
    """`[R]` what a first visit is worth, in nats: what it teaches of the sight, and what is preferred there."""
    value = model.information_weight * model.information["sight"][:, 1] + np.maximum(model.log_C_place, 0.0)
    if model.log_C.any():  # by how much the sights of a place are preferred over any
        mean = (model.log_C @ model.multiplicity) / model.multiplicity.sum()
        value += np.maximum(model.log_C @ model.A - mean, 0.0)
    return value


def _calm(model: LocalModel) -> bool:
    """Whether nothing is to be had in any place, so that policies depend on ways alone."""
    nothing = (
        model.structure is None and model.untried is None and not model.log_C.any() and not model.log_C_place.any()
    )
    return nothing and float(first_visit_value(model)[:-1].max()) < LEAST


@dataclass(frozen=True, slots=True)
class _Skeleton:
    """The map as lists, which are quicker than arrays one element at a time.

    `ways[i]` holds (action, place it leads to, risk in nats), `unknown[i]` actions that lead nobody knows
    where, `bit[i]` is the place's bit (0: worth nothing), `value[i]` of a first visit, the `greatest` of them, the
    `floor` below which a first visit is worth nothing, and `utility[i]` are in nats. `tries[i]` has, of each way
    that is worth a try, its bit and its nats, by action.
    """

    ways: list[list[tuple[int, int, float]]]
    unknown: list[list[int]]
    bit: list[int]
    value: list[float]
    utility: list[float]
    greatest: float
    floor: float
    tries: list[dict[int, tuple[int, float]]]

    @classmethod
    def of(cls, model: LocalModel) -> _Skeleton:
        successor, moves = model.successor, np.arange(len(model.motions)) != model.motions.stay
        ways: list[list[tuple[int, int, float]]] = [[] for _ in successor]
        unknown: list[list[int]] = [[] for _ in successor]
        known = (successor >= 0) & (successor != np.arange(len(successor))[:, None]) & moves
        place, action = np.nonzero(known)
        risk = model.blocked[place, action] * model.collision_cost
        rows = zip(place.tolist(), action.tolist(), successor[place, action].tolist(), risk.tolist(), strict=True)
        for i, a, after, nats in rows:
            ways[i].append((a, after, nats))
        value, untried = first_visit_value(model), np.zeros(model.blocked.shape)
        if model.untried is not None:
            untried = model.information_weight * model.untried
        greatest = max(float(value.max()), float(untried.max()))
        floor = max(SHARE * greatest, LEAST)
        bit = [1 << i if worth > floor else 0 for i, worth in enumerate(value.tolist())]
        place, action = np.nonzero((successor < 0) & ((model.blocked < BLOCKED) | (untried > floor)) & moves)
        for i, a in zip(place.tolist(), action.tolist(), strict=True):
            unknown[i].append(a)
        tries: list[dict[int, tuple[int, float]]] = [{} for _ in successor]
        place, action = np.nonzero(untried > floor)
        for k, (i, a) in enumerate(zip(place.tolist(), action.tolist(), strict=True)):
            tries[i][a] = 1 << (len(successor) + k), float(untried[i, a])
        return cls(ways, unknown, bit, value.tolist(), model.utility.tolist(), greatest, floor, tries)


def _starts(model: LocalModel) -> list[int]:
    """The places the agent may be at, the most probable first."""
    order = np.argsort(-model.belief, kind="stable")[:HYPOTHESES].tolist()
    least = min(HYPOTHESIS, float(model.belief[order[0]]) / 2)
    return [i for i in order if model.belief[i] >= least]


def _grow(skeleton: _Skeleton, start: int, look_ahead: int, beam: int) -> tuple[list[Path], int, float]:
    """The paths from `start`, the prefixes that the beam dropped, and the greatest value of a place they lead to."""
    first: Prefix = (look_ahead * skeleton.utility[start], 0.0, start, skeleton.bit[start], ())
    archive: Archive = {start: [(first[3], first[0])]}
    level, paths, cut, best = [first], [()], 0, 0.0
    for left in range(look_ahead, 0, -1):
        paths += _into_the_unknown(skeleton, level)
        candidates = _children(skeleton, level, left)
        level, dropped = _select(candidates, archive, beam)
        cut += dropped
        paths += [prefix[4] for prefix in level]
        ends = {prefix[2] for prefix in level} - {start}
        best = max(best, *(skeleton.value[place] for place in ends), 0.0)
        best = max(best, *(nats for place in {start, *ends} for _, nats in skeleton.tries[place].values()), 0.0)
    return paths, cut, best


def _children(skeleton: _Skeleton, level: list[Prefix], left: int) -> list[Prefix]:
    """Each prefix by one step, `left` steps before the end."""
    ways, bit, first, utility = skeleton.ways, skeleton.bit, skeleton.value, skeleton.utility
    children: list[Prefix] = []
    for value, early, place, mask, path in level:
        base = value - left * utility[place]
        for action, after, risk in ways[place]:
            worth = base + left * utility[after] - risk
            if bit[after] & ~mask:
                gain = first[after]
                child = (worth + gain, early + left * gain, after, mask | bit[after], (*path, action))
            else:
                child = (worth, early, after, mask, (*path, action))
            if skeleton.tries[place]:
                child = _tried(skeleton, child, place, left)
            children.append(child)
    return children


def _tried(skeleton: _Skeleton, child: Prefix, place: int, left: int) -> Prefix:
    """The same with what the first step along its last way teaches."""
    value, early, after, mask, path = child
    bit, nats = skeleton.tries[place].get(path[-1], (0, 0.0))
    return (value + nats, early + left * nats, after, mask | bit, path) if bit & ~mask else child


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


def _along(around: Surroundings, walk: Path) -> list[int]:
    """The places on a walk from where the agent may be, as far as the map knows it."""
    at, found = around.starts, list[int]()
    for i, action in enumerate(walk):
        ahead = around.cache.likely(at) if i else around.sensed()
        at = np.unique(ahead[:, action])
        at = at[at >= 0]
        found += at.tolist()
    return found


def _telling(skeleton: _Skeleton, start: int, path: Path, look_ahead: int) -> list[Path]:
    """A walk that tells hypotheses apart, and how it may go on from where it leads to."""
    at = start
    for action in path:
        at = next((after for way, after, _ in skeleton.ways[at] if way == action), at)
    left = look_ahead - len(path)
    return [path + after for after in (_grow(skeleton, at, left, AFTER)[0] if left > 0 else [()])]


def _beyond(skeleton: _Skeleton, start: int, best: float) -> list[Path]:
    """Shortest paths to places that are worth more than all that is nearer.

    Where nothing great is near (`best`), also to the nearest places of great value; if there are none, into the nearest
    unknown ways.
    """
    shortest: dict[int, Path] = {start: ()}
    queue = [start]
    for place in queue:
        for action, after, _ in skeleton.ways[place]:
            if after not in shortest:
                shortest[after] = (*shortest[place], action)
                queue.append(after)
    del shortest[start]
    great, better = max(GREAT * skeleton.greatest, LEAST), _better(skeleton, shortest, best, skeleton.floor)
    if best >= great:
        return better
    worthy = [path for place, path in shortest.items() if skeleton.value[place] >= great]
    tries = ((path, a, nats) for place, path in shortest.items() for a, (_, nats) in skeleton.tries[place].items())
    worthy += [(*path, a) for path, a, nats in tries if nats >= great]
    unknown = [(*path, a) for place, path in shortest.items() for a in skeleton.unknown[place]]
    return better + (worthy or unknown)[:BEYOND] or _better(skeleton, shortest, best, LEAST)


def _better(skeleton: _Skeleton, shortest: dict[int, Path], best: float, floor: float) -> list[Path]:
    """The paths to places each of which is worth more than all before it; the last of them where they are many."""
    better: list[Path] = []
    best = max(best, floor)
    for place, path in shortest.items():
        if skeleton.value[place] > MORE * best:
            best = skeleton.value[place]
            better.append(path)
    return better[-BEYOND:]
