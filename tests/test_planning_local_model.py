"""What of the map a plan takes in."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from cogmap.agent import Settings
from cogmap.model import CogmapError, CognitiveMap, Motions
from cogmap.planning import (
    LocalCache,
    LocalModel,
    MapGuided,
    Planner,
    Preferences,
    Transitions,
    local_model,
)
from cogmap.planning.local.transitions import likeliest
from local_models import LINE, random_model

STARTS = Settings().starts

BACK, ON, STAY = 0, 1, 2
OPEN = (True, True, True)


def corridor(rooms: int, *, unvisited: int | None = None) -> CognitiveMap:
    """Known rooms in a row, number and position alike; `unvisited` was never entered."""
    map_ = CognitiveMap(LINE)
    sight = map_.sensors["sight"].read("grey", step=0)
    for room in range(rooms):
        map_.new_place((room,), step=0)
    for room in range(rooms):
        for action, beyond in ((BACK, room - 1), (ON, room + 1)):
            map_.B_s.add(map_.row(room, action), beyond if 0 <= beyond < rooms else room, 30.0)
        if room != unvisited:
            map_.mark_visited(room)
            map_.A_o.add(room, sight, 30.0)
    return map_


def model_of(
    map_: CognitiveMap, at: int, preferences: Preferences | None = None, cache: LocalCache | None = None
) -> LocalModel:
    return local_model(
        map_,
        np.array([at]),
        np.ones(1),
        open_=OPEN,
        look_ahead=3,
        preferences=preferences,
        cache=cache,
        beyond=MapGuided().beyond,
    )


def rooms_of(model: LocalModel) -> list[int]:
    return [place for place in model.places.tolist() if place >= 0]


def test_where_nothing_promises_anything_a_plan_stays_within_look_ahead() -> None:
    model = model_of(corridor(50), 20)
    assert rooms_of(model) == list(range(17, 24))
    model.check()
    assert MapGuided().make(model).actions.shape[1] == 3  # the rim is known, not a way into the unknown


@pytest.mark.parametrize("preferred", [False, True])
def test_only_the_way_to_the_nearest_promising_place_goes_beyond_look_ahead(preferred: bool) -> None:
    map_ = corridor(50, unvisited=None if preferred else 30)
    model = model_of(map_, 20, Preferences(places={30: 5.0} if preferred else {}))
    assert rooms_of(model) == list(range(17, 31))
    model.check()
    chosen = Planner().decide(model, rng=np.random.default_rng(0))
    assert chosen.names == ["on"] * 10


def test_a_sight_never_met_is_no_reason_to_search_a_map_that_is_known() -> None:
    asked: list[int] = []

    class Asked(LocalCache):
        def likely(self, places: np.ndarray) -> np.ndarray:
            asked.extend(places.tolist())
            return super().likely(places)

    map_ = corridor(50)
    for hoped in ({-1: 5.0}, {7: 5.0}):
        model = model_of(map_, 20, Preferences(sights=hoped), Asked(map_, 3))
        assert rooms_of(model) == list(range(17, 24))
        assert sorted(asked) == ([] if -1 in hoped else [room for room in range(50) if room != 20])


def test_a_cache_that_does_not_fit_and_no_start_at_all_are_refused() -> None:
    map_ = corridor(9)
    options = {"open_": OPEN, "look_ahead": 3}
    for cache, message in (
        (LocalCache(map_, 2), "tells of 2 visits; make one for 3"),
        (LocalCache(corridor(9), 3), "another"),
    ):
        with pytest.raises(CogmapError, match=message):
            local_model(map_, np.array([4]), np.ones(1), cache=cache, **options)
    with pytest.raises(CogmapError, match="starts is 0; give 1 or more"):
        local_model(map_, np.array([4]), np.ones(1), starts=0, **options)
    longer = local_model(map_, np.array([4]), np.ones(1), cache=LocalCache(map_, 5), **options)
    longer.check()
    plain = local_model(map_, np.array([4]), np.ones(1), **options)
    np.testing.assert_array_equal(longer.information["sight"], plain.information["sight"])


@pytest.mark.parametrize(("worth", "rooms"), [(0.5, 24), (50.0, 41)])
def test_what_is_near_hides_only_what_is_worth_no_more(worth: float, rooms: int) -> None:
    map_ = corridor(50, unvisited=22)
    assert rooms_of(model_of(map_, 20, Preferences(places={40: worth}))) == list(range(17, rooms))


def test_a_goal_within_look_ahead_behind_a_shut_door_does_not_hide_the_way_round() -> None:
    ring = CognitiveMap(Motions(("on", "back", "stay"), ((1,), (-1,), (0,))))
    for room in range(12):
        ring.new_place((room,), step=0)
        ring.mark_visited(room)
    for room in range(12):
        ring.B_s.add(ring.row(room, 0), (room + 1) % 12, 30.0)
        ring.B_s.add(ring.row(room, 1), (room - 1) % 12, 30.0)
    plan = Planner().plan(
        ring,
        np.array([0]),
        np.ones(1),
        open_=(False, True, True),
        look_ahead=4,
        rng=np.random.default_rng(0),
        preferences=Preferences(places={2: 3.0}),
    )
    assert plan.names == ["back"] * 10
    assert plan.places[:-1].tolist() == list(range(12))


def test_a_goal_hundreds_of_steps_away_is_set_out_for() -> None:
    map_ = corridor(700)
    plan = Planner().plan(
        map_,
        np.array([20]),
        np.ones(1),
        open_=OPEN,
        look_ahead=3,
        rng=np.random.default_rng(0),
        preferences=Preferences(places={620: 2.0}),
        discount=0.95,
    )
    assert plan.names == ["on"] * 600


def test_a_shut_door_is_no_way_to_a_promising_place() -> None:
    map_ = corridor(50, unvisited=30)
    map_.B_s.add(map_.row(26, ON), 27, -30.0)
    map_.B_s.add(map_.row(26, ON), 26, 30.0)
    assert rooms_of(model_of(map_, 20)) == list(range(17, 24))


def test_doors_are_as_sensed_where_the_agent_may_be() -> None:
    map_ = corridor(9)
    shut = local_model(map_, np.array([4]), np.ones(1), open_=(False, True, True), look_ahead=2)
    at = int(np.searchsorted(shut.places[:-1], 4))
    B = shut.B.dense
    assert B[at, at, BACK] == shut.blocked[at, BACK] == 1.0
    assert B[at + 1, at, ON] == pytest.approx(1.0)
    assert shut.blocked[at, ON] == 0.0
    assert shut.successor[at].tolist() == [-1, at + 1, at]
    np.testing.assert_allclose(B.sum(axis=0), 1.0)


def test_the_cost_of_a_plan_is_that_of_the_neighbourhood() -> None:
    assert model_of(corridor(4000), 2000).B.dense.shape == model_of(corridor(40), 20).B.dense.shape


@pytest.mark.parametrize("many", [STARTS, STARTS + 60])
def test_a_plan_of_a_lost_agent_sets_out_from_the_likeliest_places_and_counts_the_others(many: int) -> None:
    map_, places = corridor(400), np.arange(many) * 4
    belief = np.linspace(1.0, 2.0, many) / np.linspace(1.0, 2.0, many).sum()
    model = local_model(map_, places, belief, open_=OPEN, look_ahead=3)
    kept = belief[-STARTS:]
    model.check()
    assert model.dropped == pytest.approx(1.0 - kept.sum())
    assert Planner().decide(model, rng=np.random.default_rng(0)).dropped == model.dropped
    at = np.searchsorted(model.places[:-1], places[-STARTS:])
    np.testing.assert_allclose(model.belief[at], kept / kept.sum())
    assert np.count_nonzero(model.belief) == STARTS


def test_of_places_equally_likely_those_kept_are_from_everywhere() -> None:
    places = np.arange(320)
    model = local_model(corridor(320), places, np.full(320, 1 / 320), open_=OPEN, look_ahead=1)
    kept = model.places[model.belief > 0.0]
    assert np.diff(kept).max() < 30
    assert model.dropped == pytest.approx(0.9)


def test_likeliest_is_the_greatest_of_the_dense_table() -> None:
    rng = np.random.default_rng(0)
    B = Transitions(rng.integers(0, 6, (6, 4, 3)), rng.dirichlet(np.full(3, 0.4), (6, 4)))
    dense = B.dense
    for place in range(5):
        for action in range(4):
            p = dense[:, place, action].copy()
            staying, nowhere = p[place], p[5]
            p[[place, 5]] = 0.0
            # a place that is named twice counts with its larger slot
            slots = zip(B.successors[place, action].tolist(), B.probability[place, action].tolist(), strict=True)
            best = max([(q, -s) for s, q in slots if s not in (place, 5)], default=(0.0, 1))
            wanted = -best[1] if best[0] > 0 and best[0] >= staying and best[0] >= nowhere else -1
            likely, blocked = likeliest(B.successors, B.probability, np.arange(6), 5)
            assert likely[place, action] == wanted
            assert blocked[place, action] == pytest.approx(staying)


@pytest.mark.parametrize(
    ("successors", "p", "message"),
    [
        (np.zeros((5, 5, 2), dtype=np.int64), np.full((5, 5, 3), 1 / 3), "probability of B has shape"),
        (np.full((5, 5, 1), 5), np.ones((5, 5, 1)), "B leads out of the places"),
        (np.zeros((5, 5, 1), dtype=np.int64), np.full((5, 5, 1), np.nan), "B is no probability"),
        (np.zeros((4, 5, 1), dtype=np.int64), np.ones((4, 5, 1)), "successors of B has shape"),
    ],
)
def test_successors_that_do_not_fit_are_refused(successors: np.ndarray, p: np.ndarray, message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        Planner().decide(replace(random_model(0), B=Transitions(successors, p)), rng=np.random.default_rng(0))


def test_a_long_way_is_searched_for_once_and_again_when_a_way_has_changed() -> None:
    asked: list[int] = []

    class Asked(LocalCache):
        def likely(self, places: np.ndarray) -> np.ndarray:
            asked.extend(places.tolist())
            return super().likely(places)

    map_, goal = corridor(300), Preferences(places={250: 5.0})
    cache = Asked(map_, 3)
    first = rooms_of(model_of(map_, 20, goal, cache))
    assert len(asked) > 200
    asked.clear()
    on = rooms_of(model_of(map_, 21, goal, cache))
    assert len(asked) < 20
    assert set(range(21, 251)) <= set(on) <= set(first) | {24}
    assert rooms_of(model_of(map_, 21, Preferences(places={240: 5.0}), cache))[-1] == 240
    model_of(map_, 21, goal, cache)
    map_.B_s.add(map_.row(40, ON), 41, -30.0)
    map_.B_s.add(map_.row(40, ON), 40, 30.0)
    assert rooms_of(model_of(map_, 22, goal, cache)) == list(range(19, 26))
