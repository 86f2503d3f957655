"""Learning rules: exactly the counts of the paper's table, weighted, never below the prior."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from cogmap.model import (
    BLOCKED,
    ELSEWHERE,
    OPEN,
    TABLE_RATES,
    TEXT_RATES,
    UNKNOWN,
    CognitiveMap,
    Motions,
    ParameterUpdate,
    Rates,
    updates,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from walks import DOWN, GRID, LEFT, RIGHT, STAY, UP, assert_map_is_sound

A, B = 0, 1
SHUT = (False, False, False, False, True)
EAST = (False, False, False, True, True)


def pair(rates: Rates = TABLE_RATES) -> CognitiveMap:
    """Place A with place B to its right."""
    map_ = CognitiveMap(Motions.of(GRID), rates=rates)
    map_.new_place((0, 0), step=0)
    map_.new_place((0, 1), step=0)
    return map_


def evidence(map_: CognitiveMap) -> dict[tuple[int, int, str], float]:
    """All evidence in B_s by (next, previous, action)."""
    state, size = map_.B_s.state(), len(map_.motions)
    return {
        (int(key), row // size, map_.motions.names[row % size]): float(amount)
        for row, (keys, amounts) in enumerate(zip(state["keys"], state["evidence"], strict=True))
        for key, amount in zip(keys.tolist(), amounts.tolist(), strict=True)
        if amount
    }


def test_the_two_tables_of_rates() -> None:
    assert (TABLE_RATES.possible, TABLE_RATES.impossible, TABLE_RATES.imagined) == ((7, 5), (-7, -5), (5, 3))
    assert (TEXT_RATES.possible, TEXT_RATES.impossible, TEXT_RATES.imagined) == ((10, 7), (-10, -7), (5, 3))
    assert Rates() == TABLE_RATES


@pytest.mark.parametrize("rates", [TABLE_RATES, TEXT_RATES])
@pytest.mark.parametrize("weight", [1.0, 0.5, 0.3])
def test_possible(rates: Rates, weight: float) -> None:
    map_ = pair(rates)
    map_.transitions.learn(A, RIGHT, B, weight)
    forward, reverse = rates.possible
    assert evidence(map_) == pytest.approx({(B, A, "right"): weight * forward, (A, B, "left"): weight * reverse})
    assert map_.walked[A, RIGHT] == (weight > 0.5)
    assert map_.walked.sum() == (weight > 0.5)


@pytest.mark.parametrize("rates", [TABLE_RATES, TEXT_RATES])
@pytest.mark.parametrize("weight", [1.0, 0.5])
@pytest.mark.parametrize("how", ["door", "bump"])
def test_impossible(rates: Rates, weight: float, how: str) -> None:
    map_ = pair(rates)
    for row, key in ((map_.row(A, RIGHT), B), (map_.row(B, LEFT), A)):
        map_.B_s.add(row, key, 100.0)  # more than the ceiling: it stays
    if how == "door":
        map_.sensors["open"].learn(A, (True, True, True, False, True), weight)
        assert map_.sensed[A, RIGHT] == BLOCKED
    else:
        map_.transitions.learn(A, RIGHT, A, weight)
    forward, reverse = rates.impossible
    assert evidence(map_) == pytest.approx(
        {
            (A, A, "right"): -weight * forward,
            (B, A, "right"): 100.0 + weight * forward,
            (B, B, "left"): -weight * reverse,
            (A, B, "left"): 100.0 + weight * reverse,
        }
    )


@pytest.mark.parametrize("weight", [1.0, 0.5])
def test_imagined_once_a_place_and_action(weight: float) -> None:
    map_ = pair()
    ahead = (True, True, True, True, True)  # nothing is known behind the others
    expected = {(B, A, "right"): 5.0 * weight, (A, B, "left"): 3.0 * weight}
    for _ in range(3):
        map_.sensors["open"].learn(A, ahead, weight)
        assert evidence(map_) == pytest.approx(expected)
        assert map_.sensed[A, RIGHT] == OPEN
    map_.sensors["open"].learn(B, ahead, 1.0)  # seen from the other side: a look of its own
    assert evidence(map_)[A, B, "left"] == pytest.approx(5.0)
    assert evidence(map_)[B, A, "right"] == pytest.approx(max(5.0 * weight, 3.0))


def test_blocked_is_learned_once_while_nothing_changes() -> None:
    map_ = pair()
    map_.sensors["open"].learn(A, SHUT, 1.0)
    once = evidence(map_)
    map_.sensors["open"].learn(A, SHUT, 1.0)
    assert evidence(map_) == once
    assert once[A, A, "right"] == 7.0
    assert once[B, B, "left"] == 5.0


def test_a_wall_with_nothing_known_behind_adds_the_self_transition_alone() -> None:
    map_ = pair()
    map_.sensors["open"].learn(A, EAST, 1.0)
    assert {key: amount for key, amount in evidence(map_).items() if key[2] == "up"} == {(A, A, "up"): 7.0}


def test_a_door_that_closes_and_opens_again() -> None:
    map_ = pair()
    right, left = map_.row(A, RIGHT), map_.row(B, LEFT)

    def counts() -> list[float]:
        table = map_.B_s
        return [table.evidence(right, B), table.evidence(right, A), table.evidence(left, A), table.evidence(left, B)]

    map_.sensors["open"].learn(A, EAST, 1.0)
    map_.transitions.learn(A, RIGHT, B, 1.0)
    assert counts() == [7.0, 0.0, 7.0, 0.0]
    map_.sensors["open"].learn(A, SHUT, 1.0)
    assert counts() == [0.0, 7.0, 2.0, 5.0]
    map_.sensors["open"].learn(A, EAST, 1.0)  # the self-transitions are taken back, the way is imagined anew
    assert counts() == [5.0, 0.0, 3.0, 0.0]
    map_.sensors["open"].learn(A, SHUT, 1.0)
    map_.sensors["open"].learn(A, SHUT, 1.0)
    assert counts() == [0.0, 7.0, 0.0, 5.0]


@pytest.mark.parametrize("rates", [TABLE_RATES, TEXT_RATES])
def test_one_look_outweighs_any_number_of_walks(rates: Rates) -> None:
    map_ = pair(rates)
    for _ in range(100):
        map_.transitions.learn(A, RIGHT, B, 1.0)
        map_.transitions.learn(B, LEFT, A, 1.0)
    assert evidence(map_) == {(B, A, "right"): rates.ceiling, (A, B, "left"): rates.ceiling}
    map_.sensors["open"].learn(A, SHUT, 1.0)
    assert map_.transition(A, A, RIGHT) > 0.99
    assert map_.transition(B, B, LEFT) > 0.6
    map_.sensors["open"].learn(A, EAST, 1.0)
    assert map_.transition(B, A, RIGHT) > 0.99
    assert map_.transition(A, B, LEFT) > 0.6


def test_a_look_at_an_open_door_mends_what_the_other_side_taught() -> None:
    map_ = pair()
    map_.sensors["open"].learn(A, EAST, 1.0)
    map_.sensors["open"].learn(B, SHUT, 1.0)  # closed, seen from B; open again when A looks the next time
    assert map_.transition(B, A, RIGHT) < 0.6
    map_.sensors["open"].learn(A, EAST, 1.0)
    assert map_.transition(B, A, RIGHT) > 0.99


def test_a_look_restores_what_was_forgotten() -> None:
    map_ = pair()
    map_.sensors["open"].learn(A, EAST, 1.0)
    map_.transitions.forget(0.1)
    map_.sensors["open"].learn(A, EAST, 1.0)
    assert evidence(map_)[B, A, "right"] == 5.0
    assert evidence(map_)[A, A, "up"] == 7.0
    assert evidence(map_)[A, B, "left"] == pytest.approx(0.3)  # the other side was not looked at


def test_a_wall_with_nothing_known_behind_can_open() -> None:
    map_ = pair()
    map_.sensors["open"].learn(A, SHUT, 1.0)
    map_.sensors["open"].learn(A, (True, False, False, False, True), 1.0)
    assert map_.transition(A, A, UP) <= 0.5


def test_an_open_door_to_nowhere_is_forgotten() -> None:
    map_ = pair()
    map_.sensors["open"].learn(A, (True, True, True, True, True), 1.0)
    assert map_.sensed[A].tolist() == [UNKNOWN, UNKNOWN, UNKNOWN, OPEN, UNKNOWN]
    assert evidence(map_) == {(B, A, "right"): 5.0, (A, B, "left"): 3.0}


def test_staying_teaches_nothing_of_transitions() -> None:
    map_ = pair()
    map_.transitions.learn(A, STAY, A, 1.0)
    map_.transitions.learn(A, STAY, B, 1.0)
    map_.sensors["open"].learn(A, (False, False, False, False, False), 1.0)
    assert not [key for key in evidence(map_) if key[2] == "stay"]
    assert map_.sensed[A, STAY] == UNKNOWN


def test_a_new_place_is_told_of_doors_its_neighbours_saw_blocked() -> None:
    map_ = pair()
    map_.sensors["open"].learn(A, SHUT, 1.0)
    map_.sensors["open"].learn(B, (False, False, True, False, True), 1.0)
    new = map_.new_place((1, 0), step=1)
    before = evidence(map_)
    map_.recall([new])
    after = evidence(map_)
    assert {key: after[key] for key in after.keys() - before.keys()} == {(new, new, "up"): 5.0}
    map_.recall([map_.new_place((2, 0), step=1)])  # its neighbour never looked
    assert evidence(map_) == after


def test_likelihoods_are_weighted() -> None:
    map_ = pair(Rates(likelihood=2.0))
    sight = map_.sensors["sight"].read("hall", step=0)
    map_.sensors["sight"].learn(A, sight, 0.5)
    map_.sensors["sight"].learn(A, sight, 0.25)
    map_.pose.learn(B, 0.5)
    assert map_.A_o.evidence(A, sight) == 1.5
    assert map_.A_o.evidence(B, sight) == 0.0
    assert map_.A_p.evidence(B, 1) == 1.0
    assert map_.A()[sight, A] == pytest.approx(1.0)


def test_forgetting_fades_transitions_only() -> None:
    map_ = pair()
    sight = map_.sensors["sight"].read("hall", step=0)
    map_.sensors["sight"].learn(A, sight, 1.0)
    map_.transitions.learn(A, RIGHT, B, 1.0)
    map_.transitions.forget(0.5)
    assert evidence(map_) == {(B, A, "right"): 3.5, (A, B, "left"): 2.5}
    map_.transitions.forget(0.0)
    assert evidence(map_) == {}
    assert map_.A_o.evidence(A, sight) == 1.0
    assert_map_is_sound(map_)


def test_updates_are_read_from_the_log() -> None:
    map_ = pair()
    cursor = len(map_.changes)
    map_.sensors["sight"].learn(A, map_.sensors["sight"].read("x", step=0), 1.0)
    map_.transitions.learn(A, RIGHT, B, 1.0)
    entries, cursor = map_.changes.since(cursor)
    assert updates(entries or ()) == [
        ParameterUpdate("A_o", 0, A, None, 1.0),
        ParameterUpdate("B_s", B, A, RIGHT, 7.0),
        ParameterUpdate("B_s", A, B, LEFT, 5.0),
    ]
    map_.transitions.learn(A, RIGHT, B, 0.0)
    assert updates(map_.changes.since(cursor)[0] or ()) == []


def test_updates_of_many_rows_are_told_one_by_one() -> None:
    map_ = pair()
    cursor = len(map_.changes)
    map_.sensors["open"].learn(A, [False, True, False, True, True], 1.0)
    entries, cursor = map_.changes.since(cursor)
    learned = {(told.outcome, told.action): told.amount for told in updates(entries or ()) if told.place == A}
    assert {key: amount for key, amount in learned.items() if key[0] == A} == {(A, UP): 7.0, (A, LEFT): 7.0}
    map_.transitions.blank(A)
    lost = {(told.outcome, told.action): -told.amount for told in updates(map_.changes.since(cursor)[0] or ())}
    assert lost == learned


doors = st.tuples(*[st.booleans()] * 4, st.just(True))
place = st.integers(0, 3)
weights = st.floats(0.0, 1.0)
lesson = st.one_of(
    st.tuples(st.just("doors"), place, doors, weights),
    st.tuples(st.just("transition"), place, st.integers(0, 4), weights),
    st.tuples(st.just("bump"), place, st.integers(0, 4), weights),
    st.tuples(st.just("sight"), place, st.integers(0, 1), weights),
    st.tuples(st.just("recall"), place, st.just(0), weights),
)


@given(st.lists(lesson, max_size=40), st.sampled_from([TABLE_RATES, TEXT_RATES]))
@settings(max_examples=60, deadline=None)
def test_any_lessons_keep_counts_above_the_prior_and_add_up(lessons: list[tuple[Any, ...]], rates: Rates) -> None:
    map_ = CognitiveMap(Motions.of(GRID), rates=rates)
    for position in ((0, 0), (0, 1), (1, 0), (1, 1)):
        map_.new_place(position, step=0)
    for sight in "ab":
        map_.sensors["sight"].read(sight, step=0)
    cursor = len(map_.changes)
    for kind, at, what, weight in lessons:
        if kind == "doors":
            map_.sensors["open"].learn(at, what, weight)
        elif kind == "sight":
            map_.sensors["sight"].learn(at, what, weight)
        elif kind == "recall":
            map_.recall([at])
        else:
            beyond = None if kind == "bump" else map_.beyond(at, what)
            map_.transitions.learn(at, what, at if beyond is None else beyond, weight)
    assert_map_is_sound(map_)
    total: dict[tuple[str, int, int], float] = {}
    for taught in updates(map_.changes.since(cursor)[0] or ()):
        row = taught.place if taught.action is None else map_.row(taught.place, taught.action)
        key = (taught.table, row, taught.outcome)
        total[key] = total.get(key, 0.0) + taught.amount
    for name in ("A_o", "B_s"):
        table = getattr(map_, name)
        for row in range(len(table)):
            for outcome in (ELSEWHERE, 0, 1, 2, 3):
                assert table.evidence(row, outcome) == pytest.approx(total.get((name, row, outcome), 0.0), abs=1e-9)
    B = map_.B()
    np.testing.assert_array_equal(B[np.arange(4), np.arange(4), STAY], 1.0)
    assert (B[-1, A, [UP, LEFT]] > 0.0).all()  # outwards there may always be more
    assert (B[-1, A, [DOWN, RIGHT]] < 1e-12).all()
