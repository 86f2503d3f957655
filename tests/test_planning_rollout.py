"""Expected free energy: the shared rollout against the plain one, and closed forms."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
import pytest
from cogmap.model.errors import CogmapError
from cogmap.planning import (
    POLICIES,
    TERMS,
    Cost,
    ExpectedFreeEnergy,
    LocalModel,
    MapGuided,
    Policies,
    SelfAvoiding,
    StateInformation,
    Transitions,
    WayThere,
    evaluate,
    evaluate_plain,
    rollout,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from local_models import GRID, LINE, grid_model, random_model

NAMES = [term.name for term in TERMS]
ALL = (*TERMS, Cost(price=0.3))
HALL = [(0, j) for j in range(5)]


def assert_same(ours: ExpectedFreeEnergy, plain: ExpectedFreeEnergy) -> None:
    for name in ours.names:
        np.testing.assert_allclose(ours[name], plain[name], atol=1e-9, err_msg=name)


@settings(max_examples=20, deadline=None)
@given(
    st.integers(0, 10**6),
    st.sampled_from(sorted(POLICIES)),
    st.sampled_from([GRID, LINE]),
    st.integers(1, 6),
    st.booleans(),
)
def test_equals_the_plain_evaluation(seed: int, name: str, motions, places: int, sparse: bool) -> None:
    look_ahead = 3 if motions is LINE else 2
    model = random_model(seed, motions=motions, places=places, look_ahead=look_ahead, sparse=sparse)
    policies = POLICIES[name]().make(model)
    assert_same(evaluate(model, policies, ALL), evaluate_plain(model, policies, ALL))


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10**6), st.integers(1, 6) | st.integers(64, 68), st.integers(1, 3))
def test_successors_give_what_the_dense_table_gives(seed: int, places: int, slots: int) -> None:
    rng = np.random.default_rng(seed)
    B = Transitions(rng.integers(0, places, (places, 5, slots)), rng.dirichlet(np.full(slots, 0.4), (places, 5)))
    model = replace(random_model(seed, places=places, look_ahead=2), B=B)
    model.check()
    policies = Policies(SelfAvoiding().make(model).actions[:6])
    ours = evaluate(model, policies)
    assert_same(ours, evaluate_plain(model, policies))
    again = Transitions.of(B.dense)
    np.testing.assert_allclose(again.dense, B.dense, atol=1e-15)
    assert_same(ours, evaluate(replace(model, B=again), policies))


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10**6), st.integers(2, 8), st.booleans())
def test_policies_that_stay_for_long_beside_one_that_moves_for_long(seed: int, places: int, far: bool) -> None:
    rng = np.random.default_rng(seed)
    B = Transitions(rng.integers(0, places, (places, 5, 2)), rng.dirichlet([0.4, 0.4], (places, 5)))
    B.successors[:, GRID.stay] = np.arange(places)[:, None]
    belief = np.where(np.arange(places) < 2, 0.5, 0.0)
    model = replace(random_model(seed, places=places, look_ahead=2), B=B, belief=belief)
    actions = np.full((6, 40), GRID.stay)
    actions[1:, :2] = rng.integers(0, 5, (5, 2))
    if far:
        actions[-1, :30] = rng.integers(0, 4, 30)
    policies = Policies(actions)
    assert_same(evaluate(model, policies), evaluate_plain(model, policies))
    nothing = dict.fromkeys(model.information, np.zeros_like(model.information["sight"]))
    known = replace(model, information=nothing)  # nothing is left to learn
    assert_same(evaluate(known, policies), evaluate_plain(known, policies))


def test_equals_the_plain_evaluation_beyond_the_tables() -> None:
    model = random_model(3)
    rng = np.random.default_rng(3)
    policies = Policies(rng.integers(0, 5, (20, 9)))
    assert model.information["sight"].shape[1] < 9
    assert_same(evaluate(model, policies), evaluate_plain(model, policies))


def test_parts_equal_the_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    model = random_model(5)
    policies = POLICIES["self_avoiding"]().make(model)
    whole = evaluate(model, policies)
    monkeypatch.setattr(rollout, "CHUNK", 400)
    assert_same(evaluate(model, policies), whole)


def test_input_is_left_as_it_was() -> None:
    model = random_model(5)
    before = {
        f.name: np.copy(getattr(model, f.name)) for f in fields(model) if f.name not in ("motions", "information")
    }
    evaluate(model, MapGuided().make(model))
    for name, value in before.items():
        np.testing.assert_array_equal(getattr(model, name), value)


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10**6))
def test_information_is_never_negative(seed: int) -> None:
    terms = evaluate(model := random_model(seed), MapGuided().make(model))
    for name in NAMES[:4]:
        assert (terms[name] >= -1e-12).all()


def test_lumped_sights_equal_sights_one_by_one() -> None:
    model = random_model(1, places=4, sights=3)
    model = replace(model, multiplicity=np.array([1.0, 3.0, 2.0]))
    copies = [1, 3, 2]
    apart = replace(
        model,
        A=np.repeat(model.A / model.multiplicity[:, None], copies, axis=0),
        multiplicity=np.ones(6),
        log_C=np.repeat(model.log_C, copies),
    )
    policies = MapGuided().make(model)
    assert_same(evaluate(model, policies), evaluate(apart, policies))


def test_staying_does_not_collect_the_same_novelty_again() -> None:
    model = grid_model(HALL, visited=HALL[:1], at=(0, 1), look_ahead=4)
    stays = evaluate(model, Policies(np.full((1, 4), GRID.stay)))
    once = model.information["sight"][1, 1]
    assert once > 6.0
    assert once < stays["sight_information"][0] < once + 0.5


def test_known_place_in_closed_form() -> None:
    # a line with certain moves and sights: no uncertainty is left but what the tables say
    model = random_model(0, motions=LINE, places=2, sights=2, look_ahead=2)
    B = np.zeros((2, 2, 3))
    B[0, :, 0] = B[1, :, 1] = 1.0
    B[[0, 1], [0, 1], 2] = 1.0
    model = replace(
        model,
        B=Transitions.of(B),
        A=np.eye(2),
        multiplicity=np.ones(2),
        belief=np.array([1.0, 0.0]),
        discount=1.0,
    )
    model = replace(model, information_weight=1.0, log_C_place=np.zeros(2))
    terms = evaluate(model, Policies(np.array([[1, 2], [1, 0]])))
    I, J, C = model.information["sight"], model.information["transition"], model.log_C  # noqa: E741
    np.testing.assert_allclose(terms["state_information"], 0.0, atol=1e-12)
    np.testing.assert_allclose(terms["sight_information"], [I[1, 2], I[1, 1] + I[0, 1]])
    np.testing.assert_allclose(terms["transition_information"], [J[1, 2], J[1, 1] + J[0, 1]])
    np.testing.assert_allclose(terms["utility"], [2 * C[1], C[1] + C[0]])
    risk = model.collision_cost * model.blocked
    np.testing.assert_allclose(terms["collision"], [risk[0, 1], risk[0, 1] + risk[1, 0]])


def test_state_information_of_a_lost_agent_is_one_bit() -> None:
    model = random_model(0, motions=LINE, places=2, sights=2, look_ahead=1)
    still = np.repeat(np.eye(2)[:, :, None], 3, axis=2)
    model = replace(model, B=Transitions.of(still), A=np.eye(2), multiplicity=np.ones(2), belief=np.array([0.5, 0.5]))
    model = replace(model, information_weight=1.0)
    terms = evaluate(model, Policies(np.array([[1], [2]])))
    assert terms["state_information"][0] == pytest.approx(np.log(2))
    assert terms["state_information"][1] == 0.0  # to stay is to look again at what was seen


def test_ways_and_further_sensors_tell_a_lost_agent_where_it_is() -> None:
    """Four places with two labels of one sensor, two of another and one way: exact where places differ altogether."""
    places, blocked = np.eye(4), np.zeros((4, 3))
    model = random_model(0, motions=LINE, places=4, sights=2, look_ahead=1)
    model = replace(model, B=Transitions.of(np.repeat(places[:, :, None], 3, axis=2)), belief=np.full(4, 0.25))
    model = replace(model, A=np.array([[1.0, 1, 0, 0], [0, 0, 1, 1]]), multiplicity=np.ones(2), log_C=np.zeros(2))
    model = replace(model, information_weight=1.0, senses=(), looks=False, blocked=blocked)
    step = Policies(np.array([[0]]))

    def told(model: LocalModel, **options: bool) -> float:
        return float(evaluate(model, step, [StateInformation(**options)])["state_information"][0])

    assert told(model) == pytest.approx(np.log(2))
    smells = replace(model, senses=(np.array([[1.0, 0, 1, 0], [0, 1, 0, 1]]),))
    assert told(smells) == pytest.approx(np.log(4))
    blocked[1, 0] = blocked[3, 0] = 1.0
    assert told(replace(model, blocked=blocked)) == pytest.approx(np.log(2))  # nothing senses ways
    assert told(replace(model, blocked=blocked, looks=True)) == pytest.approx(np.log(4))
    assert told(replace(model, blocked=blocked, looks=True), ways=False) == pytest.approx(np.log(2))
    noisy = replace(model, blocked=0.1 + 0.8 * blocked, looks=True)
    exact = np.log(4) + 0.9 * np.log(0.9) + 0.1 * np.log(0.1)
    assert np.log(2) < told(noisy) < exact  # a bound from below
    sure = replace(model, belief=np.eye(4)[0], blocked=blocked, looks=True)
    assert told(sure) == pytest.approx(0.0)


def test_the_first_step_of_a_way_costs_what_it_costs_here() -> None:
    model = replace(random_model(1, motions=LINE, look_ahead=3), discount=1.0, prices=np.array([1.5, 0.25, 1.0]))
    policies = Policies(np.array([[0, 1, 2], [1, 0, 2], [1, 1, 0], [2, 1, 2]]))
    energy = evaluate(model, policies, [WayThere(cost=2.0)])
    np.testing.assert_allclose(energy["way_there"], [5.0, 2.5, 4.5, 2.0])
    np.testing.assert_allclose(energy.G, evaluate_plain(model, policies, [WayThere(cost=2.0)]).G)
    with pytest.raises(CogmapError, match=r"prices has a price below 0"):
        replace(model, prices=np.array([-1.0, 0.0, 0.0])).check()


def test_the_cost_of_moves_is_a_term_that_can_be_asked_for() -> None:
    model = replace(random_model(1, motions=LINE, look_ahead=2), discount=1.0, costs=np.array([3.0, 0.5, 0.0]))
    energy = evaluate(model, Policies(np.array([[0, 1], [1, 2], [2, 2]])), [Cost(price=0.1)])
    np.testing.assert_allclose(energy["cost"], [0.35, 0.05, 0.0])
    np.testing.assert_allclose(energy.G, energy["cost"])
    assert not evaluate(replace(model, costs=None), Policies(np.array([[0, 1]])), [Cost()])["cost"].any()
    for price in (-1.0, np.inf, np.nan):
        with pytest.raises(CogmapError, match=r"cost: price is .*; give a finite number"):
            Cost(price=price)
    with pytest.raises(CogmapError, match=r"costs has a cost below 0"):
        replace(model, costs=np.array([-1.0, 0.0, 0.0])).check()


def test_terms_add_up_and_explain_themselves() -> None:
    model = random_model(2)
    terms = evaluate(model, MapGuided().make(model))
    row = terms.row(1)
    gains = sum(row[name] for name in NAMES[:4])
    assert row["G"] == pytest.approx(row["collision"] - gains - row["utility"])
    assert list(row) == [*NAMES, "G"]
    assert len(terms) == len(MapGuided().make(model))


@pytest.mark.parametrize("wrong", [-1, 5])
def test_unknown_action(wrong: int) -> None:
    with pytest.raises(CogmapError, match=r"0\.\.4"):
        evaluate(random_model(0), Policies(np.array([[0, wrong]])))
