"""Policy generators: counts, uniqueness, and what the map-guided one must find."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from cogmap.model.errors import CogmapError
from cogmap.planning import (
    GENERATORS,
    Policies,
    Reach,
    evaluate,
    exhaustive,
    l_shaped,
    map_guided,
    self_avoiding,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from reaches import GRID, LINE, grid_reach, random_reach

SQUARE = [(i, j) for i in range(4) for j in range(4)]
HALL = [(0, j) for j in range(12)]
STAY = GRID.stay


def walk(reach: Reach, policy: np.ndarray, start: int) -> list[int]:
    """The places that a policy leads to on the map, without stays; stops where nothing is known."""
    track = [start]
    for action in policy.tolist():
        if action != reach.motions.stay:
            if reach.successor[track[-1], action] < 0:
                break
            track.append(int(reach.successor[track[-1], action]))
    return track


def unique(policies: Policies) -> bool:
    return len(np.unique(policies.actions, axis=0)) == len(policies)


@pytest.mark.parametrize(("look_ahead", "walks"), [(1, 5), (2, 17), (3, 53), (4, 153), (5, 437), (6, 1217), (7, 3389)])
def test_counts_in_the_grid(look_ahead: int, walks: int) -> None:
    reach = replace(random_reach(0), look_ahead=look_ahead)
    assert self_avoiding(reach).actions.shape == (walks, look_ahead)
    assert l_shaped(reach).actions.shape == (4 * look_ahead**2 + 1, look_ahead)
    if look_ahead < 6:
        assert exhaustive(reach).actions.shape == (5**look_ahead, look_ahead)


def test_counts_on_a_line() -> None:
    reach = random_reach(0, motions=LINE, look_ahead=5)
    assert len(self_avoiding(reach)) == len(l_shaped(reach)) == 11
    assert len(exhaustive(reach)) == 3**5


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from(sorted(GENERATORS)), st.integers(1, 4), st.booleans())
def test_rows_are_unique_actions_that_may_stay(seed: int, name: str, look_ahead: int, sparse: bool) -> None:
    reach = replace(random_reach(seed, sparse=sparse), look_ahead=look_ahead)
    policies = GENERATORS[name](reach)
    assert unique(policies)
    assert policies.actions.shape[1] >= look_ahead
    assert policies.actions.min() >= 0
    assert policies.actions.max() < len(reach.motions)
    assert (policies.actions == reach.motions.stay).all(1).sum() == 1
    assert policies.cut == 0 or name == "map_guided"


def test_self_avoiding_never_returns() -> None:
    for policy in self_avoiding(replace(random_reach(0), look_ahead=5)).actions.tolist():
        moves = [a for a in policy if a != STAY]
        assert policy == moves + [STAY] * (5 - len(moves))
        track = np.cumsum([(0, 0), *(GRID.displacements[a] for a in moves)], axis=0)
        assert len(np.unique(track, axis=0)) == len(track)


def test_shared_policies_cannot_be_written_to() -> None:
    for generate in (exhaustive, self_avoiding, l_shaped):
        with pytest.raises(ValueError, match="read-only"):
            generate(random_reach(0)).actions[0, 0] = 3


@pytest.mark.parametrize("name", sorted(GENERATORS))
def test_no_look_ahead(name: str) -> None:
    with pytest.raises(CogmapError, match="look_ahead"):
        GENERATORS[name](replace(random_reach(0), look_ahead=0))


def test_too_many_policies() -> None:
    with pytest.raises(CogmapError, match="map_guided"):
        exhaustive(replace(random_reach(0), look_ahead=14))
    with pytest.raises(CogmapError, match="beam"):
        map_guided(random_reach(0), beam=0)


@pytest.mark.parametrize("actions", [np.zeros((0, 3), int), np.zeros(3, int), np.zeros((2, 2))])
def test_policies_must_be_rows_of_integers(actions: np.ndarray) -> None:
    with pytest.raises(CogmapError, match="policies"):
        Policies(actions)


def test_walks_keep_to_open_ways() -> None:
    closed = [((1, 1), (1, 2)), ((2, 1), (3, 1))]
    reach = grid_reach(SQUARE, visited=SQUARE, at=(1, 1), closed=closed, goal=(3, 3))
    for policy in map_guided(reach).actions:
        assert len(walk(reach, policy, 5)) == 1 + int((policy != STAY).sum())


def test_dead_end_is_left_by_the_way_it_was_entered() -> None:
    # a hall of three with a nook above its middle: whatever the order, one step must be retraced
    rooms = [(1, 0), (1, 1), (1, 2), (0, 1)]
    reach = grid_reach(rooms, visited=[(1, 1)], at=(1, 1), look_ahead=5)
    ends = {frozenset(walk(reach, policy, 1)) for policy in map_guided(reach).actions}
    assert frozenset({0, 1, 2, 3}) in ends


@pytest.mark.parametrize("seed", range(12))
def test_close_to_the_best_of_all_sequences(seed: int) -> None:
    rng = np.random.default_rng(seed)
    visited = {SQUARE[i] for i in rng.choice(16, 6, replace=False)}
    closed = [((i, j), (i + 1, j)) for i, j in SQUARE if rng.random() < 0.2]
    at = sorted(visited)[0]
    goal = (3, 3) if seed % 2 else None
    reach = grid_reach(SQUARE, visited=visited, at=at, look_ahead=5, closed=closed, goal=goal)
    ours, all_of_them = evaluate(reach, map_guided(reach)).G.min(), evaluate(reach, exhaustive(reach)).G.min()
    assert ours <= all_of_them + 0.2


def test_prefixes_that_lead_to_the_same_are_merged() -> None:
    reach = grid_reach(SQUARE, visited=SQUARE, at=(0, 0), goal=(3, 3))
    policies = map_guided(reach)
    assert policies.cut == 0
    arrivals = [p for p in policies.actions if walk(reach, p, 0)[-1] == 15 and len(set(walk(reach, p, 0))) == 7]
    assert len(arrivals) == 1
    assert len(policies) < len(self_avoiding(reach)) / 10


def test_beam_bounds_and_reports() -> None:
    reach = grid_reach(SQUARE, visited=SQUARE[::2], at=(0, 0), look_ahead=6)
    narrow, wide = map_guided(reach, beam=2), map_guided(reach, beam=500)
    assert narrow.cut > 0
    assert wide.cut == 0
    assert len(narrow) < len(wide)


def test_far_promise_is_headed_for() -> None:
    reach = grid_reach(HALL, visited=HALL[:-1], at=(0, 0), look_ahead=3)
    policies = map_guided(reach)
    assert policies.actions.shape[1] == 11
    assert any(walk(reach, policy, 0)[-1] == 11 for policy in policies.actions)
    near = map_guided(grid_reach(HALL, visited=HALL[:-1], at=(0, 9), look_ahead=3))
    assert near.actions.shape[1] == 3


@pytest.mark.parametrize(("nearby", "length"), [(0.2, 11), (0.6, 3)])
def test_small_promise_nearby_does_not_hide_a_great_one_beyond(nearby: float, length: int) -> None:
    reach = grid_reach(HALL, visited=HALL, at=(0, 0), look_ahead=3)
    promise = np.zeros(12)
    promise[[2, 11]] = nearby, 1.0
    assert map_guided(replace(reach, promise=promise)).actions.shape[1] == length


def test_where_nothing_is_promised_one_shortest_path_a_place_is_left() -> None:
    reach = grid_reach(SQUARE, visited=SQUARE, at=(1, 1), look_ahead=6)
    policies = map_guided(replace(reach, promise=np.zeros(16)))
    ends = [walk(reach, policy, 5)[-1] for policy in policies.actions]
    assert sorted(ends) == list(range(16))


def test_each_place_the_agent_may_be_at_gets_policies() -> None:
    reach = grid_reach(HALL, visited=HALL[:-1], at=(0, 0), look_ahead=3)
    belief = np.zeros(12)
    belief[[1, 9]] = 0.5
    both = {tuple(row) for row in map_guided(replace(reach, belief=belief)).actions[:, :3].tolist()}
    for place in (1, 9):
        alone = map_guided(replace(reach, belief=np.eye(12)[place])).actions[:, :3]
        assert {tuple(row) for row in alone.tolist()} <= both
    even = map_guided(replace(reach, belief=np.full(12, 1 / 12)))
    assert unique(even)


def test_unknown_ways_are_tried_only_as_the_last_step() -> None:
    reach = grid_reach([(0, 0), (0, 1)], visited=[(0, 0)], at=(0, 0), look_ahead=3)
    rows = {tuple(row) for row in map_guided(reach).actions.tolist()}
    up, down, left, right = range(4)
    assert {(right, up, STAY), (right, down, STAY), (right, right, STAY)} <= rows
    assert not any(row[0] in (up, down, left) for row in rows)


def test_paths_avoid_places_that_are_not_wanted() -> None:
    # two shortest ways around the corner, one through a place that is disliked
    reach = grid_reach([(0, 0), (0, 1), (1, 0), (1, 1)], visited=SQUARE, at=(0, 0), look_ahead=2, goal=(1, 1))
    for disliked in (1, 2):
        log_C = reach.log_C.copy()
        log_C[disliked] = -2.0
        policies = map_guided(replace(reach, log_C=log_C))
        tracks = [walk(reach, policy, 0) for policy in policies.actions]
        assert [0, 3 - disliked, 3] in tracks
        assert [0, disliked, 3] not in tracks
