"""The forward filter: exact sum-product over one time step of the sparse map.

    Q(s_t, p_t) ∝ A_o[o_t, s_t] c_t(s_t) A_p(p_t, s_t) Σ B_s[a](s_t, s_t-1) B_p[a](p_t, p_t-1) Q(s_t-1, p_t-1)

with the latent `moved_t`: with a small probability the agent was put into any visited place instead.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..model.cognitive_map import CognitiveMap
from ..model.distinct import distinct
from ..model.slices import found_shut
from .message import Belief, Evidence, FilterOptions, Message

FAINT = 1e-8
"""Odds beside the most probable place from which on another one may matter later (see `rivals`)."""

FEW = 50
"""Visited places that are looked at one and all."""

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class _Candidates:
    """Weighted pairs `[m]` before the evidence of this step.

    `source` indexes the message they come from; `told` is what the evidence has to be multiplied by (see `found_shut`);
    `factors` are P(o | s) and P(c | s).
    """

    places: Ints
    positions: Ints
    weight: Floats
    source: Ints
    told: Floats
    factors: Floats

    def joined(self, others: _Candidates) -> _Candidates:
        """These, then the others."""
        pairs = ((getattr(self, name), getattr(others, name)) for name in self.__slots__)
        return _Candidates(*(np.concatenate(pair) for pair in pairs))

    @property
    def joint(self) -> Floats:
        """`[m]` their joint masses with the evidence."""
        return self.weight * self.told * np.multiply.reduce(self.factors, axis=1)


def begin(map_: CognitiveMap, place: int, evidence: Evidence) -> Belief:
    """The belief of an agent that knows to be in `place`, after its first evidence."""
    start = np.array([place])
    here, one, like = np.zeros(1, dtype=np.int64), np.ones(1), factors(map_, start, evidence.sight, evidence.open)
    prior = _Candidates(start, map_.position_index[start], one, here, one, like)
    return _update(map_, None, prior, None, evidence, FilterOptions(support=0.0))


def advance(map_: CognitiveMap, message: Message, evidence: Evidence, options: FilterOptions) -> Belief:
    """The belief after one more action and its evidence."""
    walked = _walk(map_, message, evidence, options)
    share = float(walked.joint.sum())
    if options.displacement <= options.support * share:  # even a perfect match elsewhere would be dropped
        return _update(map_, message, walked, None, evidence, options)
    displaced, left_out = _displaced(map_, walked, evidence, options)
    return _update(map_, message, walked, displaced, evidence, options, left_out=left_out)


def factors(map_: CognitiveMap, places: Ints, sight: int, open_: Sequence[bool]) -> Floats:
    """`[n, 2]` P(o | s) and P(c | s): the sight, and the doors as sensed, given each place."""
    found = np.empty((len(places), 2))
    found[:, 0], found[:, 1] = map_.A_o.probability(sight, places), map_.doors_likelihood(places, open_)
    return found


def likelihood(map_: CognitiveMap, places: Ints, sight: int, open_: Sequence[bool]) -> Floats:
    """`[n]` P(o, c | s): the product of `factors`."""
    return np.multiply.reduce(factors(map_, places, sight, open_), axis=1)


def _walk(map_: CognitiveMap, message: Message, evidence: Evidence, options: FilterOptions) -> _Candidates:
    """Where the action leads: each successor, with the position moved or not, where A_p allows the two together."""
    action = evidence.action
    assert action is not None
    keys, p, _ = map_.B_s.mean(map_.rows(message.places, action))
    moves = 1.0 - options.slip if evidence.was_open else options.slip
    if action == map_.motions.stay:
        moves = 1.0
    ahead = map_.position_beyond[message.positions, action]
    told = found_shut(map_, message.places, keys, p, action, evidence.open, slip=1.0 - moves)
    p = p * (message.mass[:, None] * (1.0 - options.displacement))
    source, slot = np.nonzero((keys >= 0) & (p > 0.0))
    places, p, told = keys[source, slot], p[source, slot], told[source, slot]
    positions = np.concatenate([ahead[source], message.positions[source]])
    places, source = np.concatenate([places, places]), np.concatenate([source, source])
    weight = np.concatenate([p * moves, p * (1.0 - moves)]) * map_.A_p.probability(positions, places)
    fits = np.flatnonzero((positions >= 0) & (weight > 0.0))
    places, told = places[fits], np.concatenate([told, told])[fits]
    like = factors(map_, places, evidence.sight, evidence.open)
    return _Candidates(places, positions[fits], weight[fits], source[fits], told, like)


def _displaced(
    map_: CognitiveMap, walked: _Candidates, evidence: Evidence, options: FilterOptions
) -> tuple[_Candidates, float]:
    """The visited places where the agent may have been put, and the joint mass of those left out, at most.

    Left out are only places of which neither the belief nor its rivals would hear: most have never shown the sight.
    """
    visited = map_.visited_places
    if len(visited) <= FEW:
        return _put_into(map_, visited, evidence, options), 0.0
    listed, bound = map_.visited_with(evidence.sight)
    entered = walked.places[map_.visited[walked.places]]
    if 2 * len(listed) + FEW < len(visited):
        places = np.union1d(listed, entered)
        some = _put_into(map_, places, evidence, options)
        best = max(float(part.joint.max(initial=0.0)) for part in (walked, some))
        each = bound * options.displacement / len(visited)
        if each < min(options.support, FAINT) * best:
            return some, each * (len(visited) - len(places))
    return _put_into(map_, visited, evidence, options), 0.0


def _put_into(map_: CognitiveMap, places: Ints, evidence: Evidence, options: FilterOptions) -> _Candidates:
    """These of the visited places, with their positions, all alike."""
    keys, p, _ = map_.A_p.mean(places)
    like = factors(map_, places, evidence.sight, evidence.open).repeat(keys.shape[1], axis=0)
    places = np.repeat(places, keys.shape[1])
    weight = (p * (options.displacement / max(len(map_.visited_places), 1))).ravel()
    real = weight > 0.0
    count = int(real.sum())
    positions = keys.ravel()[real]
    return _Candidates(places[real], positions, weight[real], np.full(count, -1), np.ones(count), like[real])


def _update(
    map_: CognitiveMap,
    message: Message | None,
    walked: _Candidates,
    displaced: _Candidates | None,
    evidence: Evidence,
    options: FilterOptions,
    *,
    left_out: float = 0.0,
) -> Belief:
    all_ = walked if displaced is None else walked.joined(displaced)
    pairs, pair = distinct(all_.places * len(map_.positions) + all_.positions)
    pair_places, pair_positions = np.divmod(pairs, len(map_.positions))
    predicted = np.bincount(pair, weights=all_.weight, minlength=len(pairs))
    told = all_.weight * all_.told
    like = np.empty((len(pairs), 2))
    like[pair] = all_.factors
    joint = np.bincount(pair, weights=told, minlength=len(pairs)) * np.multiply.reduce(like, axis=1)
    total = joint.sum()
    kept = _support(pair_places, joint / total, options.support)
    z = float(joint[kept].sum())
    q = joint[kept] / z
    count = len(walked.weight)
    walked_mass = np.where(kept[pair[:count]], walked.joint, 0.0) / z
    unexamined = 0.0 if displaced is not None or message is None else options.displacement / (options.displacement + z)
    return Belief(
        message=Message(pair_places[kept], pair_positions[kept], q),
        evidence=float(np.log(z)),
        log_likelihood=np.log(joint[kept] / predicted[kept]),
        factors=like[kept],
        moved=max(0.0, 1.0 - float(walked_mass.sum())) if displaced is not None else 0.0,
        dropped=1.0 - z / (float(total) + left_out) + unexamined,
        examined=displaced is not None,
        walks=_walks(message, walked, walked_mass),
        faint=(pair_places[~kept], joint[~kept] / z),
    )


def _support(places: Ints, q: Floats, threshold: float) -> NDArray[np.bool_]:
    """Pairs of the places that hold at least `threshold`; the best place always stays."""
    _, index = distinct(places)
    mass = np.bincount(index, weights=q)
    return (mass >= min(threshold, float(mass.max())))[index]


def _walks(message: Message | None, walked: _Candidates, mass: Floats) -> tuple[Ints, Ints, Floats]:
    if message is None:
        none = np.zeros(0, dtype=np.int64)
        return none, none, np.zeros(0)
    held = mass > 0.0
    return message.places[walked.source[held]], walked.places[held], mass[held]
