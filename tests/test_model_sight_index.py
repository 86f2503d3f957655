"""The visited places that may show a sight: found without looking at all of them."""

from __future__ import annotations

import numpy as np
from cogmap.model import CognitiveMap, Motions, map_state, restore_map
from cogmap.model.changes import KEPT
from cogmap.model.factors.sight_index import SightIndex
from cogmap.model.savepoint import go_back, release, savepoint
from hypothesis import given, settings
from hypothesis import strategies as st
from walks import GRID

SIGHTS = 4


def assert_index_is_right(map_: CognitiveMap) -> None:
    """What is not listed is below the bound, and a new index lists the same."""
    fresh = SightIndex(map_.A_o, map_.changes, map_.visits)
    for sight in range(len(map_.sights)):
        listed, bound = map_.sensors["sight"].candidates(sight)
        assert len(set(listed.tolist())) == len(listed)
        assert map_.visited[listed].all()
        besides = np.setdiff1d(map_.visited_places, listed)
        assert (map_.A_o.probability(sight, besides) <= bound).all()
        assert set(fresh.places(sight)[0].tolist()) == set(listed.tolist())


@given(ops=st.lists(st.tuples(st.integers(0, 5), st.integers(0, 19), st.integers(0, SIGHTS - 1)), max_size=60))
@settings(max_examples=40, deadline=None)
def test_whatever_happens_the_index_is_that_of_the_map(ops: list[tuple[int, int, int]]) -> None:
    map_ = CognitiveMap(Motions.of(GRID))
    for sight in range(SIGHTS):
        map_.sensors["sight"].read(sight, step=0)
    point = savepoint(map_)
    for step, (op, number, sight) in enumerate(ops, start=1):
        if step % 4 == 0:
            release(map_)
            point = savepoint(map_)
        place = number % len(map_.places) if map_.places else 0
        if op == 0 or not map_.places:
            map_.new_place((step, 0), step=step)
        elif op == 1:
            map_.mark_visited(place)
        elif op in (2, 3):
            map_.mark_visited(place)
            map_.sensors["sight"].learn(place, sight, (0.3, 1.0)[number % 2])
        elif op == 4:
            go_back(map_, point)
            point = savepoint(map_)
        else:
            map_.A_o.add(place, sight, -0.5)
        if step % 3 == 0:
            assert_index_is_right(map_)
    assert_index_is_right(map_)


def test_what_was_noted_of_more_places_than_the_log_holds_is_found() -> None:
    map_ = CognitiveMap(Motions.of(GRID))
    map_.sensors["sight"].read("a", step=0)
    map_.sensors["sight"].candidates(0)
    for place in range(2 * KEPT):
        map_.new_place((place, 0), step=0)
        map_.mark_visited(place)
        map_.A_o.add(place, 0, 1.0)
    assert map_.sensors["sight"].candidates(0)[0].tolist() == list(range(2 * KEPT))


def test_a_restored_map_knows_its_visits_and_sights() -> None:
    map_ = CognitiveMap(Motions.of(GRID))
    for place in range(5):
        map_.new_place((place, 0), step=0)
    for place in (3, 0, 4):
        map_.mark_visited(place)
        map_.A_o.add(place, map_.sensors["sight"].read(place % 2, step=0), 1.0)
    again = CognitiveMap(Motions.of(GRID))
    restore_map(again, *map_state(map_))
    assert again.first_visit.tolist() == map_.first_visit.tolist() == [1, -1, -1, 0, 2]
    for sight in range(2):
        assert sorted(again.sensors["sight"].candidates(sight)[0].tolist()) == sorted(
            map_.sensors["sight"].candidates(sight)[0].tolist()
        )
    assert_index_is_right(again)
