"""The slices of eq. 1 in the language of factor graphs, over the support of the belief."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .cognitive_map import CognitiveMap
from .distinct import distinct
from .graph import FactorGraph

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Slice:
    """One time step of the window: domains over the support, and the tables as they were at that step.

    `n` places and `m` positions hold mass at this step, `n'` and `m'` at the step before.

    Attributes:
        step: the time step t.
        action: index of the action that led here; None at the first step.
        sight: label of the sight o_t.
        open: for each action, whether its way was sensed open.
        places: `[n]` domain of s_t, by number.
        positions: `[m]` domain of p_t, by number.
        joint: `[n, m]` filtered Q(s_t, p_t).
        transition: `[n, n']` B_s[a](s_t, s_t-1), times `found_shut`.
        motion: `[m, m']` B_p[a](p_t, p_t-1).
        place: `[m, n]` A_p(p_t, s_t).
        sight_likelihood: `[n]` A_o[o_t, :](s_t).
        doors_likelihood: `[n]` c_t(s_t).
        arrival: `[n]` P(s_t | moved): uniform over the visited places.
        displacement: P(moved_t = False), P(moved_t = True); the second is zero where the filter did not look,
            since it would have dropped all of it.
    """

    step: int
    action: int | None
    sight: Hashable
    open: tuple[bool, ...]
    places: Ints
    positions: Ints
    joint: Floats
    transition: Floats
    motion: Floats
    place: Floats
    sight_likelihood: Floats
    doors_likelihood: Floats
    arrival: Floats
    displacement: tuple[float, float]


def take_slice(
    map_: CognitiveMap,
    before: Slice | None,
    joint: tuple[Ints, Ints, Floats],
    factors: Floats,
    *,
    step: int,
    action: int | None,
    was_open: bool,
    sight: int,
    open_: Sequence[bool],
    slip: float,
    displacement: tuple[float, float],
) -> Slice:
    """Snapshot of the tables over the support of the filtered `joint`, places, positions and masses of its `k` pairs.

    P(o_t | s_t) and P(c_t | s_t) of each pair, `factors [k, 2]`, are those that it was filtered with.
    """
    (places, place_at), (positions, position_at) = distinct(joint[0]), distinct(joint[1])
    table = np.zeros((len(places), len(positions)))
    table[place_at, position_at] = joint[2]
    told = np.empty((len(places), 2))
    told[place_at] = factors
    transition, motion = np.zeros((len(places), 0)), np.zeros((len(positions), 0))
    if before is not None and action is not None:
        keys, p, _ = map_.B_s.mean(map_.rows(before.places, action))
        p *= found_shut(map_, before.places, keys, p, action, open_, slip=slip if was_open else 1.0 - slip)
        transition = _looked_up(places, keys, p)
        motion = _motion(map_, positions, before, action, was_open, slip)
    return Slice(
        step=step,
        action=action,
        sight=map_.sights[sight],
        open=tuple(map(bool, open_)),
        places=places,
        positions=positions,
        joint=table,
        transition=transition,
        motion=motion,
        place=_looked_up(positions, *map_.A_p.mean(places)[:2]),
        sight_likelihood=told[:, 0],
        doors_likelihood=told[:, 1],
        arrival=map_.visited[places] / max(len(map_.visited_places), 1),
        displacement=displacement,
    )


def _looked_up(outcomes: Ints, keys: Ints, p: Floats) -> Floats:
    """`[m, n]` probability of `outcomes [m]` in rows that give `p [n, k]` to the outcomes `keys [n, k]`."""
    return np.einsum("jk,ijk->ij", p, keys == outcomes[:, None, None])


def found_shut(
    map_: CognitiveMap, places: Ints, keys: Ints, p: Floats, action: int, open_: Sequence[bool], *, slip: float
) -> Floats:
    """`[n, k]` what the factors of this step are multiplied by for having come from s_t-1 to s_t.

    Who did not get through a door, and now senses it shut, has one thing to explain, not three: that the place is the
    same, that the position is, and that the door is shut. The less probable of the first two stays, the others are
    taken out again.

    Args:
        map_: the map.
        places: `[n]` s_t-1.
        keys: `[n, k]` s_t.
        p: `[n, k]` B_s[a](s_t, s_t-1).
        action: a.
        open_: for each action, whether its way is sensed open at t.
        slip: probability that the position stays.
    """
    factor = np.ones(keys.shape)
    if not open_[action]:
        others = map_.blocked(places)[:, action, None] * np.maximum(p, slip)
        np.divide(1.0, others, out=factor, where=(keys == places[:, None]) & (others > 0.0))
    return factor


def _motion(map_: CognitiveMap, positions: Ints, before: Slice, action: int, was_open: bool, slip: float) -> Floats:
    moves = 1.0 - slip if was_open else slip
    if action == map_.motions.stay:
        moves = 1.0
    ahead = map_.position_beyond[before.positions, action]
    stays = positions[:, None] == before.positions[None, :]
    return moves * (positions[:, None] == ahead[None, :]) + (1.0 - moves) * stays


def window_graph(map_: CognitiveMap, window: Sequence[Slice]) -> FactorGraph:
    """The factor graph of a window of consecutive slices (eq. 1); the first gives the prior its filtered joint.

    Variables, for each step t: `s{t}` (places), `p{t}` (positions), and, but for the first, `moved{t}`, and the
    observed `o{t}` (sight) and `c{t}` (doors).
    """
    graph = FactorGraph()
    for at, slice_ in enumerate(window):
        t = slice_.step
        graph.variable(f"s{t}", slice_.places.tolist(), time=t)
        graph.variable(f"p{t}", [map_.positions[i] for i in slice_.positions.tolist()], time=t)
        if at == 0:
            equation = "Q(s, p) of the step that left the window"
            graph.factor("Q", [f"s{t}", f"p{t}"], slice_.joint, kind="prior", equation=equation)
        else:
            _emit(graph, slice_, f"[{map_.motions.names[slice_.action or 0]}]")
    return graph


def _emit(graph: FactorGraph, slice_: Slice, action: str) -> None:
    t = slice_.step
    s, p, moved, o, c = (f"{name}{t}" for name in ("s", "p", "moved", "o", "c"))
    s_before, p_before = f"s{t - 1}", f"p{t - 1}"
    graph.variable(moved, (False, True), time=t)
    graph.variable(o, (slice_.sight,), time=t, observed=True)
    graph.variable(c, (slice_.open,), time=t, observed=True)
    arrival = np.broadcast_to(slice_.arrival[:, None], slice_.transition.shape)
    transition = np.stack([slice_.transition, arrival], axis=-1)
    motion = np.stack([slice_.motion, np.ones_like(slice_.motion)], axis=-1)
    graph.factor("M", [moved], slice_.displacement, kind="displacement", equation="P(moved_t)")
    equation = "P(s_t | s_t-1, a_t-1, moved_t)"
    graph.factor(f"B_s{action}", [s, s_before, moved], transition, kind="transition", equation=equation)
    equation = "P(p_t | p_t-1, a_t-1, moved_t)"
    graph.factor(f"B_p{action}", [p, p_before, moved], motion, kind="motion", equation=equation)
    graph.factor("A_p", [p, s], slice_.place, kind="place", equation="P(p_t | s_t)")
    graph.factor("A_o", [o, s], slice_.sight_likelihood[None], kind="sight", equation="P(o_t | s_t)")
    graph.factor("c", [c, s], slice_.doors_likelihood[None], kind="walls", equation="P(c_t | s_t)")
