"""The forward filter: exact sum-product over one time step of the sparse map, factor by factor.

    Q(s_t, p_t) ∝ Π P(reading | s_t) P(p_t | s_t) Σ P(s_t | s_t-1, a) P(p_t | p_t-1, a) Q(s_t-1, p_t-1)

with the latent `moved_t`: with a small probability the agent was put into any visited place instead. What the factors
are, and which there are, is the model's business.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..model import CogmapError, Floats, GenerativeModel, Ints, Percept, Successors, distinct
from .errors import ImpossibleEvidence
from .message import Belief, Message

PRUNED = 1e-8  # odds beside the most probable place from which on another one may matter later
FEW = 50  # visited places that are looked at one and all
SMALL = 1e-250  # likelihoods that are all below are brought up, so that none is rounded to zero


@dataclass(frozen=True, slots=True)
class _Candidates:
    """Weighted pairs `[m]` of a place and a pose.

    `weight` is their mass before the evidence, `source` the pair of the message that they come from, `coupling` that of
    the transition, and `likelihoods` `[m, F]` what the sensors say, all of them together up to a factor exp(`scale`):
    one is taken out where the numbers would be too small.
    """

    places: Ints
    positions: Ints
    weight: Floats
    source: Ints
    coupling: Floats
    likelihoods: Floats
    scale: float

    @classmethod
    def seen(
        cls,
        model: GenerativeModel,
        percept: Percept,
        places: Ints,
        positions: Ints,
        weight: Floats,
        source: Ints,
        coupling: Floats | None = None,
    ) -> _Candidates:
        """These pairs in the light of what is sensed."""
        told, scale = model.likelihoods(places, percept), 0.0
        if told.size and np.multiply.reduce(told, axis=1).max() < SMALL:
            log = model.log_likelihood(places, percept)
            scale = float(log.max())
            told[:, :-1], told[:, -1] = 1.0, np.exp(log - scale)
        coupling = np.ones(len(places)) if coupling is None else coupling
        return cls(places, positions, weight, source, coupling, told, scale)

    def joined(self, others: _Candidates) -> _Candidates:
        """These, then the others."""
        scale = max(self.scale, others.scale)
        these, those = self.scaled(scale), others.scaled(scale)
        return _Candidates(
            np.concatenate([these.places, those.places]),
            np.concatenate([these.positions, those.positions]),
            np.concatenate([these.weight, those.weight]),
            np.concatenate([these.source, those.source]),
            np.concatenate([these.coupling, those.coupling]),
            np.concatenate([these.likelihoods, those.likelihoods]),
            scale,
        )

    def scaled(self, scale: float) -> _Candidates:
        """With this factor taken out instead."""
        if scale == self.scale:
            return self
        told = self.likelihoods.copy()
        told[:, -1] *= np.exp(self.scale - scale)
        return replace(self, likelihoods=told, scale=scale)

    @property
    def joint(self) -> Floats:
        """`[m]` their joint masses with the evidence, up to the factor."""
        return self.weight * self.coupling * np.multiply.reduce(self.likelihoods, axis=1)


def begin(model: GenerativeModel, place: int, percept: Percept) -> Belief:
    """The belief of an agent that knows that it is in `place`, after its first evidence."""
    here = np.array([place])
    prior = _Candidates.seen(model, percept, here, model.pose.of(here), np.ones(1), np.zeros(1, dtype=np.int64))
    return _update(model, None, prior, None, support=0.0, displacement=0.0)


def advance(model: GenerativeModel, message: Message, percept: Percept, *, support: float = 1e-3) -> Belief:
    """The belief after one more action and its evidence. Places below `support` leave the domain.

    Raises:
        CogmapError: the percept has no action.
    """
    if percept.action is None:
        raise CogmapError("filter: the percept has no action; use begin() for the first one")
    places, pair = distinct(message.places)
    stays = model.pose.stays(percept.action, opened=percept.opened)
    ahead = model.transitions.predict(places, percept.action, percept, stays=stays)
    ahead = model.pose.leading(ahead, percept)
    walked = _walk(model, message, percept, ahead.of(pair))
    displacement = _probability(model, percept)
    share = float(walked.joint.sum()) * np.exp(walked.scale)
    if displacement <= support * share:  # even a perfect match elsewhere would be dropped
        return _update(model, message, walked, None, support=support, displacement=displacement, ahead=ahead)
    displaced, left_out = _displaced(model, walked, percept, support)
    return _update(
        model, message, walked, displaced, support=support, displacement=displacement, left_out=left_out, ahead=ahead
    )


def _walk(model: GenerativeModel, message: Message, percept: Percept, ahead: Successors) -> _Candidates:
    """Where the action leads: each successor with each pose that it may have then."""
    p = ahead.probability * (message.mass[:, None] * (1.0 - _probability(model, percept)))
    source, slot = np.nonzero((ahead.places >= 0) & (p > 0.0))
    places, p, coupling = ahead.places[source, slot], p[source, slot], ahead.coupling[source, slot]
    poses = model.pose.predict(message.positions, percept.action or 0, percept)
    positions = np.concatenate([pose[source] for pose, _, _ in poses])
    weight = np.concatenate([p * probability for _, probability, _ in poses])
    kinds = len(poses)
    places, source = np.tile(places, kinds), np.tile(source, kinds)
    coupling = np.concatenate([coupling * told for _, _, told in poses])
    weight *= model.pose.fit(positions, places)
    fits = np.flatnonzero((positions >= 0) & (weight > 0.0))
    return _Candidates.seen(model, percept, places[fits], positions[fits], weight[fits], source[fits], coupling[fits])


def _displaced(
    model: GenerativeModel, walked: _Candidates, percept: Percept, support: float
) -> tuple[_Candidates, float]:
    """The visited places where the agent may have been put, and log of the joint mass of those left out, at most.

    Left out are only places of which the belief would not hear: most have never shown the sight.
    """
    visited = model.visits.order.values
    found = None if len(visited) <= FEW else model.candidates(percept)
    if found is not None and 2 * len(found[0]) + FEW < len(visited):
        entered = walked.places[model.visits.visited.values[walked.places]]
        places = np.union1d(found[0], entered)
        some = _put_into(model, places, percept)
        best = max(float(part.joint.max(initial=0.0)) * np.exp(part.scale) for part in (walked, some))
        each = found[1] * _probability(model, percept) / len(visited)
        if each < min(support, PRUNED) * best:
            return some, each * (len(visited) - len(places))
    return _put_into(model, visited, percept), 0.0


def _probability(model: GenerativeModel, percept: Percept) -> float:
    return 0.0 if model.displacement is None else model.displacement.prior(percept)


def _put_into(model: GenerativeModel, places: Ints, percept: Percept) -> _Candidates:
    """These of the visited places, with their poses, all alike."""
    positions, p = model.pose.spread(places)
    weight = p * (_probability(model, percept) / max(len(model.visits.order), 1))
    row, slot = np.nonzero(weight > 0.0)
    nowhere = np.full(len(row), -1)
    return _Candidates.seen(model, percept, places[row], positions[row, slot], weight[row, slot], nowhere)


def _update(
    model: GenerativeModel,
    message: Message | None,
    walked: _Candidates,
    displaced: _Candidates | None,
    *,
    support: float,
    displacement: float,
    left_out: float = 0.0,
    ahead: Successors | None = None,
) -> Belief:
    all_ = walked if displaced is None else walked.joined(displaced)
    if not len(all_.weight):
        raise ImpossibleEvidence("filter: the action leads nowhere in this model; give displacement or slip a chance")
    size = max(len(model.pose.positions), 1)
    pairs, pair = distinct(all_.places * size + all_.positions)
    pair_places, pair_positions = np.divmod(pairs, size)
    predicted = np.bincount(pair, weights=all_.weight, minlength=len(pairs))
    told = np.empty((len(pairs), all_.likelihoods.shape[1]))
    told[pair] = all_.likelihoods
    coupled = np.bincount(pair, weights=all_.weight * all_.coupling, minlength=len(pairs))
    joint = coupled * np.multiply.reduce(told, axis=1)
    total = float(joint.sum())
    kept = _support(pair_places, joint / total, support)
    z = float(joint[kept].sum())
    evidence = float(np.log(z)) + all_.scale
    count = len(walked.weight)
    walked_mass = np.where(kept[pair[:count]], walked.scaled(all_.scale).joint, 0.0) / z
    unexamined = 0.0
    if displaced is None and message is not None:
        unexamined = displacement / (displacement + np.exp(evidence))
    return Belief(
        message=Message(pair_places[kept], pair_positions[kept], joint[kept] / z),
        evidence=evidence,
        log_likelihood=np.log(joint[kept] / predicted[kept]) + all_.scale,
        likelihoods=told[kept],
        moved=max(0.0, 1.0 - float(walked_mass.sum())) if displaced is not None else 0.0,
        dropped=1.0 - z / (total + left_out * np.exp(min(-all_.scale, 700.0))) + unexamined,
        examined=displaced is not None,
        pairwise=_pairwise(message, walked, walked_mass),
        pruned=(pair_places[~kept], joint[~kept] / z),
        ahead=ahead,
    )


def _support(places: Ints, q: Floats, threshold: float) -> NDArray[np.bool_]:
    """Pairs of the places that hold at least `threshold`; the best place always stays."""
    _, index = distinct(places)
    mass = np.bincount(index, weights=q)
    return (mass >= min(threshold, float(mass.max())))[index]


def _pairwise(message: Message | None, walked: _Candidates, mass: Floats) -> tuple[Ints, Ints, Floats]:
    if message is None:
        none = np.zeros(0, dtype=np.int64)
        return none, none, np.zeros(0)
    held = mass > 0.0
    return message.places[walked.source[held]], walked.places[held], mass[held]
