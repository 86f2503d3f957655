"""Cuts out of the map what a plan can see: the places within look-ahead of the belief, and their tables."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ...model import ELSEWHERE, EMPTY, CogmapError, SparseDirichlet, distinct
from .cache import Cut, LocalCache, WayRows
from .dormant import leave_out_dormant
from .frontier import Frontier
from .kept import Kept
from .model import Floats, Ints, LocalModel
from .preferences import Preferences
from .structure import MapHypotheses, Structure
from .transitions import Transitions, likeliest
from .view import MapView

FEW = 128  # places up to which what their ways would tell of each is asked: the work is the square of their number
SURE = 0.5  # belief in one place from which on an agent explores by options from there
HOPE = 0.4  # P(a way that is worth a try leads beyond) from which on plans count on it


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What a policy generator sees before the local model is built, so that it can ask for places further away."""

    map: MapView  # the map
    cache: LocalCache  # of its places
    starts: Ints  # where the agent may be
    near: Ints  # all places within look-ahead of these, however improbable the way, ascending
    preferences: Preferences  # what is hoped for
    open: Sequence[bool]  # for each action, whether its way is sensed open now
    look_ahead: int  # steps that policies look ahead
    structure: Structure | None = None  # hypotheses about the map, side by side; None where there is but one
    unseen: Sequence[bool] = ()  # for each action, whether nothing senses its way
    # `[K]` what each action is expected to cost from where the agent is, in usual moves; None of all alike
    prices: Floats | None = None

    @property
    def tries(self) -> Mapping[int, float]:
        """The most that a step along a way teaches, by place, where that is anything."""
        return self.cache.untried if any(self.unseen) else {}

    def sensed(self) -> Ints:
        """`[n, K]` where each action most probably leads to from the starts, as sensed now; see `LocalCache.likely`."""
        rows = self.cache.ways(self.starts)
        tries = _unseen(self.cache, rows, self.starts, self.unseen)
        _sense(rows, self.starts, np.arange(len(self.starts)), self.open, tries)
        return rows.likely[:-1]


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
    structure: MapHypotheses | None = None,
    costs: Floats | None = None,
    explorer: Callable[[Surroundings], Frontier | None] | None = None,
    unseen: Sequence[bool] = (),
    prices: Floats | None = None,
) -> LocalModel:
    """The generative model over the places that policies can reach from `belief`, with the doors `open_` now.

    Everything within `look_ahead` steps is in it, and what `beyond` asks for; or, where an `explorer` answers with
    options, the ways to them, undiscounted. Of a belief over more than `starts` places the likeliest remain (see
    `LocalModel.dropped`). What a `cache` of the map has kept from the last step is not worked out again. Of the ways of
    actions that are `unseen`, no sensor tells: a step along one does.

    Raises:
        CogmapError: the cache is of another map or tells of fewer visits than `look_ahead`, `starts` is below one, or
            the hypotheses have weights that are none.
    """
    cache = cache or LocalCache(map_, look_ahead)
    cache.check(map_, look_ahead)
    if starts < 1:
        raise CogmapError(f"plan: starts is {starts}; give 1 or more places to set out from")
    cache.refresh()
    preferences = preferences or Preferences()
    places, belief, dropped = _likeliest_starts(places, belief, starts)
    apart, frontier = Structure.of(structure), None
    around = Surroundings(map_, cache, places, places[:0], preferences, open_, look_ahead, apart, unseen, prices)
    if explorer is not None and belief.max() >= SURE:
        frontier = explorer(replace(around, starts=places[[belief.argmax()]]))
    if frontier is not None:
        near, far, discount = cache.within(places, 1), np.array(frontier.places, dtype=np.int64), 1.0
    else:
        near = cache.within(places, look_ahead)
        far = beyond(replace(around, near=near))
    within = np.union1d(near, far) if len(far) else near
    key = places.tobytes(), within.tobytes(), tuple(open_), tuple(unseen)
    cut = cache.cut(key, partial(_cut, map_, cache, places, within, open_, unseen))
    q = np.zeros(len(cut.places))
    q[cut.at] = belief
    A, multiplicity, log_C = _sights(map_.A_o, within, preferences)
    others = [sensor.table for sensor in map_.sights_sensed[1:]]
    seen = cache.sights(within)
    seen.position[-1] = np.nan
    seen.sights[-1] = cache.unseen()
    visits = slice(look_ahead + 1)
    return LocalModel(
        motions=map_.motions,
        look_ahead=look_ahead,
        places=cut.places,
        belief=q,
        A=A,
        multiplicity=multiplicity,
        log_C=log_C,
        log_C_place=preferences.log_C_place(cut.places),
        B=cut.B,
        blocked=cut.blocked,
        collision_cost=preferences.collision_cost,
        information={
            "sight": seen.sights[:, visits],
            "position": seen.positions[:, visits],
            "transition": cut.ways[:, visits],
        },
        successor=cut.successor,
        entered=cut.entered,
        position=seen.position,
        discount=discount,
        information_weight=information_weight,
        dropped=dropped,
        structure=apart,
        senses=tuple(_sights(table, within, Preferences())[0] for table in others),
        looks="open" in map_.sensors and len(within) <= FEW,
        costs=costs,
        frontier=frontier,
        prices=prices,
        kept=cut.kept,
        untried=cut.untried,
    )


def _cut(
    map_: MapView, cache: LocalCache, places: Ints, within: Ints, open_: Sequence[bool], unseen: Sequence[bool]
) -> Cut:
    """What `within` has of ways, those of `places` as they are sensed."""
    at, rows = within.searchsorted(places), cache.ways(within)
    entered = np.zeros(len(within) + 1, dtype=np.bool_)
    entered[:-1] = map_.visited[within]
    tries = _unseen(cache, rows, within, unseen)
    _sense(rows, within, at, open_, tries)
    rows.blocked[:, map_.motions.stay] = 0.0
    if not entered[:-1].all():
        leave_out_dormant(map_, within, rows, entered[:-1])
    B, successor = _transitions(within, rows, map_.motions.stay)
    return Cut(np.append(within, ELSEWHERE), at, entered, B, successor, rows.blocked, rows.ways, tries, Kept())


def _unseen(cache: LocalCache, rows: WayRows, places: Ints, unseen: Sequence[bool]) -> Floats | None:
    """What the first step along each way teaches, of ways of which no sensor tells; None where that is nothing.

    There no look at a place teaches anything, and plans count on such a way though it is as likely shut.
    """
    if not any(unseen):
        return None
    tries = cache.tries(places)
    tries[:, ~np.array(unseen, dtype=np.bool_)] = 0.0
    for row, action in np.argwhere(tries > 0.0).tolist():
        rows.ways[row] -= cache.looks(int(places[row]), action)
        keys, p = rows.successors[row, action], rows.probability[row, action]
        beyond = np.where((keys >= 0) & (keys != places[row]), p, 0.0)
        if beyond.max() >= HOPE:
            rows.likely[row, action] = keys[beyond.argmax()]
    return tries if tries.any() else None


def _likeliest_starts(places: Ints, belief: Floats, most: int) -> tuple[Ints, Floats, float]:
    """The likeliest places, ascending, their share of the belief, and the belief in the others."""
    if len(places) <= most:
        return places, belief, 0.0
    # of equals, some from everywhere: places with near numbers are near each other, and look alike
    order = np.lexsort((np.arange(len(places)) * 0.6180339887498949 % 1.0, -belief))
    kept = np.sort(order[:most])
    mass = float(belief[kept].sum())
    return places[kept], belief[kept] / mass, max(float(belief.sum()) - mass, 0.0)


def _sights(table: SparseDirichlet, places: Ints, preferences: Preferences) -> tuple[Floats, Floats, Floats]:
    """A of a sensor over the outcomes that places (or preferences) tell apart, and one row for all the rest."""
    keys, p, other = table.mean(places)
    preferred, log_preferred, log_other = preferences.log_C(table.outcomes)
    row, slot = np.nonzero(keys >= 0)
    outcomes, index = distinct(np.concatenate([keys[row, slot], preferred]))
    apart, total = len(outcomes), table.outcomes
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


def _sense(rows: WayRows, places: Ints, sensing: Ints, open_: Sequence[bool], tries: Floats | None) -> None:
    """Let the ways of `sensing` be as they are sensed now: shut, or not the place itself beyond.

    Ways that nobody has looked at stay as the map has them.
    """
    here, shut = places[sensing], ~np.array(open_, dtype=np.bool_)
    keys, p = rows.successors[sensing], rows.probability[sensing]
    old_keys, old_p = keys.copy(), p
    own = keys == here[:, None, None]
    beyond = (p * ~own).sum(axis=2, keepdims=True)
    p = np.where(own & (beyond > 0.0), 0.0, p / np.where(beyond > 0.0, beyond, 1.0))
    keys[:, shut], p[:, shut] = EMPTY, 0.0
    keys[:, shut, 0], p[:, shut, 0] = here[:, None], 1.0
    untried = None if tries is None else tries[sensing] > 0.0
    if untried is not None:
        keys, p = np.where(untried[..., None], old_keys, keys), np.where(untried[..., None], old_p, p)
    rows.successors[sensing], rows.probability[sensing] = keys, p
    likely, rows.blocked[sensing] = likeliest(keys, p, here, ELSEWHERE)
    rows.likely[sensing] = likely if untried is None else np.where(untried, rows.likely[sensing], likely)


def _transitions(places: Ints, rows: WayRows, stay: int) -> tuple[Transitions, Ints]:
    """B and the likeliest successors over `places` and, last, everywhere never imagined, which leads to itself."""
    size = len(places)
    rows.successors[-1], rows.probability[-1, :, 0] = ELSEWHERE, 1.0
    rows.likely[-1] = ELSEWHERE
    successor = np.where(rows.likely >= 0, _local(places, rows.likely), -1)
    successor[:-1, stay] = np.arange(size)
    return Transitions(_local(places, rows.successors), rows.probability), successor


def _local(places: Ints, keys: Ints) -> Ints:
    """Places of the map by their local number, the last for one never imagined.

    One that is not in the model becomes the place that leads to it (the first axis): no policy is meant to go there.
    """
    size = len(places)
    at = places.searchsorted(keys)
    at[at == size] = 0
    here = np.arange(len(keys)).reshape(-1, *(1,) * (keys.ndim - 1))
    return np.where(places[at] == keys, at, np.where(keys == ELSEWHERE, size, here))
