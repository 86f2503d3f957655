"""Cuts out of the map what a plan can see: the places within look-ahead of the belief, and their tables."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...model import ELSEWHERE, EMPTY, CogmapError, distinct
from .cache import LocalCache, Ways
from .model import Floats, Ints, LocalModel
from .preferences import Preferences
from .transitions import Transitions
from .view import MapView


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What a policy generator is shown before the local model is cut, to ask for places further off.

    Attributes:
        map: the map.
        cache: of its places.
        starts: where the agent may be.
        near: all places within look-ahead of these, ascending.
        preferences: what is hoped for.
    """

    map: MapView
    cache: LocalCache
    starts: Ints
    near: Ints
    preferences: Preferences


def nothing_beyond(around: Surroundings) -> Ints:
    """No place further off."""
    return around.near[:0]


def local_model(
    map_: MapView,
    places: Ints,
    belief: Floats,
    *,
    open_: Sequence[bool],
    look_ahead: int,
    preferences: Preferences | None = None,
    discount: float = 1.0,
    information_weight: float = 1.0,
    starts: int = 32,
    cache: LocalCache | None = None,
    beyond: Callable[[Surroundings], Ints] = nothing_beyond,
) -> LocalModel:
    """The generative model over what policies can lead to from `belief` over `places`, with the doors `open_` now.

    Everything within `look_ahead` steps is in it, and what `beyond` asks for. Of a belief over more than `starts`
    places the likeliest remain (see `LocalModel.dropped`). What a `cache` of the map has kept from the last step is not
    worked out again.

    Raises:
        CogmapError: the cache is of another map or tells of fewer visits than `look_ahead`, or `starts` is below one.
    """
    cache = cache or LocalCache(map_, look_ahead)
    cache.check(map_, look_ahead)
    if starts < 1:
        raise CogmapError(f"plan: starts is {starts}; give 1 or more places to set out from")
    cache.refresh()
    preferences = preferences or Preferences()
    places, belief, dropped = _likeliest_starts(places, belief, starts)
    near = _ball(map_, places, look_ahead)
    far = beyond(Surroundings(map_, cache, places, near, preferences))
    within = np.union1d(near, far) if len(far) else near
    at, local = within.searchsorted(places), np.append(within, ELSEWHERE)
    q = np.zeros(len(local))
    q[at] = belief
    A, multiplicity, log_C = _sights(map_, within, preferences)
    ways = cache.ways(within)
    _sense(ways, within, at, open_)
    B, successor, blocked = _transitions(within, ways, map_.motions.stay)
    return LocalModel(
        motions=map_.motions,
        look_ahead=look_ahead,
        places=local,
        belief=q,
        A=A,
        multiplicity=multiplicity,
        log_C=log_C,
        log_C_place=preferences.log_C_place(local),
        B=B,
        blocked=blocked,
        collision_cost=preferences.collision_cost,
        information=_information(cache, within, look_ahead + 1),
        successor=successor,
        entered=np.append(map_.visited[within], False),
        position=np.append(positions := cache.positions(within), np.full_like(positions[:1], np.nan), axis=0),
        discount=discount,
        information_weight=information_weight,
        dropped=dropped,
    )


def _ball(map_: MapView, places: Ints, look_ahead: int) -> Ints:
    """Places within `look_ahead` steps, however improbable, ascending."""
    size, keys = len(map_.motions), map_.B_s.keys
    frontier = places.tolist()
    known = set(frontier)
    for _ in range(look_ahead):
        ahead = {
            after for place in frontier for after in keys(slice(place * size, (place + 1) * size)).ravel().tolist()
        }
        frontier = [place for place in ahead - known if place >= 0]
        known.update(frontier)
    return np.array(sorted(known), dtype=np.int64)


def _information(cache: LocalCache, places: Ints, columns: int) -> dict[str, Floats]:
    """What 0, 1, … visits of each of `places` teach, and, last, of everywhere never imagined."""
    last = {"sight": cache.unseen()[None, :columns]}
    return {
        name: np.append(table[:, :columns], last.get(name, np.zeros((1, columns))), axis=0)
        for name, table in cache.information(places).items()
    }


def _likeliest_starts(places: Ints, belief: Floats, most: int) -> tuple[Ints, Floats, float]:
    """The likeliest places, ascending, their share of the belief, and the belief in the others."""
    if len(places) <= most:
        return places, belief, 0.0
    # of equals, some from everywhere: places with near numbers are near each other, and look alike
    order = np.lexsort((np.arange(len(places)) * 0.6180339887498949 % 1.0, -belief))
    kept = np.sort(order[:most])
    mass = float(belief[kept].sum())
    return places[kept], belief[kept] / mass, max(float(belief.sum()) - mass, 0.0)


def _sights(map_: MapView, places: Ints, preferences: Preferences) -> tuple[Floats, Floats, Floats]:
    """A over the outcomes that places of the model (or preferences) tell apart, and one row for all the rest."""
    keys, p, other = map_.A_o.mean(places)
    preferred, log_preferred, log_other = preferences.log_C(map_.A_o.outcomes)
    row, slot = np.nonzero(keys >= 0)
    outcomes, index = distinct(np.concatenate([keys[row, slot], preferred]))
    apart, total = len(outcomes), map_.A_o.outcomes
    rest = total - apart
    A = np.full((apart + 1, len(places) + 1), 1.0 / total)
    A[:, :-1] = other
    A[index[: len(row)], row] = p[row, slot]
    A[-1] *= rest
    log_C = np.full(apart + 1, log_other)
    log_C[index[len(row) :]] = log_preferred
    multiplicity = np.ones(apart + 1)
    multiplicity[-1] = rest
    return (A, multiplicity, log_C) if rest else (A[:-1], multiplicity[:-1], log_C[:-1])


def _sense(ways: Ways, places: Ints, sensing: Ints, open_: Sequence[bool]) -> None:
    """Let the doors of `sensing` be as they are sensed now: shut, or not the place itself beyond."""
    here = places[sensing]
    is_open = np.array(open_, dtype=np.bool_)
    keys, p = ways.successors[sensing], ways.probability[sensing]
    own = keys == here[:, None, None]
    beyond = (p * ~own).sum(axis=2, keepdims=True)
    p = np.where(own & (beyond > 0.0), 0.0, p / np.where(beyond > 0.0, beyond, 1.0))
    keys[:, ~is_open], p[:, ~is_open] = EMPTY, 0.0
    keys[:, ~is_open, 0], p[:, ~is_open, 0] = here[:, None], 1.0
    sensed = Ways.of(here, keys, p)
    for name in Ways.__slots__:
        getattr(ways, name)[sensing] = getattr(sensed, name)


def _transitions(places: Ints, ways: Ways, stay: int) -> tuple[Transitions, Ints, Floats]:
    """B, the likeliest successors and P(blocked), over `places` and, last, everywhere never imagined."""
    size, actions, slots = ways.successors.shape
    at = _local(places, np.concatenate([ways.successors, ways.likely[:, :, None]], axis=2))
    successors = np.full((size + 1, actions, slots), size)
    probability = np.zeros((size + 1, actions, slots))
    successors[:-1], probability[:-1], probability[-1, :, 0] = at[:, :, :-1], ways.probability, 1.0
    successor = np.full((size + 1, actions), -1)
    successor[:-1] = np.where(ways.likely >= 0, at[:, :, -1], -1)
    successor[:-1, stay] = np.arange(size)
    collision = np.zeros((size + 1, actions))
    collision[:-1] = ways.blocked
    collision[:, stay] = 0.0
    return Transitions(successors, probability), successor, collision


def _local(places: Ints, keys: Ints) -> Ints:
    """`[R, ...]` places of the map by their local number, `R` for one never imagined.

    One that is not in the model becomes the place that leads to it (the first axis): no policy is meant to go there.
    """
    size = len(places)
    at = places.searchsorted(keys)
    at[at == size] = 0
    here = np.arange(size).reshape(-1, *(1,) * (keys.ndim - 1))
    return np.where(places[at] == keys, at, np.where(keys == ELSEWHERE, size, here))
