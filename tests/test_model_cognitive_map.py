"""CognitiveMap: how it grows, what its tables say, what it refuses."""

from __future__ import annotations

import json
from itertools import pairwise

import numpy as np
import pytest
from cogmap.model import (
    BLOCKED,
    ELSEWHERE,
    OPEN,
    UNKNOWN,
    CogmapError,
    CognitiveMap,
    Motions,
    Priors,
    map_state,
    restore_map,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from walks import DOWN, GRID, LEFT, RIGHT, STAY, UP, assert_map_is_sound, assert_same_map


def axes(n: int) -> Motions:
    """One step along each axis of Z^n, either way, and stay."""
    vectors = {"stay": (0,) * n}
    for axis in range(n):
        for name, step in (("+", 1), ("-", -1)):
            vectors[f"{name}{axis}"] = tuple(step if i == axis else 0 for i in range(n))
    return Motions.of(vectors)


def grid_map(*positions: tuple[int, int]) -> CognitiveMap:
    map_ = CognitiveMap(Motions.of(GRID))
    for position in positions:
        map_.new_place(position, step=0)
    return map_


@pytest.mark.parametrize("n", [1, 2, 3])
@given(data=st.data())
@settings(max_examples=25, deadline=None)
def test_neighbours_are_linked_both_ways_in_any_order_and_dimension(n: int, data: st.DataObject) -> None:
    cell = st.tuples(*[st.integers(-2, 2)] * n)
    cells = data.draw(st.lists(cell, min_size=1, max_size=14, unique=True))
    map_ = CognitiveMap(axes(n))
    for i, position in enumerate(cells):
        if data.draw(st.booleans()):
            map_.pose.new_position(position, step=i)
        assert map_.new_place(position, step=i) == i
    assert_map_is_sound(map_)
    for place, position in enumerate(cells):
        assert map_.position(place) == position
        assert map_.place_at(position) == place
        assert map_.positions_given_places()[map_.positions.index(position), place] == 1.0
        for action, inverse in enumerate(map_.motions.inverse):
            there = map_.motions.move(position, action)
            neighbour = cells.index(there) if there in cells else None
            ahead = map_.position_beyond[map_.positions.index(position), action]
            if action == map_.motions.stay:
                assert map_.beyond(place, action) is None
                assert map_.transition(place, place, action) == 1.0
                assert map_.positions[ahead] == position
                continue
            assert map_.beyond(place, action) == neighbour
            assert map_.transition(place, place, action) == 0.5
            if neighbour is None:
                assert map_.transition(ELSEWHERE, place, action) == 0.5
                assert ahead == -1
            else:
                assert map_.transition(neighbour, place, action) == 0.5
                assert map_.beyond(neighbour, inverse) == place
                assert map_.positions[ahead] == there


@given(met=st.lists(st.one_of(st.none(), st.integers(0, 4), st.text(max_size=2)), max_size=12))
@settings(max_examples=40, deadline=None)
def test_sights_widen_A(met: list[object]) -> None:
    map_ = grid_map((0, 0), (0, 1))
    for step, sight in enumerate(met):
        before = len(map_.sights)
        number = map_.sensors["sight"].read(sight, step=step)
        assert map_.sights[number] == sight
        assert len(map_.sights) - before == (number == before)
    A = map_.A()
    assert A.shape == (len(dict.fromkeys(met)) + 1, 2)
    np.testing.assert_allclose(A, 1.0 / len(A))  # nothing was learned
    assert [event.label for event in map_.growth if event.kind == "sight"] == list(dict.fromkeys(met))


def test_positions_grow_once_and_know_their_neighbours() -> None:
    map_ = CognitiveMap(Motions.of(GRID))
    numbers = [map_.pose.new_position(position, step=0) for position in ((0, 0), (5, 5), (0, 1), (0, 0))]
    assert numbers == [0, 1, 2, 0]
    assert map_.position_beyond.tolist() == [[-1, -1, -1, 2, 0], [-1, -1, -1, -1, 1], [-1, -1, 0, -1, 2]]
    assert map_.place_at((0, 1)) is None
    assert map_.place_at((9, 9)) is None
    assert len(map_.growth) == 3


def test_a_place_without_position_is_bound_later() -> None:
    map_ = CognitiveMap(Motions.of(GRID))
    one, two = (map_.new_place(None, step=0) for _ in range(2))
    assert map_.position(one) is None
    assert map_.position_index.tolist() == [-1, -1]
    np.testing.assert_array_equal(map_.positions_given_places(), [[1.0, 1.0]])  # "no position yet"
    map_.bind(one, (0, 0), step=1)
    map_.bind(two, (0, 1), step=2, source=one, action=RIGHT)
    assert map_.beyond(one, RIGHT) == two
    assert map_.beyond(two, LEFT) == one
    assert_map_is_sound(map_)
    event = map_.growth[-1]
    assert (event.kind, event.index, event.label, event.source, event.action) == ("bind", two, (0, 1), one, RIGHT)
    with pytest.raises(CogmapError, match=r"place 1 has position \(0, 1\) already"):
        map_.bind(two, (3, 3), step=3)
    with pytest.raises(CogmapError, match="no place 7"):
        map_.bind(7, (3, 3), step=3)


def test_a_position_has_one_place_only() -> None:
    map_ = grid_map((0, 0))
    with pytest.raises(CogmapError, match="has place 0 already; use place_at"):
        map_.new_place((0, 0), step=1)
    assert len(map_.places) == 1


@pytest.mark.parametrize("place", [-1, 1, 99])
def test_there_are_no_other_places(place: int) -> None:
    with pytest.raises(CogmapError, match=r"there is no place .*; places are 0 to 0"):
        grid_map((0, 0)).position(place)


def test_position_must_be_hashable() -> None:
    with pytest.raises(CogmapError, match="not hashable"):
        grid_map().place_at([0, 0])  # type: ignore[arg-type]


def test_visits_keep_their_order() -> None:
    map_ = grid_map((0, 0), (0, 1), (0, 2))
    for place in (2, 0, 2, 1, 0):
        map_.mark_visited(place)
    assert map_.visited_places.tolist() == [2, 0, 1]
    assert map_.visited.tolist() == [True, True, True]


def test_doors_likelihood_is_the_product_over_the_doors() -> None:
    map_ = grid_map((0, 0), (0, 1))
    map_.sensors["open"].learn(0, [False, True, False, True, True], 1.0)
    B, places = map_.B(), np.array([0, 1])
    floor = map_.priors.door_floor
    for open_ in ([True] * 5, [False] * 5, [False, True, False, True, False]):
        expected = []
        for place in places:
            p = [np.clip(B[place, place, a], floor, 1 - floor) for a in range(4)]
            expected.append(np.prod([1 - q if is_open else q for q, is_open in zip(p, open_, strict=False)]))
        np.testing.assert_allclose(np.exp(map_.sensors["open"].log_likelihood(places, open_)), expected)
    assert map_.blocked(places)[:, STAY].tolist() == [0.0, 0.0]


@given(amounts=st.lists(st.floats(-1e9, 1e9), min_size=1, max_size=6))
@settings(max_examples=25, deadline=None)
def test_a_door_is_never_believed_beyond_the_floor(amounts: list[float]) -> None:
    map_ = grid_map((0, 0), (0, 1))
    for amount in amounts:
        map_.B_s.add(map_.row(0, RIGHT), 0, amount)
        map_.B_s.add(map_.row(0, RIGHT), 1, -amount)
    blocked = map_.blocked(np.array([0]))[0, RIGHT]
    assert map_.priors.door_floor <= blocked <= 1.0 - map_.priors.door_floor


def test_beyond_is_the_most_probable_other_place() -> None:
    map_ = grid_map((0, 0), (0, 1), (7, 7))
    map_.B_s.add(map_.row(0, RIGHT), 1, 0.5)
    map_.B_s.add(map_.row(0, RIGHT), 2, 0.5)
    assert map_.beyond(0, RIGHT) == 1  # which has a prior besides
    map_.B_s.add(map_.row(0, RIGHT), 2, 0.5)
    assert map_.beyond(0, RIGHT) == 2
    map_.B_s.add(map_.row(0, RIGHT), 0, 100.0)  # blocked: what would lie beyond is still known
    assert map_.beyond(0, RIGHT) == 2


def test_priors_are_used() -> None:
    map_ = CognitiveMap(Motions.of(GRID), priors=Priors(sight=2.0, position=3.0, transition=4.0))
    map_.new_place((0, 0), step=0)
    map_.sensors["sight"].read("a", step=0)
    assert map_.A_o.concentration(np.array([0]))[2].tolist() == [2.0]  # "a", and a sight never met
    assert map_.A_p.state()["prior"][0, 0] == 3.0
    assert map_.B_s.state()["prior"][0].tolist() == [4.0, 4.0]


def test_networkx_has_every_place_and_transition() -> None:
    map_ = grid_map((0, 0), (0, 1), (1, 0), (0, -1))
    map_.sensors["sight"].learn(0, map_.sensors["sight"].read("hall", step=0), 1.0)
    map_.sensors["open"].learn(0, [False, True, True, True, True], 1.0)
    map_.transitions.learn(0, RIGHT, 1, 1.0)
    map_.sensors["open"].learn(1, [False, False, True, False, True], 1.0)
    map_.mark_visited(0)
    graph = map_.to_networkx()
    assert list(graph.nodes) == [0, 1, 2, 3]
    assert graph.nodes[0] == {"position": (0, 0), "visited": True, "sights": {"hall": pytest.approx(1.0)}}
    assert graph.nodes[1] == {"position": (0, 1), "visited": False, "sights": {}}
    B = map_.B()
    for place, next_, data in graph.edges(data=True):
        action = map_.motions.names.index(data["action"])
        assert data["probability"] == pytest.approx(B[next_, place, action])
    leaving = B[:-1] > 0.0
    for place, action in zip(*np.nonzero(map_.sensed == BLOCKED), strict=True):
        leaving[np.arange(4) != place, place, action] = False  # no way leads through a shut door
    assert graph.number_of_edges() == leaving.sum()
    known = {(place, action): data["known"] for place, _, action, data in graph.edges(keys=True, data=True)}
    assert known[0, "right"] == known[0, "stay"] == "walked"
    assert known[0, "down"] == "imagined"
    assert known[0, "up"] == known[1, "up"] == "refuted"
    assert known[3, "up"] == "unknown"


def test_arrays_and_labels_make_the_same_map() -> None:
    map_ = grid_map((0, 0), (0, 1), (1, 1))
    for a, b in pairwise(["a", None, (1, "x")]):
        map_.sensors["sight"].read(a, step=1)
        map_.sensors["sight"].read(b, step=1)
    map_.grow_time(step=1)
    map_.new_place(None, step=2, source=0, action=DOWN)
    map_.sensors["sight"].learn(0, 1, 0.5)
    map_.sensors["open"].learn(0, [False, True, True, True, True], 1.0)
    map_.transitions.learn(0, RIGHT, 1, 0.75)
    map_.mark_visited(1)
    header, arrays = map_state(map_)
    copy = CognitiveMap(map_.motions)
    restore_map(copy, json.loads(json.dumps(header)), arrays)
    assert_same_map(map_, copy)
    for one in (map_, copy):  # and they go on alike
        one.new_place((1, 0), step=3, source=0, action=DOWN)
        one.sensors["sight"].read("new", step=3)
        one.sensors["open"].learn(2, [True, False, True, False, True], 1.0)
    assert_same_map(map_, copy)
    assert len(arrays["A_o.keys"]) == 4  # the arrays are copies
    assert repr(copy) == "CognitiveMap(5 places, 1 visited, 4 positions, 4 sights)"


DAMAGE = {
    "half": lambda array: array[: len(array) // 2],
    "twice": lambda array: np.concatenate([array, array]),
    "flat": lambda array: array.reshape(-1)[:1],
    "deep": lambda array: array[None],
    "too low": lambda array: np.full_like(array, -9) if array.dtype.kind != "b" else array[:0],
    "too high": lambda array: np.full_like(array, 100) if array.dtype.kind == "i" else array * np.inf,
    "NaN": lambda array: array * np.nan,
    "words": lambda array: np.full(array.shape, "a"),
}


@pytest.mark.parametrize("damage", DAMAGE)
def test_damaged_arrays_are_refused(damage: str) -> None:
    map_ = grid_map((0, 0), (0, 1), (1, 1))
    map_.sensors["sight"].read("a", step=0)
    for place in (0, 1):
        map_.mark_visited(place)
    header, arrays = map_state(map_)
    for name in arrays:
        fewer_visits = name == "visits.order" and damage in ("half", "flat")
        if name != "growth" and not name.startswith("changes") and not fewer_visits:  # the log is empty here
            with np.errstate(invalid="ignore"):
                damaged = {**arrays, name: DAMAGE[damage](arrays[name])}
            with pytest.raises(CogmapError, match=r"does not fit|do not fit|what is known of"):
                restore_map(CognitiveMap(map_.motions), header, damaged)
    for name in arrays:
        fewer = {other: values for other, values in arrays.items() if other != name}
        with pytest.raises(KeyError):
            restore_map(CognitiveMap(map_.motions), header, fewer)


def test_what_was_sensed_is_told_by_name() -> None:
    map_ = grid_map((0, 0), (0, 1))
    assert (map_.sensed == UNKNOWN).all()
    map_.sensors["open"].learn(0, [False, False, False, True, True], 1.0)
    assert map_.sensed[0].tolist() == [BLOCKED, BLOCKED, BLOCKED, OPEN, UNKNOWN]
    assert map_.sensed[0, UP] == BLOCKED
