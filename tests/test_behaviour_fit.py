from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from cogmap.behaviour import (
    MODELS,
    ChoiceModel,
    Choices,
    Ground,
    Habit,
    Home,
    Novelty,
    Recency,
    Value,
    choices_of,
    fit,
    fit_group,
    folds_of,
    follow_route,
    held_out,
    models_named,
    preferred,
    simulate,
)
from cogmap.model import CogmapError
from cogmap.worlds import load_world

EVERYTHING = ChoiceModel("everything", (Habit(2), Novelty(), Recency(), Home(), Value()))


@cache
def ground() -> Ground:
    return Ground.of(load_world("4x4").chart, home=(0, 0))


@cache
def some_choices(model: str = "novelty", steps: int = 200, seed: int = 1, agent: bool = True) -> Choices:
    route = simulate(MODELS[model], ground(), steps=steps, seed=seed)
    prospects = follow_route(route, ground(), look_ahead=3).prospects if agent else None
    return choices_of(route, ground(), prospects=prospects)


@pytest.mark.parametrize("model", [*MODELS.values(), EVERYTHING], ids=lambda model: model.name)
def test_probabilities_sum_to_one_and_their_derivatives_are_exact(model: ChoiceModel) -> None:
    prepared, rng = model.prepare(some_choices()), np.random.default_rng(0)
    values = np.array([rng.uniform(*parameter.typical) for parameter in model.parameters])
    p = model.probabilities(prepared, values)
    assert p.sum(axis=1) == pytest.approx(1.0)
    assert not p[~prepared.open].any()
    nats, slope = model.log_likelihood(prepared, values)
    assert nats == pytest.approx(np.log(p[np.arange(len(p)), prepared.choices.taken]))
    _, prior_slope = model.log_prior(values)
    for i in range(len(values)):
        step = np.eye(len(values))[i] * 1e-6
        both = [model.log_likelihood(prepared, values + sign * step)[0] for sign in (1, -1)]
        assert slope[:, i] == pytest.approx((both[0] - both[1]) / 2e-6, abs=1e-5), model.parameters[i].name
        priors = [model.log_prior(values + sign * step)[0] for sign in (1, -1)]
        assert prior_slope[i] == pytest.approx((priors[0] - priors[1]) / 2e-6, abs=1e-5)


def test_uniform_is_uniform() -> None:
    choices = some_choices(agent=False)
    made, _ = fit(MODELS["uniform"], [MODELS["uniform"].prepare(choices)])
    assert made.log_likelihood == pytest.approx(-np.log(choices.open.sum(axis=1)).sum())
    assert (made.parameters, made.choices) == ({}, len(choices))


def test_novelty_counts_faded_visits() -> None:
    choices, model = some_choices(agent=False), ChoiceModel("n", (Novelty(),))
    nats = Novelty().weigh(Novelty().prepare(choices), np.array([1.0, 0.1]))[0]
    for row in (3, 40):
        for way in range(3):
            ages = choices.step[row] - np.flatnonzero(
                choices.places[: choices.step[row] + 1] == choices.target[row, way]
            )
            assert nats[row, way] == pytest.approx(-np.log1p((0.9**ages).sum()))
            left = 0.8 ** ages.min() if len(ages) else 0.0
            assert Recency().weigh(Recency().prepare(choices), np.array([2.0, 0.2]))[0][row, way] == pytest.approx(
                -2 * left
            )
    assert [parameter.name for parameter in model.parameters] == ["novelty", "forgetting", "lapse"]


def test_parameters_are_recovered_within_their_errors() -> None:
    truth = {"habit right": 0.8, "habit left": -0.7, "habit back": -1.0, "lapse": 0.1}
    route = simulate(MODELS["habit"], ground(), steps=4000, parameters=truth, seed=3)
    made, _ = fit(MODELS["habit"], [MODELS["habit"].prepare(choices_of(route, ground()))])
    for name, value in truth.items():
        error = made.standard_errors[name]
        assert error is not None
        assert 0.0 < error < 0.5
        assert abs(made.parameters[name] - value) < 3.0 * error


def test_individuals_are_drawn_to_the_group_and_held_out_bouts_are_never_seen() -> None:
    model = MODELS["habit"]
    params = ({"habit right": 1.0}, {"habit right": -1.0})
    routes = [simulate(model, ground(), steps=600, parameters=given, seed=i) for i, given in enumerate(params)]
    prepared = [model.prepare(choices_of(route, ground())) for route in routes]
    _, alone = fit_group(model, prepared, level="alone", errors=False)
    _, around = fit_group(model, prepared, errors=False)
    _, (same, too) = fit_group(model, prepared, level="pooled", errors=False)
    spread = [parameter.spread for parameter in model.parameters]
    assert same.tolist() == too.tolist()
    for own, drawn in zip(alone, around, strict=True):
        assert 0.0 < np.linalg.norm((drawn - same) / spread) < 0.8 * np.linalg.norm((own - same) / spread)
    folds = folds_of([one.choices for one in prepared], 3)
    for one, numbers in zip(prepared, folds, strict=True):
        for bout in np.unique(one.choices.bout):
            assert len(set(numbers[one.choices.bout == bout].tolist())) == 1
    held = held_out(model, prepared, 1, folds)
    rest = [(numbers != 1).astype(float) for numbers in folds]
    _, values = fit_group(model, prepared, weights=rest, starts=1, errors=False)
    for nats, numbers, one, theirs in zip(held, folds, prepared, values, strict=True):
        assert (np.isnan(nats) == (numbers != 1)).all()
        assert nats[numbers == 1] == pytest.approx(model.log_likelihood(one, theirs)[0][numbers == 1])


def test_one_bout_alone_is_held_out_in_runs() -> None:
    choices = some_choices(agent=False)
    one = Choices(
        **{name: getattr(choices, name) for name in choices.__dataclass_fields__} | {"bout": choices.bout * 0}
    )
    (numbers,) = folds_of([one], 4)
    assert (np.diff(numbers) >= 0).all()
    assert sorted(set(numbers.tolist())) == [0, 1, 2, 3]


def test_the_simplest_model_within_an_error_of_the_best_is_preferred() -> None:
    models = models_named(["uniform", "habit", "habit2"])
    clear = {
        "uniform": [[10, -11.0]] * 4,
        "habit": [[10, -9.0], [10, -9.2]] * 2,
        "habit2": [[10, -9.0], [10, -9.1]] * 2,
    }
    assert preferred(clear, models) == "habit2"
    chance = clear | {"habit2": [[10, -7.0], [10, -11.1]] * 2}
    assert preferred(chance, models) == "habit"


def test_bad_input() -> None:
    model, choices = MODELS["habit"], some_choices(agent=False)
    with pytest.raises(CogmapError, match="no parameter 'charm'"):
        model.values({"charm": 1.0})
    with pytest.raises(CogmapError, match=r"lapse: 1\.5 is out of bounds; give a number from 0\.0001 to 0\.9999"):
        simulate(model, ground(), steps=5, parameters={"lapse": 1.5})
    with pytest.raises(CogmapError, match="no model is called 'hope'"):
        models_named(["hope"])
    with pytest.raises(CogmapError, match="no agent has followed this walk"):
        MODELS["cogmap"].prepare(choices)
    with pytest.raises(CogmapError, match="there are no choices"):
        fit(model, [])
    with pytest.raises(CogmapError, match="level is 'herd'"):
        fit_group(model, [model.prepare(choices)], level="herd")
    with pytest.raises(CogmapError, match="folds is 1"):
        folds_of([choices], 1)
    with pytest.raises(CogmapError, match="starts is 0"):
        fit(model, [model.prepare(choices)], starts=0)
    with pytest.raises(CogmapError, match="steps is 0"):
        simulate(model, ground(), steps=0)
