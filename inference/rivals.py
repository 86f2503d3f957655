"""Hypotheses that did not get the map's ear: the agent has been elsewhere since some step.

A new place is taught to the map on the word of the most probable hypothesis (`Belief.committed`). Its rivals live on
here, by position alone, and are judged by the map as it was before that lesson; should one turn out the more
probable, what was taught since can be taken back, and taught again where it belongs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..model import CognitiveMap, Percept
from .filter import PRUNED
from .message import Belief, Message

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

COINCIDENCE = 1e-2
"""Odds that a rival may gain while nothing contradicts the belief: a world in which new places look like old ones, in
the same order, explains as much."""

DECISIVE = 0.997
"""Probability from which a rival is believed: more than one coincidence must speak for it, since one look-alike room
proves nothing."""

SURE = 1e12
"""Odds beyond which nothing is more certain."""

MOST = 256
"""Rivals that are kept, the most probable ones."""


@dataclass(frozen=True, slots=True)
class Rivals:
    """Where the agent may be instead.

    Attributes:
        positions: `[m, n]` the position in Z^n it would have now.
        since: `[m]` the time step from which on the map was taught by mistake, if so.
        visits: `[m]` number of visited places before that step.
        odds: `[m]` against the belief that was carried on.
        coincidence: `[m]` the same odds, if all coincidences counted: of two that are at the same position now, the one
            that explains more is kept.
    """

    positions: Ints
    since: Ints
    visits: Ints
    odds: Floats
    coincidence: Floats

    @classmethod
    def none(cls, dimensions: int) -> Rivals:
        """No rivals."""
        empty = np.zeros(0, dtype=np.int64)
        return cls(np.zeros((0, dimensions), dtype=np.int64), empty, empty, np.zeros(0), np.zeros(0))

    def __len__(self) -> int:
        return len(self.odds)

    @property
    def doubt(self) -> float:
        """Probability that any of the rivals is right."""
        total = float(self.odds.sum())
        return total / (1.0 + total)

    @property
    def best(self) -> int:
        """Index of the most probable one."""
        return int(self.odds.argmax())

    def probability(self, rival: int) -> float:
        """Posterior probability of one of them."""
        return float(self.odds[rival] / (1.0 + self.odds.sum()))

    def kept(self, which: NDArray[np.bool_] | Ints) -> Rivals:
        """Those of them."""
        return Rivals(*(getattr(self, name)[which] for name in self.__slots__))

    def joined(self, others: Rivals) -> Rivals:
        """These and the others, one a position, at most `MOST` of them."""
        pairs = ((getattr(self, name), getattr(others, name)) for name in self.__slots__)
        both = Rivals(*(np.concatenate(pair) for pair in pairs))
        both = both.kept(np.argsort(-both.coincidence, kind="stable"))
        _, first = np.unique(both.positions, axis=0, return_index=True)
        return both.kept(np.sort(first)[:MOST])


def rivals_of(map_: CognitiveMap, belief: Belief, *, step: int, visits: int) -> Rivals:
    """The places that `belief` holds possible besides the most probable one, just before it commits to that."""
    places, mass = belief.message.by_place
    places, mass = np.concatenate([places, belief.pruned[0]]), np.concatenate([mass, belief.pruned[1]])
    odds = mass / mass[places == belief.place].sum()
    held = (places != belief.place) & (odds > PRUNED)
    held &= np.array([map_.position(place) is not None for place in places.tolist()], dtype=np.bool_)
    positions = [map_.position(place) for place in places[held].tolist()]
    steps, many = np.full(len(positions), step), np.full(len(positions), visits)
    dimensions = len(map_.motions.displacements[0])
    return Rivals(np.array(positions, dtype=np.int64).reshape(-1, dimensions), steps, many, odds[held], odds[held])


def advance_rivals(
    map_: CognitiveMap, rivals: Rivals, belief: Belief, percept: Percept, *, displacement: float
) -> Rivals:
    """The rivals after one more action and its evidence; `belief` is what is carried on.

    Coincidence alone gives a rival no more than small odds. The belief is contradicted where it takes itself to have
    been moved at this very step (prior `displacement`), or finds what neither that nor anything new explains.
    Where a rival is in no place that it knows, it may have seen what the belief carried on has seen since they
    parted: then their odds stay as they are. Being in no known place explains nothing better than the belief does,
    or any wrong sight would speak for it.
    """
    if not len(rivals) or percept.action is None:
        return rivals
    ahead = map_.motions.displacements[percept.action] if percept.opened else 0
    positions = rivals.positions + np.asarray(ahead)
    found = (map_.place_at(tuple(position)) for position in positions.tolist())
    places = np.array([-1 if place is None else place for place in found])
    known = (places >= 0) & map_.visited[places] & ~_since(map_, places, rivals.visits)
    parted = _since(map_, np.full(len(rivals), belief.place), rivals.visits) | ~map_.visited[belief.place]
    anything = float(np.exp(map_.log_predictive(percept)))
    chance = displacement * anything  # of what nothing explains
    explained = max(float(np.exp(belief.evidence)), chance)
    gain = np.where(parted, 1.0, min(anything / explained, 1.0))
    likely = np.multiply.reduce(map_.likelihoods(places[known], percept), axis=1)
    gain[known] = np.maximum(likely, chance) / explained
    odds, coincidence = np.minimum(rivals.odds * gain, SURE), np.minimum(rivals.coincidence * gain, SURE)
    contradicted = belief.moved >= 0.5 or explained == chance
    if not contradicted:
        odds = np.minimum(odds, COINCIDENCE)
    return Rivals(positions, rivals.since, rivals.visits, odds, coincidence).kept(odds > PRUNED)


def _since(map_: CognitiveMap, places: Ints, visits: Ints) -> NDArray[np.bool_]:
    """`[m]` whether each place was first visited after the first `visits` ones."""
    return (places >= 0) & (map_.first_visit[places] >= visits)


def certain_of(map_: CognitiveMap, place: int, percept: Percept, *, odds: float, instead_of: Belief) -> Belief:
    """The belief of an agent that has found out that it is in `place`, at these odds against what it believed."""
    here, none = np.array([place]), np.zeros(0, dtype=np.int64)
    log_likelihood = map_.log_likelihood(here, percept)
    before = np.log(odds) + instead_of.evidence - log_likelihood[0]  # log odds before this evidence
    return Belief(
        message=Message.sure(place, int(map_.pose.of(here)[0])),
        evidence=float(log_likelihood[0] - np.logaddexp(0.0, -before)),
        log_likelihood=log_likelihood,
        moved=1.0,
        dropped=0.0,
        examined=True,
        pairwise=(none, none, np.zeros(0)),
        likelihoods=map_.likelihoods(here, percept),
    )
