"""Cuts out of the map what a plan can see: the places within reach of the belief, and their tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache, partial

import numpy as np
from numpy.typing import NDArray

from ..model.cognitive_map import ELSEWHERE, CognitiveMap
from ..model.dirichlet import EMPTY
from .information import dirichlet_information
from .reach import Floats, Ints, Reach
from .surroundings import successors, surroundings
from .transitions import Transitions, likeliest

MOST = 32
"""Places that the agent may be at from which a plan sets out, at most; belief in others is dropped, and counted."""

PROMISING = 0.1
"""Nats that a first visit must be worth for a place to be a goal of long ways."""


@dataclass(frozen=True, slots=True)
class Preferences:
    """What the agent hopes for.

    Attributes:
        sights: log preference of sights by number, relative to all others, in nats; `-1` stands for a sight
            never met.
        places: log preference of being in a place, by number, relative to all others, in nats.
        collision_cost: -log P(c = 1): what a collision costs, in nats.
    """

    sights: Mapping[int, float] = field(default_factory=dict[int, float])
    places: Mapping[int, float] = field(default_factory=dict[int, float])
    collision_cost: float = 1.0

    @property
    def known(self) -> bool:
        """Whether anything is hoped for that the map may have already."""
        sights = (value for key, value in self.sights.items() if key >= 0)
        return any(value > 0.0 for value in (*sights, *self.places.values()))

    def log_C(self, outcomes: int) -> tuple[Ints, Floats, float]:
        """Preferred outcomes, their log C, and that of each of the others, of `outcomes` in all."""
        keys = np.array(sorted(self.sights), dtype=np.int64)
        values = np.array([self.sights[int(key)] for key in keys])
        if not len(keys):
            return keys, values, 0.0
        norm = float(np.logaddexp.reduce(np.append(values, np.log(max(outcomes - len(keys), 1e-300)))))
        return keys, values - norm, -norm

    def log_C_place(self, places: Ints) -> Floats:
        """`[n]` log preference of being in each of `places`."""
        return np.array([self.places.get(place, 0.0) for place in places.tolist()])


def cut_reach(
    map_: CognitiveMap,
    places: Ints,
    belief: Floats,
    *,
    open_: Sequence[bool],
    look_ahead: int,
    preferences: Preferences,
    discount: float = 1.0,
    information_weight: float = 1.0,
) -> Reach:
    """The generative model over what policies can lead to from `belief` over `places`, with the doors `open_` now.

    Everything within `look_ahead` steps is in it; where nothing promising is among that, the way goes on to the
    nearest places that are. Of a belief over more than `MOST` places the likeliest remain (see `Reach.dropped`).
    """
    places, belief, dropped = _likeliest_starts(places, belief)
    within = surroundings(
        map_,
        places,
        look_ahead,
        partial(_promising, map_, preferences),
        hopeful=preferences.known or len(map_.visited_places) < len(map_.places),
    )
    local = np.append(within, ELSEWHERE)
    at = np.searchsorted(within, places)
    q = np.zeros(len(local))
    q[at] = belief
    A, multiplicity, log_C = _sights(map_, within, preferences)
    log_C_place = preferences.log_C_place(local)
    keys, alpha = successors(map_, within)
    after, p = _sensed(within, keys, alpha, at, open_)
    sights = _sight_information(map_, within, look_ahead)
    transition_information = np.zeros((len(local), look_ahead + 1))
    transition_information[:-1] = (_information(alpha, look_ahead) * _untold(map_, within, keys)[..., None]).sum(axis=1)
    position_information = np.zeros((len(local), look_ahead + 1))
    position_information[:-1] = _information(map_.A_p.concentration(within)[1], look_ahead)
    return Reach(
        motions=map_.motions,
        look_ahead=look_ahead,
        places=local,
        belief=q,
        A=A,
        multiplicity=multiplicity,
        log_C=log_C,
        log_C_place=log_C_place,
        B=_local_B(within, after, p),
        collision=_collision(within, after, p, map_.motions.stay),
        collision_cost=preferences.collision_cost,
        sight_information=sights,
        position_information=position_information,
        transition_information=transition_information,
        successor=_successor(within, after, p, map_.motions.stay),
        promise=information_weight * sights[:, 1]
        + np.maximum(log_C @ A - (log_C @ multiplicity) / multiplicity.sum(), 0.0)
        + np.maximum(log_C_place, 0.0),
        discount=discount,
        information_weight=information_weight,
        dropped=dropped,
    )


def _likeliest_starts(places: Ints, belief: Floats) -> tuple[Ints, Floats, float]:
    """The `MOST` likeliest places, ascending, their share of the belief, and the belief in the others."""
    if len(places) <= MOST:
        return places, belief, 0.0
    # of equals, some from everywhere: places with near numbers are near each other, and look alike
    order = np.lexsort((np.arange(len(places)) * 0.6180339887498949 % 1.0, -belief))
    kept = np.sort(order[:MOST])
    mass = float(belief[kept].sum())
    return places[kept], belief[kept] / mass, max(float(belief.sum()) - mass, 0.0)


def _promising(map_: CognitiveMap, preferences: Preferences, places: Ints) -> NDArray[np.bool_]:
    hoped = [key for key, value in preferences.sights.items() if value > 0.0 and key >= 0]
    promising = ~map_.visited[places] | (preferences.log_C_place(places) > 0.0)
    for key in hoped:
        promising |= map_.A_o.probability(key, places) > PROMISING
    return promising


def _sights(map_: CognitiveMap, places: Ints, preferences: Preferences) -> tuple[Floats, Floats, Floats]:
    """A over the outcomes that places in reach (or preferences) tell apart, and one row for all the rest."""
    keys, p, other = map_.A_o.mean(places)
    preferred, log_preferred, log_other = preferences.log_C(map_.A_o.outcomes)
    outcomes = np.union1d(keys[keys >= 0], preferred)
    rest = map_.A_o.outcomes - len(outcomes)
    A = np.empty((len(outcomes) + 1, len(places) + 1))
    A[:-1, :-1] = other
    row, slot = np.nonzero(keys >= 0)
    A[np.searchsorted(outcomes, keys[row, slot]), row] = p[row, slot]
    A[-1, :-1] = other * rest
    A[:-1, -1] = 1.0 / map_.A_o.outcomes
    A[-1, -1] = rest / map_.A_o.outcomes
    log_C = np.full(len(outcomes) + 1, log_other)
    log_C[np.searchsorted(outcomes, preferred)] = log_preferred
    multiplicity = np.append(np.ones(len(outcomes)), float(rest))
    return (A, multiplicity, log_C) if rest else (A[:-1], multiplicity[:-1], log_C[:-1])


def _sensed(places: Ints, keys: Ints, alpha: Floats, sensing: Ints, open_: Sequence[bool]) -> tuple[Ints, Floats]:
    """Successors and probabilities, `[R, K, slots]`; the doors of `sensing` are as they are sensed now."""
    keys, p = keys.copy(), alpha / alpha.sum(axis=2, keepdims=True)
    for i in sensing.tolist():
        for action, is_open in enumerate(open_):
            after, mass = keys[i, action], p[i, action]
            if not is_open:
                after[0], mass[:], mass[0] = places[i], 0.0, 1.0
                after[1:] = EMPTY
            elif mass[after == places[i]].sum() < 1.0:
                mass[after == places[i]] = 0.0
                mass /= mass.sum()
    return keys, p


def _local(places: Ints, keys: Ints) -> Ints:
    """Places of the map by their index in reach, `len(places)` for one never imagined.

    One that is out of reach becomes the place that leads to it (the first axis): no policy is meant to go there.
    """
    size = len(places)
    here = np.arange(size).reshape(-1, *(1,) * (keys.ndim - 1))
    at = np.searchsorted(places, keys)
    at[at == size] = 0
    return np.where(places[at] == keys, at, np.where(keys == ELSEWHERE, size, here))


def _local_B(places: Ints, keys: Ints, p: Floats) -> Transitions:
    """B over `places` and, last, everywhere never imagined, which nothing leaves."""
    size, actions, slots = keys.shape
    successors = np.full((size + 1, actions, slots), size)
    probability = np.zeros((size + 1, actions, slots))
    successors[:size], probability[:size], probability[size, :, 0] = _local(places, keys), p, 1.0
    return Transitions(successors, probability)


def _collision(places: Ints, keys: Ints, p: Floats, stay: int) -> Floats:
    """`[R + 1, K]` P(staying | s, a), zero for `stay` and in the last row."""
    collision = np.zeros((len(places) + 1, keys.shape[1]))
    collision[:-1] = (p * (keys == places[:, None, None])).sum(axis=2)
    collision[:, stay] = 0.0
    return collision


def _untold(map_: CognitiveMap, places: Ints, keys: Ints) -> NDArray[np.bool_]:
    """`[R, K]` whether a look at a door can teach: not where a visit has shown all it can, and no place lies beyond."""
    return ~(map_.visited[places][:, None] & (keys == ELSEWHERE).any(axis=2))


def _successor(places: Ints, keys: Ints, p: Floats, stay: int) -> Ints:
    """`[R + 1, K]` the likeliest place besides the place itself; the place itself where that is out of reach."""
    successor = np.full((len(places) + 1, keys.shape[1]), -1)
    likely = likeliest(keys, p, places, ELSEWHERE)
    successor[:-1] = np.where(likely >= 0, _local(places, likely), -1)
    successor[:-1, stay] = np.arange(len(places))
    return successor


def _sight_information(map_: CognitiveMap, places: Ints, steps: int) -> Floats:
    """`[R + 1, steps + 1]` for A_o; the last row, for elsewhere, is that of a place never seen."""
    keys, alpha, others = map_.A_o.concentration(places)
    background = map_.A_o.background
    alpha = np.column_stack([alpha, np.full(len(places), background)])
    many = np.column_stack([np.ones_like(keys, dtype=np.float64), others])
    fresh = np.zeros((1, alpha.shape[1]))
    fresh[0, -1] = background
    fresh_many = np.ones_like(fresh)
    fresh_many[0, -1] = map_.A_o.outcomes
    return _information(np.vstack([alpha, fresh]), steps, np.vstack([many, fresh_many]))


def _information(alpha: Floats, steps: int, multiplicity: Floats | None = None) -> Floats:
    """`dirichlet_information` of `[..., O]` concentrations; rows met before are looked up."""
    outcomes = alpha.shape[-1]
    rows = alpha.reshape(-1, outcomes)
    many = np.ones_like(rows) if multiplicity is None else multiplicity.reshape(rows.shape)
    packed = np.hstack([rows, many]).tobytes()
    width = 16 * outcomes
    table = [_row_information(packed[i : i + width], steps) for i in range(0, len(packed), width)]
    return np.array(table).reshape(*alpha.shape[:-1], steps + 1)


@lru_cache(maxsize=1 << 14)
def _row_information(packed: bytes, steps: int) -> Floats:
    """One row: its concentrations, then their multiplicities."""
    alpha, many = np.frombuffer(packed).reshape(2, -1)
    if (many[alpha > 0.0]).sum() <= 1.0:  # one outcome teaches nothing
        return np.zeros(steps + 1)
    return dirichlet_information(alpha, steps, multiplicity=many)
