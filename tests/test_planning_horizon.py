"""What of the map a plan takes in."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from cogmap.model import CognitiveMap
from cogmap.model.errors import CogmapError
from cogmap.planning import Reach, Transitions, horizon, map_guided, plan
from cogmap.planning.horizon import cut_reach
from cogmap.planning.outlook import Outlook
from cogmap.planning.preferences import Preferences
from cogmap.planning.transitions import likeliest
from reaches import LINE, random_reach

BACK, ON, STAY = 0, 1, 2
OPEN = (True, True, True)


def corridor(rooms: int, *, unvisited: int | None = None) -> CognitiveMap:
    """Known rooms in a row, number and position alike; `unvisited` was never entered."""
    map_ = CognitiveMap(LINE)
    sight = map_.new_sight("grey", step=0)
    for room in range(rooms):
        map_.new_place((room,), step=0)
    for room in range(rooms):
        for action, beyond in ((BACK, room - 1), (ON, room + 1)):
            map_.B_s.add(map_.row(room, action), beyond if 0 <= beyond < rooms else room, 30.0)
        if room != unvisited:
            map_.mark_visited(room)
            map_.A_o.add(room, sight, 30.0)
    return map_


def reach_of(map_: CognitiveMap, at: int, preferences: Preferences | None = None) -> Reach:
    return cut_reach(
        map_, np.array([at]), np.ones(1), open_=OPEN, look_ahead=3, preferences=preferences or Preferences()
    )


def rooms_of(reach: Reach) -> list[int]:
    return [place for place in reach.places.tolist() if place >= 0]


def test_where_nothing_promises_anything_a_plan_stays_within_look_ahead() -> None:
    reach = reach_of(corridor(50), 20)
    assert rooms_of(reach) == list(range(17, 24))
    reach.check()
    assert map_guided(reach).actions.shape[1] == 3  # the rim is known, not a way into the unknown


@pytest.mark.parametrize("preferred", [False, True])
def test_only_the_way_to_the_nearest_promising_place_goes_beyond_look_ahead(preferred: bool) -> None:
    map_ = corridor(50, unvisited=None if preferred else 30)
    reach = reach_of(map_, 20, Preferences(places={30: 5.0} if preferred else {}))
    assert rooms_of(reach) == list(range(17, 31))
    reach.check()
    chosen = plan(reach, rng=np.random.default_rng(0))
    assert chosen.names == ["on"] * 10


def test_a_sight_never_met_is_no_reason_to_search_a_map_that_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[int] = []
    monkeypatch.setattr(horizon, "_promising", lambda *given: asked.append(1))
    assert rooms_of(reach_of(corridor(50), 20, Preferences(sights={-1: 5.0}))) == list(range(17, 24))
    assert not asked


def test_an_outlook_that_does_not_fit_and_no_start_at_all_are_refused() -> None:
    map_ = corridor(9)
    options = {"open_": OPEN, "look_ahead": 3, "preferences": Preferences()}
    for outlook, message in (
        (Outlook(map_, 2), "tells of 2 visits; make one for 3"),
        (Outlook(corridor(9), 3), "another"),
    ):
        with pytest.raises(CogmapError, match=message):
            cut_reach(map_, np.array([4]), np.ones(1), outlook=outlook, **options)
    with pytest.raises(CogmapError, match="starts is 0; give 1 or more"):
        cut_reach(map_, np.array([4]), np.ones(1), starts=0, **options)
    longer = cut_reach(map_, np.array([4]), np.ones(1), outlook=Outlook(map_, 5), **options)
    longer.check()
    plain = cut_reach(map_, np.array([4]), np.ones(1), **options)
    np.testing.assert_array_equal(longer.sight_information, plain.sight_information)


def test_what_is_near_is_taken_before_what_is_far() -> None:
    map_ = corridor(50, unvisited=22)
    assert rooms_of(reach_of(map_, 20, Preferences(places={40: 5.0}))) == list(range(17, 24))


def test_a_shut_door_is_no_way_to_a_promising_place() -> None:
    map_ = corridor(50, unvisited=30)
    map_.B_s.add(map_.row(26, ON), 27, -30.0)
    map_.B_s.add(map_.row(26, ON), 26, 30.0)
    assert rooms_of(reach_of(map_, 20)) == list(range(17, 24))


def test_doors_are_as_sensed_where_the_agent_may_be() -> None:
    map_ = corridor(9)
    shut = cut_reach(
        map_, np.array([4]), np.ones(1), open_=(False, True, True), look_ahead=2, preferences=Preferences()
    )
    at = int(np.searchsorted(shut.places[:-1], 4))
    B = np.asarray(shut.B)
    assert B[at, at, BACK] == shut.collision[at, BACK] == 1.0
    assert B[at + 1, at, ON] == pytest.approx(1.0)
    assert shut.collision[at, ON] == 0.0
    assert shut.successor[at].tolist() == [-1, at + 1, at]
    np.testing.assert_allclose(B.sum(axis=0), 1.0)


def test_the_cost_of_a_plan_is_that_of_the_neighbourhood() -> None:
    assert reach_of(corridor(4000), 2000).B.shape == reach_of(corridor(40), 20).B.shape


@pytest.mark.parametrize("many", [horizon.STARTS, horizon.STARTS + 60])
def test_a_plan_of_a_lost_agent_sets_out_from_the_likeliest_places_and_counts_the_others(many: int) -> None:
    map_, places = corridor(400), np.arange(many) * 4
    belief = np.linspace(1.0, 2.0, many) / np.linspace(1.0, 2.0, many).sum()
    reach = cut_reach(map_, places, belief, open_=OPEN, look_ahead=3, preferences=Preferences())
    kept = belief[-horizon.STARTS :]
    reach.check()
    assert reach.dropped == pytest.approx(1.0 - kept.sum())
    assert plan(reach, rng=np.random.default_rng(0)).dropped == reach.dropped
    at = np.searchsorted(reach.places[:-1], places[-horizon.STARTS :])
    np.testing.assert_allclose(reach.belief[at], kept / kept.sum())
    assert np.count_nonzero(reach.belief) == horizon.STARTS


def test_of_places_equally_likely_those_kept_are_from_everywhere() -> None:
    places = np.arange(320)
    reach = cut_reach(corridor(320), places, np.full(320, 1 / 320), open_=OPEN, look_ahead=1, preferences=Preferences())
    kept = reach.places[reach.belief > 0.0]
    assert np.diff(kept).max() < 30
    assert reach.dropped == pytest.approx(0.9)


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
        (np.zeros((5, 5, 2), dtype=np.int64), np.full((5, 5, 3), 1 / 3), "B has successors"),
        (np.full((5, 5, 1), 5), np.ones((5, 5, 1)), "B leads out of reach"),
        (np.zeros((5, 5, 1), dtype=np.int64), np.full((5, 5, 1), np.nan), "B is no probability"),
        (np.zeros((4, 5, 1), dtype=np.int64), np.ones((4, 5, 1)), "B has shape"),
    ],
)
def test_successors_that_do_not_fit_are_refused(successors: np.ndarray, p: np.ndarray, message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        plan(replace(random_reach(0), B=Transitions(successors, p)), rng=np.random.default_rng(0))
