"""Posterior over policies, the choice, and the whole plan."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from cogmap.model.errors import CogmapError
from cogmap.planning import (
    POLICIES,
    Best,
    Choice,
    LocalModel,
    MapGuided,
    Outward,
    Plan,
    Planner,
    Policies,
    Sampled,
    Transitions,
    Utility,
    evaluate,
    policy_posterior,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from local_models import grid_model, random_model

Floats = np.ndarray
SLACK = Outward().slack
HALL = [(0, j) for j in range(5)]


def with_G(G: list[float]) -> tuple[Policies, Floats]:
    """One policy a value, its first action its index modulo 5."""
    policies = Policies(np.stack([np.arange(len(G)) % 5, np.arange(len(G))], axis=1) % 5)
    return policies, np.array(G)


def choose(model: LocalModel, policies: Policies, G: Floats, *, choice: Choice = Outward(), rng: Any) -> int:  # noqa: B008
    return choice.choose(model, policies.actions, G, policy_posterior(G), rng)


@settings(max_examples=30, deadline=None)
@given(st.lists(st.floats(-1e4, 1e4), min_size=1, max_size=9), st.floats(0.0, 50.0))
def test_posterior_is_softmax_once(G: list[float], precision: float) -> None:
    posterior = policy_posterior(G, precision=precision)
    assert posterior.sum() == pytest.approx(1.0)
    best = int(np.argmin(G))
    odds = np.exp(-precision * (np.array(G) - G[best]))
    np.testing.assert_allclose(posterior, odds * posterior[best], atol=1e-12)


def test_posterior_default_precision_is_sixteen() -> None:
    posterior = policy_posterior([0.0, 0.1])
    assert posterior[0] / posterior[1] == pytest.approx(np.exp(1.6))


@pytest.mark.parametrize(
    ("G", "precision", "message"),
    [([], 1.0, "non-empty"), ([np.nan], 1.0, "finite"), ([1.0], -1.0, "precision"), ([1.0], np.inf, "precision")],
)
def test_posterior_bad_input(G: list[float], precision: float, message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        policy_posterior(G, precision=precision)


def test_best_breaks_ties_evenly_and_among_those_that_move_least_where_something_is_preferred() -> None:
    _, G = with_G([1.0, 0.0, 2.0, 1e-10, 0.0, 0.01])
    # policies 1, 3 and 4 are as good as the best; 4 moves twice, the other two once
    policies = Policies(np.array([[4, 4], [0, 4], [1, 4], [2, 4], [0, 0], [3, 4]]))
    rng = np.random.default_rng(0)
    exploring = replace(random_model(0), log_C=np.zeros(4), log_C_place=np.zeros(5), entered=np.full(5, True))
    assert {choose(exploring, policies, G, rng=rng) for _ in range(400)} == {1, 3, 4}
    preferring = replace(exploring, log_C=np.array([0.0, 1.0, 0.0, 0.0]))
    chosen = [choose(preferring, policies, G, rng=rng) for _ in range(400)]
    assert set(chosen) == {1, 3}
    assert 150 < chosen.count(1) < 250


def test_exploring_goes_furthest_out_first_of_what_is_nearly_as_good() -> None:
    corridor = [(0, column) for column in range(6)]
    model = grid_model(corridor, visited=corridor[1:5], at=(0, 2))
    LEFT, RIGHT, STAY = 2, 3, 4  # two moves to either end; the right one is further from the origin
    policies = Policies(np.array([[LEFT, LEFT, STAY], [RIGHT, RIGHT, RIGHT], [STAY, STAY, STAY]]))
    rng = np.random.default_rng(0)

    def chosen(G: list[float], model: LocalModel = model) -> set[int]:
        return {choose(model, policies, with_G(G)[1], rng=rng) for _ in range(20)}

    assert chosen([0.0, 0.9 * SLACK, 0.0]) == {1}
    assert chosen([0.0, 1.1 * SLACK, 0.0]) == {0}
    assert chosen([0.9 * SLACK, 1.1 * SLACK, 0.0]) == {0}  # any frontier before none
    assert chosen([0.0, 0.5 * SLACK, 0.0], replace(model, log_C=np.arange(7.0))) == {2}  # a wish: only the best count
    for nothing_new in ({"entered": np.full(6, True)}, {"position": np.full((6, 2), np.nan)}):
        assert chosen([0.0, 0.5 * SLACK, 0.0], replace(model, **nothing_new)) == {0, 2}


def test_sampled_draws_from_the_posterior() -> None:
    policies, G = with_G([0.0, 0.05, 3.0])
    rng = np.random.default_rng(0)
    model = random_model(0)
    draws = [choose(model, policies, G, choice=Sampled(), rng=rng) for _ in range(600)]
    expected = policy_posterior(G)
    assert np.abs(np.bincount(draws, minlength=3) / 600 - expected).max() < 0.06


@pytest.mark.parametrize("choice", [Best(), Outward(), Sampled()])
def test_choice_repeats_with_its_seed(choice: Choice) -> None:
    policies, G = with_G([0.0] * 30)
    model = random_model(0)

    def draws(seed: int) -> list[int]:
        rng = np.random.default_rng(seed)
        return [choose(model, policies, G, choice=choice, rng=rng) for _ in range(6)]

    assert draws(1) == draws(1)
    assert draws(1) != draws(2)


def test_plan_goes_where_something_is_to_be_learned() -> None:
    model = grid_model(HALL, visited=HALL[:4], at=(0, 2))
    made = Planner().decide(model, rng=np.random.default_rng(0))
    assert isinstance(made, Plan)
    assert made.names[:2] == ["right", "right"]
    assert made.action == made.policy[0] == 3
    assert made.action_probability.shape == (5,)
    assert made.action_probability.sum() == pytest.approx(1.0)
    assert made.action_probability.argmax() == 3
    np.testing.assert_array_equal(made.places, model.places)
    np.testing.assert_allclose(made.expected_free_energy.G, evaluate(model, MapGuided().make(model)).G)


def test_plan_goes_to_its_goal_and_stays() -> None:
    model = grid_model(HALL, visited=HALL, at=(0, 3), goal=(0, 1), look_ahead=4)
    for generator in POLICIES.values():
        made = Planner(policies=generator()).decide(model, rng=np.random.default_rng(0))
        assert made.names == ["left", "left", "stay", "stay"]


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        ({"policies": MapGuided}, "extends PolicyGenerator"),
        ({"choice": "best"}, "extends Choice"),
        ({"terms": ["utility"]}, "extends Term"),
        ({"terms": []}, "terms are none"),
        ({"terms": [Utility(), Utility()]}, "terms are utility, utility"),
    ],
)
def test_a_planner_refuses_parts_of_another_kind(parts: dict[str, Any], message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        Planner(**parts)


@pytest.mark.parametrize("slack", [-1.0, np.inf, np.nan])
def test_outward_refuses_a_slack_that_is_none(slack: float) -> None:
    with pytest.raises(CogmapError, match="outward: slack"):
        Outward(slack=slack)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("look_ahead", 0),
        ("belief", np.full(5, 0.5)),
        ("belief", np.array([np.nan, 1.0, 0.0, 0.0, 0.0])),
        ("A", np.eye(4)),
        ("A", -np.ones((4, 5))),
        ("B", Transitions.of(np.zeros((5, 5, 5)))),
        ("B", Transitions.of(np.full((5, 5, 4), 0.2))),
        ("blocked", np.full((5, 5), 1.5)),
        ("collision_cost", np.inf),
        ("log_C", np.array([0.0, -np.inf, 0.0, 0.0])),
        ("multiplicity", np.zeros(4)),
        ("successor", np.full((5, 5), 5)),
        ("successor", np.full((5, 4), 0)),
        ("information", {"sight": np.zeros((5, 3))}),
        ("information", {"position": np.zeros((4, 9))}),
        ("information", {"transition": np.zeros((5, 2))}),
        ("discount", 0.0),
        ("dropped", 1.0),
        ("entered", np.zeros(3)),
        ("position", np.zeros((5, 1))),
    ],
)
def test_plan_refuses_tables_that_do_not_fit(field: str, value: object) -> None:
    with pytest.raises(CogmapError, match=field):
        Planner().decide(replace(random_model(0), **{field: value}), rng=np.random.default_rng(0))


def test_a_preferred_place_counts_as_a_preference() -> None:
    model = replace(random_model(0), log_C=np.zeros(4), log_C_place=np.zeros(5))
    assert model.indifferent
    assert not replace(model, log_C_place=np.eye(5)[2]).indifferent
