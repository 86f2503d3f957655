"""Approximations: exact on trees, near on weak grids, honest where they fail."""

from __future__ import annotations

import math

import numpy as np
import pytest
from cogmap.inference import ImpossibleEvidence, Loopy, Sampling, infer
from cogmap.model import CogmapError, FactorGraph, sparse_values
from hypothesis import given, settings
from hypothesis import strategies as st
from test_inference_graphs import evidences, graphs, ladder


def ising(side, coupling, field, seed, *, frustrated=False):
    """A grid of spins; those of one row have one time, so that exact elimination goes row after row."""
    rng = np.random.default_rng(seed)
    graph = FactorGraph()
    for r, c in np.ndindex(side, side):
        graph.variable(f"x{r},{c}", (-1, 1), time=r)
        h = field * rng.uniform(-1, 1)
        graph.factor("h", [f"x{r},{c}"], np.exp([-h, h]))
    for r, c in np.ndindex(side, side):
        for i, j in ((r + 1, c), (r, c + 1)):
            if i < side and j < side:
                J = coupling * (rng.choice([-1, 1]) if frustrated else rng.uniform(0, 1))
                graph.factor("J", [f"x{r},{c}", f"x{i},{j}"], np.exp([[J, -J], [-J, J]]))
    return graph


@st.composite
def trees(draw):
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    graph = FactorGraph()
    cards = draw(st.lists(st.integers(1, 3), min_size=1, max_size=6))
    for i, card in enumerate(cards):
        graph.variable(f"x{i}", range(card))
        graph.factor("f", [f"x{i}"], rng.random(card))
        if i:
            j = int(rng.integers(i))
            values = rng.random((card, cards[j]))
            values[rng.random(values.shape) < 0.2] = 0
            graph.factor("g", [f"x{i}", f"x{j}"], values)
    return graph


@settings(max_examples=80, deadline=None)
@given(trees(), st.data())
def test_loopy_propagation_is_exact_on_trees(graph, data):
    evidence = data.draw(evidences(graph))
    try:
        truth = infer(graph, evidence=evidence)
    except ImpossibleEvidence:
        return
    found = infer(graph, evidence=evidence, engine="loopy")
    assert found.approximation.converged
    assert found.log_evidence == pytest.approx(truth.log_evidence, abs=1e-6)
    for variable in graph.variables:
        np.testing.assert_allclose(found.marginal(variable), truth.marginal(variable), atol=1e-7)
    for factor in graph.factors:
        np.testing.assert_allclose(found.joint(*factor.scope), truth.joint(*factor.scope), atol=1e-7)


@pytest.mark.parametrize("seed", range(3))
def test_loopy_propagation_on_weak_grids(seed):
    graph = ising(12, 0.2, 0.5, seed)
    truth, found = infer(graph), infer(graph, engine="loopy")
    assert found.approximation.converged
    assert not found.exact
    assert "converged" in repr(found)
    worst = max(abs(found.marginal(v) - truth.marginal(v)).max() for v in graph.variables)
    assert worst < 0.01
    assert found.log_evidence == pytest.approx(truth.log_evidence, abs=0.05)


def test_loopy_propagation_says_where_it_does_not_converge():
    graph = ising(8, 2.0, 0.1, 0, frustrated=True)
    found = infer(graph, engine=Loopy(iterations=300))
    assert not found.approximation.converged
    assert found.approximation.iterations == 300
    assert found.approximation.change > 1e-9
    assert "NOT CONVERGED" in repr(found)
    one = infer(graph, engine=Loopy(iterations=1))
    assert not one.approximation.converged


def test_loopy_propagation_refuses_what_it_does_not_know():
    graph = ising(3, 0.2, 0.5, 0)
    found = infer(graph, engine="loopy")
    asks = (
        lambda: found.joint("x0,0", "x2,2"),
        lambda: found.entropy,
        lambda: found.sample(3, rng=0),
        lambda: found.standard_error("x0,0"),
    )
    for ask in asks:
        with pytest.raises(CogmapError, match="sampling"):
            ask()
    zero = FactorGraph()
    zero.variable("a", (0, 1))
    zero.factor("f", ["a"], [1.0, 0.0])
    zero.factor("g", ["a"], [0.0, 1.0])
    with pytest.raises(ImpossibleEvidence, match=r"f\(a\), g\(a\)"):
        infer(zero, engine="loopy")


def test_loopy_propagation_keeps_what_is_small():
    graph = FactorGraph()
    graph.variable("cause", (0, 1))
    for i, label in enumerate([0] * 345 + [1] * 346):
        graph.variable(f"r{i}", (0, 1))
        graph.factor("P", [f"r{i}", "cause"], [[0.9, 0.1], [0.1, 0.9]])
        graph = graph.observe(f"r{i}", label)
    assert infer(graph, engine="loopy").probability("cause", 1) == pytest.approx(0.9, abs=1e-6)
    assert infer(graph, engine="sampling").probability("cause", 1) == pytest.approx(0.9, abs=0.02)


@settings(max_examples=60, deadline=None)
@given(graphs(max_variables=5, styles=("dense", "zeros", "one-hot")), st.data())
def test_samples_estimate_within_their_errors(graph, data):
    evidence = data.draw(evidences(graph))
    try:
        truth = infer(graph, evidence=evidence, engine="brute")
    except ImpossibleEvidence:
        with pytest.raises(CogmapError):
            infer(graph, evidence=evidence, engine="sampling")
        return
    for largest in (2e4, 1):
        try:
            found = infer(graph, evidence=evidence, engine=Sampling(samples=4000, largest=largest))
        except CogmapError as error:
            if largest > 1 or "none of 4000 samples" not in str(error):
                raise
            continue
        report = found.approximation
        if largest > 1:  # nothing was relaxed: samples of the posterior itself
            assert report.effective_samples == pytest.approx(4000)
            assert found.log_evidence == pytest.approx(truth.log_evidence, abs=1e-9)
        assert truth.log_evidence <= report.log_evidence_bound + 1e-9
        if report.effective_samples < 500:
            continue
        assert abs(found.log_evidence - truth.log_evidence) <= 6 * report.log_evidence_error + 2e-3
        for variable in graph.variables:
            error = found.standard_error(variable)
            assert (abs(found.marginal(variable) - truth.marginal(variable)) <= 6 * error + 2e-3).all()


def test_standard_errors_shrink_and_are_of_the_right_size():
    graph = ising(6, 0.5, 0.5, 0, frustrated=True)
    truth = infer(graph)
    ratios, sizes = [], []
    for samples in (1000, 16_000):
        for seed in range(4):
            found = infer(graph, engine=Sampling(samples=samples, seed=seed, largest=16))
            errors = [found.standard_error(v)[1] for v in graph.variables]
            ratios += [
                (found.marginal(v)[1] - truth.marginal(v)[1]) / error
                for v, error in zip(graph.variables, errors, strict=True)
            ]
            sizes.append(np.mean(errors))
    assert 0.7 < np.sqrt(np.mean(np.square(ratios))) < 1.4
    assert np.mean(sizes[4:]) == pytest.approx(np.mean(sizes[:4]) / 4, rel=0.2)
    assert found.approximation.samples == 16_000
    assert found.joint("x0,0", "x5,5").sum() == pytest.approx(1)
    assert len(found.sample(10, rng=0)["x0,0"]) == 10
    with pytest.raises(CogmapError, match="entropy"):
        _ = found.entropy


def test_exact_posteriors_have_no_error():
    assert not infer(ladder(2, 3, 3, np.random.default_rng(0))).standard_error("s0").any()


@pytest.mark.parametrize("engine", ["loopy", "sampling"])
def test_what_is_too_large_is_approximated(engine):
    graph = FactorGraph()
    rng = np.random.default_rng(0)
    for i in range(40):
        graph.variable(f"x{i}", (0, 1))
        for j in range(i):
            graph.factor("f", [f"x{i}", f"x{j}"], np.exp(rng.uniform(-0.05, 0.05, (2, 2))))
    with pytest.raises(CogmapError, match="engine='loopy'"):
        infer(graph)
    found = infer(graph, engine=engine)
    assert found.marginal("x0").sum() == pytest.approx(1)
    assert math.isfinite(found.log_evidence)


def test_sparse_factors_are_approximated_too():
    rows = np.unique(np.random.default_rng(0).integers(0, 2, (30, 20)), axis=0)
    graph = FactorGraph()
    names = [graph.variable(f"b{i}", (0, 1)).name for i in range(20)]
    graph.factor("S", names, sparse_values([2] * 20, rows, np.ones(len(rows))))
    for engine in ("loopy", "sampling"):
        found = infer(graph, engine=engine)
        assert found.probability("b3", 1) == pytest.approx(rows[:, 3].mean(), abs=0.02)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Loopy(damping=1.0), "damping"),
        (lambda: Loopy(iterations=0), "iteration"),
        (lambda: Loopy(tolerance=0.0), "tolerance"),
        (lambda: Sampling(samples=1), "2 samples"),
        (lambda: Sampling(largest=0.5), "largest"),
    ],
)
def test_bad_options(make, message):
    with pytest.raises(CogmapError, match=message):
        make()
