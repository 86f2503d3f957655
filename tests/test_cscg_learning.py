"""Clone-structured models: inference against enumeration, learning against plain dense expectation maximisation."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from cogmap.baselines.cscg import (
    CloneModel,
    Walk,
    baum_welch,
    empty_model,
    filtered,
    log_likelihood,
    log_prior,
    most_probable_path,
    posterior,
    sprinkled,
    viterbi_training,
)
from cogmap.worlds import WorldError
from cscg_models import cases, dense_counts, dense_rows, paths
from hypothesis import given, settings
from hypothesis import strategies as st

few = settings(max_examples=40, deadline=None)


def long_walk(length: int, *, seed: int = 0, sights: int = 4) -> Walk:
    rng = np.random.default_rng(seed)
    return Walk.of(rng.integers(0, sights, length), rng.integers(0, 2, length - 1))


def fresh(walk: Walk, *, kappa: float, clones: int = 3, seed: int = 0, sights: int = 4) -> CloneModel:
    empty = empty_model(observations=sights, clones=clones, actions=2, pseudocount=kappa)
    return sprinkled(empty, np.random.default_rng(seed), among=walk)


@few
@given(cases())
def test_dense_transitions_are_counts_plus_pseudocount(case: tuple[CloneModel, Walk]) -> None:
    model, _ = case
    rows = dense_rows(dense_counts(model), model.pseudocount)
    np.testing.assert_allclose(model.B, rows.transpose(2, 0, 1), rtol=1e-12)
    np.testing.assert_allclose(model.B.sum(axis=0), 1.0)


@few
@given(cases(most=5))
def test_inference_equals_enumeration(case: tuple[CloneModel, Walk]) -> None:
    model, walk = case
    all_paths = paths(model, walk)
    total = sum(value for _, value in all_paths)
    marginals = np.zeros((len(walk), model.clones))
    pairs = np.zeros((len(walk) - 1, model.clones, model.clones))
    for clones, value in all_paths:
        marginals[np.arange(len(walk)), clones] += value / total
        pairs[np.arange(len(walk) - 1), clones[:-1], clones[1:]] += value / total
    found = posterior(model, walk)
    np.testing.assert_allclose(found.marginals, marginals, atol=1e-9)
    np.testing.assert_allclose(found.pairs, pairs, atol=1e-9)
    assert found.log_likelihood == pytest.approx(np.log(total), abs=1e-9)
    assert log_likelihood(model, walk) == pytest.approx(np.log(total), abs=1e-9)
    np.testing.assert_allclose(filtered(model, walk)[-1], marginals[-1], atol=1e-9)


@few
@given(cases(most=5))
def test_viterbi_equals_exhaustive_search(case: tuple[CloneModel, Walk]) -> None:
    model, walk = case
    values = dict(paths(model, walk))
    path, value = most_probable_path(model, walk)
    np.testing.assert_array_equal(path // model.clones, walk.sights)
    assert value == pytest.approx(np.log(max(values.values())), abs=1e-9)
    assert np.log(values[tuple((path % model.clones).tolist())]) == pytest.approx(value, abs=1e-9)


@few
@given(cases(most=30), st.integers(1, 4))
def test_block_sparse_iterations_equal_dense_ones(case: tuple[CloneModel, Walk], iterations: int) -> None:
    model, walk = case
    counts, c = dense_counts(model), model.clones
    for _ in range(iterations):
        rows, new = dense_rows(counts, model.pseudocount), np.zeros_like(counts)
        emits = (np.arange(model.states) // c)[None, :] == walk.sights[:, None]
        alpha, beta = [emits[0] / model.states], [np.ones(model.states)]
        for t, a in enumerate(walk.actions):
            alpha.append(alpha[-1] @ rows[:, a] * emits[t + 1])
            alpha[-1] /= alpha[-1].sum()
        for t, a in reversed(list(enumerate(walk.actions))):
            beta.insert(0, rows[:, a] @ (emits[t + 1] * beta[0]))
            beta[0] /= beta[0].max()
        for t, a in enumerate(walk.actions):
            pair = alpha[t][:, None] * rows[:, a] * (emits[t + 1] * beta[t + 1])[None, :]
            new[:, a] += pair / pair.sum()
        counts = new
    fit = baum_welch(model, walk, iterations=iterations)
    np.testing.assert_allclose(dense_counts(fit.model), counts, atol=1e-9)


@pytest.mark.parametrize("length", [2, 3, 12, 13, 14, 25, 64, 65, 200, 331])
@pytest.mark.parametrize("kappa", [0.0, 1e-9, 0.05])
def test_messages_by_tree_equal_messages_step_by_step(length: int, kappa: float) -> None:
    walk = long_walk(length)
    model = fresh(walk, kappa=kappa)
    found, fit = posterior(model, walk), baum_welch(model, walk, iterations=1)
    assert fit.log_likelihood[0] == pytest.approx(found.log_likelihood, abs=1e-9 * length)
    expected = np.zeros_like(fit.model.counts)
    np.add.at(expected, model.triples.steps(walk), found.pairs)
    np.testing.assert_allclose(fit.model.counts, expected, atol=1e-9)
    assert fit.model.counts.sum() == pytest.approx(length - 1)


@few
@given(st.integers(0, 99), st.sampled_from([0.0, 1e-3, 0.05, 0.5]))
def test_the_objective_never_falls(seed: int, kappa: float) -> None:
    walk = long_walk(60, seed=seed)
    fit = baum_welch(fresh(walk, kappa=kappa, seed=seed), walk, iterations=40)
    assert len(fit.objective) == 40
    slack = 1e-9 * np.abs(fit.objective).max()
    assert np.diff(fit.objective).min() >= -slack
    if kappa == 0.0:
        np.testing.assert_array_equal(fit.objective, fit.log_likelihood)
    final = log_likelihood(fit.model, walk) + log_prior(fit.model)
    assert final >= fit.objective[-1] - slack


def test_the_log_likelihood_alone_may_fall_where_there_are_pseudocounts() -> None:
    """So the objective is not the log-likelihood by another name."""
    falls: list[float] = []
    for seed in range(10):
        walk = long_walk(60, seed=seed)
        fit = baum_welch(fresh(walk, kappa=0.5, seed=seed), walk, iterations=40)
        falls.append(float(np.diff(fit.log_likelihood).min()))
    assert min(falls) < -1e-3


@few
@given(st.integers(0, 99), st.sampled_from([0.0, 1e-4, 0.05]))
def test_viterbi_training_never_falls_and_ends(seed: int, kappa: float) -> None:
    walk = long_walk(60, seed=seed)
    fit = viterbi_training(fresh(walk, kappa=kappa, seed=seed), walk, iterations=100)
    assert np.diff(fit.objective).min(initial=0.0) >= -1e-9 * np.abs(fit.objective).max()
    assert fit.converged
    np.testing.assert_array_equal(most_probable_path(fit.model, walk)[0], fit.path)
    assert dense_counts(fit.model).sum() == len(walk) - 1
    assert not np.modf(fit.model.counts)[0].any()


def test_tolerance_stops_early_and_zero_never() -> None:
    walk = long_walk(60)
    model = fresh(walk, kappa=0.05)
    whole, short = (baum_welch(model, walk, iterations=200, tolerance=value) for value in (0.0, 1e-2))
    assert len(whole.objective) == 200
    assert not whole.converged
    assert short.converged
    assert 1 < len(short.objective) < 200
    gains = np.diff(short.objective) / 59
    assert gains[-1] < 1e-2
    assert (gains[:-1] >= 1e-2).all()


def test_walks_of_one_sight_teach_nothing() -> None:
    walk = Walk.of([1], [])
    model = empty_model(observations=2, clones=2, actions=1, pseudocount=0.1)
    assert len(baum_welch(model, walk, iterations=5).objective) == 0
    assert viterbi_training(model, walk, iterations=5).path.tolist() == [2]
    assert log_likelihood(model, walk) == pytest.approx(np.log(1 / 2))


def test_impossible_walks_are_told_apart_from_unlikely_ones() -> None:
    walk = Walk.of([0, 0, 1], [0, 0])
    only = fresh(Walk.of([0, 0], [0]), kappa=0.0, clones=1, sights=2)
    assert log_likelihood(only, walk) == -np.inf
    with pytest.raises(WorldError, match=r"step 1 of the walk probability 0; use a positive pseudocount"):
        posterior(only, walk)
    assert np.isfinite(log_likelihood(replace(only, pseudocount=1e-9), walk))


@pytest.mark.parametrize(
    ("sights", "actions", "message"),
    [
        ([], [], "one action fewer than sights; got 0 sights and 0 actions"),
        ([0, 1], [], "got 2 sights and 0 actions"),
        ([0, -1], [0], "got a negative number"),
    ],
)
def test_bad_walks(sights: list[int], actions: list[int], message: str) -> None:
    with pytest.raises(WorldError, match=message):
        Walk.of(sights, actions)


def test_bad_models() -> None:
    with pytest.raises(WorldError, match=r"needs clones of 1 or more; got 0"):
        empty_model(observations=2, clones=0, actions=1, pseudocount=0.1)
    with pytest.raises(WorldError, match=r"a pseudocount is a finite number of 0 or more; got nan"):
        empty_model(observations=2, clones=1, actions=1, pseudocount=float("nan"))
    model = empty_model(observations=2, clones=1, actions=1, pseudocount=0.1)
    with pytest.raises(WorldError, match=r"a walk of 3 sights and 1 actions does not fit a model of 2 and 1"):
        baum_welch(model, Walk.of([0, 2], [0]), iterations=1)
