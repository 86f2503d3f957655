"""Policy generators: counts, uniqueness, and what the map-guided one must find."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from cogmap.model import Motions
from cogmap.model.errors import CogmapError
from cogmap.planning import (
    POLICIES,
    Exhaustive,
    LocalModel,
    LShaped,
    MapGuided,
    Planner,
    Policies,
    PolicyGenerator,
    SelfAvoiding,
    evaluate,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from local_models import GRID, LINE, grid_model, random_model

SQUARE = [(i, j) for i in range(4) for j in range(4)]
HALL = [(0, j) for j in range(12)]
STAY = GRID.stay


def walk(model: LocalModel, policy: np.ndarray, start: int) -> list[int]:
    """The places that a policy leads to on the map, without stays; stops where nothing is known."""
    track = [start]
    for action in policy.tolist():
        if action != model.motions.stay:
            if model.successor[track[-1], action] < 0:
                break
            track.append(int(model.successor[track[-1], action]))
    return track


def with_value(model: LocalModel, value: np.ndarray) -> LocalModel:
    """A first visit of each place teaches so much."""
    sight = np.where(np.arange(model.look_ahead + 1) > 0, value[:, None], 0.0)
    return replace(model, information={**model.information, "sight": sight})


def unique(policies: Policies) -> bool:
    return len(np.unique(policies.actions, axis=0)) == len(policies)


@pytest.mark.parametrize(("look_ahead", "walks"), [(1, 5), (2, 17), (3, 53), (4, 153), (5, 437), (6, 1217), (7, 3389)])
def test_counts_in_the_grid(look_ahead: int, walks: int) -> None:
    model = replace(random_model(0), look_ahead=look_ahead)
    assert SelfAvoiding().make(model).actions.shape == (walks, look_ahead)
    assert LShaped().make(model).actions.shape == (4 * look_ahead**2 + 1, look_ahead)
    if look_ahead < 6:
        assert Exhaustive().make(model).actions.shape == (5**look_ahead, look_ahead)


def test_counts_on_a_line() -> None:
    model = random_model(0, motions=LINE, look_ahead=5)
    assert len(SelfAvoiding().make(model)) == len(LShaped().make(model)) == 11
    assert len(Exhaustive().make(model)) == 3**5


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from(sorted(POLICIES)), st.integers(1, 4), st.booleans())
def test_rows_are_unique_actions_that_may_stay(seed: int, name: str, look_ahead: int, sparse: bool) -> None:
    model = replace(random_model(seed, sparse=sparse), look_ahead=look_ahead)
    policies = POLICIES[name]().make(model)
    assert unique(policies)
    assert policies.actions.shape[1] >= look_ahead
    assert policies.actions.min() >= 0
    assert policies.actions.max() < len(model.motions)
    assert (policies.actions == model.motions.stay).all(1).sum() == 1
    assert policies.cut == 0 or name == "map_guided"


def test_self_avoiding_never_returns() -> None:
    for policy in SelfAvoiding().make(replace(random_model(0), look_ahead=5)).actions.tolist():
        moves = [a for a in policy if a != STAY]
        assert policy == moves + [STAY] * (5 - len(moves))
        track = np.cumsum([(0, 0), *(GRID.displacements[a] for a in moves)], axis=0)
        assert len(np.unique(track, axis=0)) == len(track)


def test_shared_policies_cannot_be_written_to() -> None:
    for generator in (Exhaustive(), SelfAvoiding(), LShaped()):
        with pytest.raises(ValueError, match="read-only"):
            generator.make(random_model(0)).actions[0, 0] = 3


@pytest.mark.parametrize("name", sorted(POLICIES))
@pytest.mark.parametrize("look_ahead", [0, 1001])
def test_look_ahead_out_of_bounds(name: str, look_ahead: int) -> None:
    with pytest.raises(CogmapError, match=f"{name}: look_ahead is {look_ahead}; give 1 to 1,000"):
        POLICIES[name]().make(replace(random_model(0), look_ahead=look_ahead))


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from(sorted(POLICIES)), st.integers(1, 4), st.sampled_from([GRID, LINE]))
def test_no_more_policies_than_were_counted_before(seed: int, name: str, look_ahead: int, motions: Motions) -> None:
    model = random_model(seed, motions=motions, look_ahead=look_ahead)
    made, most = len(POLICIES[name]().make(model)), POLICIES[name]().count(motions, look_ahead)
    assert made <= most
    assert made == most or name in ("map_guided", "self_avoiding")


@pytest.mark.parametrize(("generator", "look_ahead"), [(Exhaustive(), 10), (SelfAvoiding(), 14), (LShaped(), 999)])
def test_too_many_policies_are_refused_before_they_are_made(generator: PolicyGenerator, look_ahead: int) -> None:
    with pytest.raises(CogmapError, match=f"{generator.name}: .* policies at look-ahead {look_ahead}.*map_guided"):
        Planner(policies=generator).check(GRID, look_ahead)


@pytest.mark.parametrize("beam", [0, -3, 2.5, "wide"])
def test_a_beam_must_be_a_whole_number(beam: Any) -> None:
    with pytest.raises(CogmapError, match="map_guided: beam"):
        MapGuided(beam=beam)


@pytest.mark.parametrize("actions", [np.zeros((0, 3), int), np.zeros(3, int), np.zeros((2, 2))])
def test_policies_must_be_rows_of_integers(actions: np.ndarray) -> None:
    with pytest.raises(CogmapError, match="policies"):
        Policies(actions)


def test_walks_keep_to_open_ways() -> None:
    closed = [((1, 1), (1, 2)), ((2, 1), (3, 1))]
    model = grid_model(SQUARE, visited=SQUARE, at=(1, 1), closed=closed, goal=(3, 3))
    for policy in MapGuided().make(model).actions:
        assert len(walk(model, policy, 5)) == 1 + int((policy != STAY).sum())


def test_dead_end_is_left_by_the_way_it_was_entered() -> None:
    # a hall of three with a nook above its middle: whatever the order, one step must be retraced
    rooms = [(1, 0), (1, 1), (1, 2), (0, 1)]
    model = grid_model(rooms, visited=[(1, 1)], at=(1, 1), look_ahead=5)
    ends = {frozenset(walk(model, policy, 1)) for policy in MapGuided().make(model).actions}
    assert frozenset({0, 1, 2, 3}) in ends


@pytest.mark.parametrize("seed", range(12))
def test_close_to_the_best_of_all_sequences(seed: int) -> None:
    rng = np.random.default_rng(seed)
    visited = {SQUARE[i] for i in rng.choice(16, 6, replace=False)}
    closed = [((i, j), (i + 1, j)) for i, j in SQUARE if rng.random() < 0.2]
    at = sorted(visited)[0]
    goal = (3, 3) if seed % 2 else None
    model = grid_model(SQUARE, visited=visited, at=at, look_ahead=5, closed=closed, goal=goal)
    ours, all_of_them = (
        evaluate(model, MapGuided().make(model)).G.min(),
        evaluate(model, Exhaustive().make(model)).G.min(),
    )
    assert ours <= all_of_them + 0.2


def test_prefixes_that_lead_to_the_same_are_merged() -> None:
    model = grid_model(SQUARE, visited=SQUARE, at=(0, 0), goal=(3, 3))
    policies = MapGuided().make(model)
    assert policies.cut == 0
    arrivals = [p for p in policies.actions if walk(model, p, 0)[-1] == 15 and len(set(walk(model, p, 0))) == 7]
    assert len(arrivals) == 1
    assert len(policies) < len(SelfAvoiding().make(model)) / 10


def test_beam_bounds_and_reports() -> None:
    model = grid_model(SQUARE, visited=SQUARE[::2], at=(0, 0), look_ahead=6)
    narrow, wide = MapGuided(beam=2).make(model), MapGuided(beam=500).make(model)
    assert narrow.cut > 0
    assert wide.cut == 0
    assert len(narrow) < len(wide)


def test_what_is_far_is_headed_for() -> None:
    model = grid_model(HALL, visited=HALL[:-1], at=(0, 0), look_ahead=3)
    policies = MapGuided().make(model)
    assert policies.actions.shape[1] == 11
    assert any(walk(model, policy, 0)[-1] == 11 for policy in policies.actions)
    near = MapGuided().make(grid_model(HALL, visited=HALL[:-1], at=(0, 9), look_ahead=3))
    assert near.actions.shape[1] == 3


@pytest.mark.parametrize("nearby", [0.2, 0.6])
def test_a_small_value_nearby_does_not_hide_a_greater_one_beyond(nearby: float) -> None:
    model = grid_model(HALL, visited=HALL, at=(0, 0), look_ahead=3)
    worth = np.zeros(12)
    worth[[2, 7, 11]] = nearby, nearby, 1.0
    ahead = MapGuided().make(with_value(model, worth)).actions
    assert ahead.shape[1] == 11
    worth[11] = nearby
    assert MapGuided().make(with_value(model, worth)).actions.shape[1] == 3


def test_where_nothing_is_to_be_had_one_shortest_path_a_place_is_left() -> None:
    model = grid_model(SQUARE, visited=SQUARE, at=(1, 1), look_ahead=6)
    policies = MapGuided().make(with_value(model, np.zeros(16)))
    ends = [walk(model, policy, 5)[-1] for policy in policies.actions]
    assert sorted(ends) == list(range(16))


def test_each_place_the_agent_may_be_at_gets_policies() -> None:
    model = grid_model(HALL, visited=HALL[:-1], at=(0, 0), look_ahead=3)
    belief = np.zeros(12)
    belief[[1, 9]] = 0.5
    both = {tuple(row) for row in MapGuided().make(replace(model, belief=belief)).actions[:, :3].tolist()}
    for place in (1, 9):
        alone = MapGuided().make(replace(model, belief=np.eye(12)[place])).actions[:, :3]
        assert {tuple(row) for row in alone.tolist()} <= both
    even = MapGuided().make(replace(model, belief=np.full(12, 1 / 12)))
    assert unique(even)


def test_unknown_ways_are_tried_only_as_the_last_step() -> None:
    model = grid_model([(0, 0), (0, 1)], visited=[(0, 0)], at=(0, 0), look_ahead=3)
    rows = {tuple(row) for row in MapGuided().make(model).actions.tolist()}
    up, down, left, right = range(4)
    assert {(right, up, STAY), (right, down, STAY), (right, right, STAY)} <= rows
    assert not any(row[0] in (up, down, left) for row in rows)


def test_a_way_that_no_look_tells_of_is_worth_a_step_along_it() -> None:
    model = grid_model(HALL, visited=HALL, at=(0, 0), look_ahead=3)
    for place in (1, 9):  # one within look-ahead, one beyond
        untried = np.zeros(model.blocked.shape)
        untried[place, 1] = 0.6
        asked = replace(model, untried=untried)
        policies = MapGuided().make(asked)
        told = evaluate(asked, policies)["transition_information"] - evaluate(model, policies)["transition_information"]
        best = policies.actions[told.argmax()]
        assert told.max() == pytest.approx(0.6 * model.discount**place, rel=0.5)
        assert walk(asked, best[:place], 0)[-1] == place
        assert best[place] == 1


def test_paths_avoid_places_that_are_not_wanted() -> None:
    # two shortest ways around the corner, one through a place that is disliked
    model = grid_model([(0, 0), (0, 1), (1, 0), (1, 1)], visited=SQUARE, at=(0, 0), look_ahead=2, goal=(1, 1))
    for disliked in (1, 2):
        log_C = model.log_C.copy()
        log_C[disliked] = -2.0
        policies = MapGuided().make(replace(model, log_C=log_C))
        tracks = [walk(model, policy, 0) for policy in policies.actions]
        assert [0, 3 - disliked, 3] in tracks
        assert [0, disliked, 3] not in tracks
