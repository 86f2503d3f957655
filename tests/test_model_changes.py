"""The log of changes: read by cursor, and gone back through."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from cogmap.model import Change, Changes, CognitiveMap, GrowthEvent, Motions, map_state
from cogmap.model.changes import KEPT
from cogmap.model.savepoint import go_back, release, savepoint
from hypothesis import given, settings
from hypothesis import strategies as st
from walks import GRID

writes = st.lists(st.tuples(st.integers(0, 8), st.integers(0, 9), st.integers(0, 4), st.floats(0.1, 2.0)), max_size=12)


def write(map_: CognitiveMap, ops: list[tuple[int, int, int, float]]) -> None:
    """Any of the ways in which a map changes."""
    for op, at, action, weight in ops:
        place = at % len(map_.places)
        if op == 0:
            there = (at, action)
            if map_.place_at(there) is None:
                map_.new_place(there, step=0)
        elif op == 1:
            map_.new_place(None, step=0)
        elif op == 2:
            map_.mark_visited(place)
        elif op == 3:
            map_.sensors["sight"].learn(place, map_.sensors["sight"].read(action, step=0), weight)
        elif op == 4:
            map_.sensors["open"].learn(place, [bool(at >> i & 1) for i in range(4)] + [True], min(weight, 1.0))
        elif op == 5:
            beyond = map_.beyond(place, action)
            map_.transitions.learn(place, action, place if beyond is None else beyond, min(weight, 1.0))
        elif op == 6:
            map_.transitions.forget(0.5)
        elif op == 8:
            map_.transitions.blank(place)
        elif map_.position(place) is None and map_.place_at((9, place)) is None:
            map_.bind(place, (9, place), step=0)


def begun() -> CognitiveMap:
    map_ = CognitiveMap(Motions.of(GRID))
    map_.new_place((0, 0), step=0)
    for position in [(x, y) for x in range(10) for y in range(10)]:  # what is met stays met: so that all is the same
        map_.pose.new_position(position, step=0)
    for sight in range(5):
        map_.sensors["sight"].read(sight, step=0)
    return map_


def stored(map_: CognitiveMap) -> dict[str, np.ndarray]:
    """Everything that goes back, without the slots that nothing uses."""
    arrays = {name: array for name, array in map_state(map_)[1].items() if name != "growth"}
    for table in ("A_o", "A_p", "B_s"):
        used = (arrays[f"{table}.keys"] != -2).any(axis=0)
        for part in ("keys", "prior", "evidence"):
            arrays[f"{table}.{part}"] = arrays[f"{table}.{part}"][:, used]
    return arrays


def assert_stored(map_: CognitiveMap, arrays: dict[str, np.ndarray]) -> None:
    for name, array in stored(map_).items():
        np.testing.assert_array_equal(array, arrays[name], err_msg=name)


@given(before=writes, after=writes, again=writes)
@settings(max_examples=60, deadline=None)
def test_going_back_restores_exactly(before: list, after: list, again: list) -> None:  # type: ignore[type-arg]
    map_ = begun()
    write(map_, before)
    state, point = stored(map_), savepoint(map_)
    write(map_, after)
    go_back(map_, point)
    assert_stored(map_, state)
    point = savepoint(map_)
    write(map_, again)
    go_back(map_, point)  # through what was gone back through already
    assert_stored(map_, state)


def test_readers_hear_of_everything_once() -> None:
    map_ = begun()
    assert map_.changes.since(-1) == (None, len(map_.changes))
    entries, cursor = map_.changes.since(len(map_.changes))
    assert entries == []
    place = map_.new_place((50, 50), step=3)
    map_.mark_visited(place)
    entries, cursor = map_.changes.since(cursor)
    assert entries is not None
    assert [entry.kind for entry in entries if isinstance(entry, GrowthEvent)] == ["place", "position"]
    assert {entry.store.name for entry in entries if isinstance(entry, Change)} == {
        "places",
        "position_of",
        "place_at",
        "A_p",
        "visits",
    }
    assert map_.changes.since(cursor) == ([], cursor)


CHANGES: dict[str, tuple[Callable[[CognitiveMap], object], set[int] | None, set[int] | None]] = {
    "nothing": (lambda map_: None, set(), set()),
    "a count": (lambda map_: map_.A_o.add(3, 1, 1.0), {3}, set()),
    "a transition": (lambda map_: map_.B_s.add(map_.row(2, 1), 2, 1.0), {2}, {2}),
    "a visit": (lambda map_: map_.mark_visited(4), {4}, {4}),
    "a door": (lambda map_: map_.transitions.sensed.set((1, 0), 2), {1}, set()),
    "doors": (lambda map_: map_.sensors["open"].learn(2, [False] * 4 + [True], 1.0), {2}, {2}),
    "fading": (lambda map_: map_.B_s.fade(0.5), None, None),
    "a place": (lambda map_: map_.new_place(None, step=0), {6}, {6}),
}


@pytest.mark.parametrize("name", CHANGES)
def test_caches_hear_which_places_changed(name: str) -> None:
    change, places, of_doors = CHANGES[name]
    map_ = begun()
    for _ in range(5):
        map_.new_place(None, step=0)
    assert map_.changed_places(-1)[0] is None
    _, cursor = map_.changed_places(-1)
    change(map_)
    assert map_.changed_places(cursor)[0] == places
    assert map_.changed_places(cursor, map_.B_s, map_.visits)[0] == of_doors


@pytest.mark.parametrize("count", [KEPT, 5 * KEPT])
def test_a_log_that_forgot_says_so(count: int) -> None:
    log, event = Changes(), GrowthEvent(0, "time", 0)
    for _ in range(count):
        log.append(event)
    entries, now = log.since(0)
    assert now == len(log) == count
    assert (entries is None) == (count > KEPT)
    assert len(log.since(count - KEPT)[0] or ()) == KEPT


def test_all_that_happens_in_a_step_is_kept_until_it_is_over() -> None:
    map_ = begun()
    point, length = savepoint(map_), len(map_.changes)
    for place in range(5 * KEPT):
        map_.A_o.add(0, place % 5, 1.0)
    assert len(map_.changes.held(point.changes)) == len(map_.changes.since(length)[0] or ()) == 5 * KEPT
    release(map_)
    assert map_.changes.since(length)[0] is None
    assert len(map_.changes) == length + 5 * KEPT
