"""Free energy: three decompositions against direct enumeration."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from cogmap.inference import ImpossibleEvidence, free_energy, free_energy_of, infer, is_likelihood
from cogmap.model import CogmapError, FactorGraph
from hypothesis import given, settings
from hypothesis import strategies as st
from test_inference_graphs import evidences, graphs, ladder


def enumerated(graph, q, evidence, likelihoods):
    """All parts of F from sums over assignments; q(labels) is any distribution."""
    total = {"energy": 0.0, "entropy": 0.0, "accuracy": 0.0, "complexity": 0.0}
    z = z_prior = 0.0
    names = [v.name for v in graph.variables]
    rows = []
    for labels in itertools.product(*(v.domain for v in graph.variables)):
        x = dict(zip(names, labels, strict=True))
        if any(x[name] != label for name, label in evidence.items()):
            continue
        prior = likelihood = 1.0
        for factor in graph.factors:
            value = factor.dense()[tuple(v.index(x[v.name]) for v in factor.scope)]
            if factor.name in likelihoods:
                likelihood *= value
            else:
                prior *= value
        z, z_prior = z + prior * likelihood, z_prior + prior
        rows.append((q(x), prior, likelihood))
    for weight, prior, likelihood in rows:
        if weight > 0:
            total["energy"] -= weight * math.log(prior * likelihood)
            total["entropy"] -= weight * math.log(weight)
            total["accuracy"] += weight * math.log(likelihood)
            total["complexity"] += weight * (math.log(weight) - math.log(prior / z_prior))
    return total, math.log(z), math.log(z_prior)


def assert_identities(parts):
    assert parts.free_energy == pytest.approx(parts.energy - parts.entropy, abs=1e-9)
    assert parts.free_energy == pytest.approx(parts.divergence - parts.log_evidence, abs=1e-9)
    split = parts.complexity - parts.accuracy - parts.log_prior_normaliser
    assert parts.free_energy == pytest.approx(split, abs=1e-9)


def assert_matches(parts, expected):
    total, log_z, log_z_prior = expected
    for name, value in total.items():
        assert getattr(parts, name) == pytest.approx(value, abs=1e-9), name
    assert parts.log_evidence == pytest.approx(log_z, abs=1e-9)
    assert parts.log_prior_normaliser == pytest.approx(log_z_prior, abs=1e-9)


@settings(max_examples=40, deadline=None)
@given(graphs(max_variables=4, styles=("dense", "zeros", "one-hot")), st.data())
def test_exact_posterior(graph, data):
    evidence = data.draw(evidences(graph))
    likelihoods = set(data.draw(st.lists(st.sampled_from([f.name for f in graph.factors]), unique=True)))
    try:
        posterior = infer(graph, evidence=evidence)
    except ImpossibleEvidence:
        return
    parts = free_energy(posterior, likelihood=lambda factor: factor.name in likelihoods)
    names = [v.name for v in graph.variables]
    joint = infer(graph, evidence=evidence, engine="brute").joint(*names)

    def q(x):
        return joint[tuple(graph.variable_named(name).index(x[name]) for name in names)]

    assert_identities(parts)
    assert_matches(parts, enumerated(graph, q, evidence, likelihoods))
    assert parts.free_energy == pytest.approx(-posterior.log_evidence, abs=1e-9)
    assert parts.divergence == pytest.approx(0, abs=1e-9)
    assert parts.complexity >= -1e-9


@settings(max_examples=40, deadline=None)
@given(graphs(max_variables=4, styles=("dense",)), st.data())
def test_factorised_approximation(graph, data):
    evidence = data.draw(evidences(graph))
    rng = np.random.default_rng(data.draw(st.integers(0, 1000)))
    q = {v.name: rng.dirichlet(np.ones(v.cardinality)) for v in graph.variables if v.name not in evidence}
    likelihoods = {graph.factors[0].name}
    parts = free_energy_of(graph, q, evidence=evidence, likelihood=lambda f: f.name in likelihoods)

    def weight(x):
        return math.prod(q[name][graph.variable_named(name).index(x[name])] for name in q)

    assert_identities(parts)
    assert_matches(parts, enumerated(graph, weight, evidence, likelihoods))
    assert parts.free_energy >= -parts.log_evidence - 1e-9


def test_the_gap_is_the_approximation_and_closes_where_the_posterior_factorises():
    graph = FactorGraph()
    graph.variable("a", [0, 1])
    graph.variable("b", [0, 1])
    graph.factor("f", ["a"], [0.2, 0.8])
    graph.factor("g", ["b"], [0.3, 0.9])
    exact = free_energy_of(graph, {"a": [0.2, 0.8], "b": [0.25, 0.75]})
    assert exact.divergence == pytest.approx(0, abs=1e-12)
    worse = free_energy_of(graph, {"a": [0.5, 0.5], "b": [0.25, 0.75]})
    kl = 0.5 * math.log(0.5 / 0.2) + 0.5 * math.log(0.5 / 0.8)
    assert worse.divergence == pytest.approx(kl)
    assert worse.free_energy == pytest.approx(-math.log(1.2) + kl)


def test_weight_on_what_the_prior_forbids_is_infinite():
    graph = FactorGraph()
    graph.variable("a", [0, 1])
    graph.factor("prior", ["a"], [1.0, 0.0], kind="prior")
    graph.factor("sight", ["a"], [0.5, 0.5], kind="sight")
    parts = free_energy_of(graph, {"a": [0.5, 0.5]})
    assert parts.free_energy == parts.complexity == parts.divergence == math.inf
    assert parts.accuracy == pytest.approx(math.log(0.5))
    allowed = free_energy_of(graph, {"a": [1.0, 0.0]})
    assert allowed.free_energy == pytest.approx(math.log(2))


def test_a_map_window_splits_by_kind_and_reports_its_prior_normaliser():
    graph = ladder(4, 4, 3, np.random.default_rng(0))
    kinds = {f.kind for f in graph.factors if is_likelihood(graph, f)}
    assert kinds == {"sight", "walls"}
    parts = free_energy(infer(graph))
    assert_identities(parts)
    assert parts.log_prior_normaliser < 0  # a product of experts: place times motion
    assert parts.divergence == pytest.approx(0, abs=1e-9)


def test_unknown_kinds_are_likelihoods_where_they_touch_an_observation():
    graph = FactorGraph()
    graph.variable("rain", [False, True])
    graph.variable("wet", [False, True], observed=True)
    graph.factor("P", ["rain"], [0.8, 0.2])
    graph.factor("P", ["wet", "rain"], [[0.9, 0.2], [0.1, 0.8]])
    parts = free_energy(infer(graph, evidence={"wet": True}))
    posterior = np.array([0.08, 0.16]) / 0.24
    assert parts.accuracy == pytest.approx(posterior @ np.log([0.1, 0.8]))
    assert parts.complexity == pytest.approx(posterior @ np.log(posterior / [0.8, 0.2]))
    assert parts.log_prior_normaliser == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize(
    ("q", "message"),
    [
        ({}, "nothing for 'a'"),
        ({"a": [0.5, 0.6]}, "sum to 1"),
        ({"a": [1.5, -0.5]}, "sum to 1"),
        ({"a": [1.0]}, "2 probabilities"),
        ({"a": [0.5, math.nan]}, "sum to 1"),
        ({"a": [0.5, 0.5], "z": [1.0]}, "no variable 'z'"),
    ],
)
def test_bad_q(q, message):
    graph = FactorGraph()
    graph.variable("a", [0, 1])
    graph.factor("f", ["a"], [0.2, 0.8])
    with pytest.raises(CogmapError, match=message):
        free_energy_of(graph, q)


def test_soft_evidence_is_a_likelihood():
    graph = FactorGraph()
    a = graph.variable("a", [0, 1])
    graph.factor("prior", ["a"], [0.2, 0.8], kind="prior")
    soft = {"a": {0: 0.9, 1: 0.3}}
    for parts in (
        free_energy(infer(graph, evidence=soft)),
        free_energy(infer(graph.observe_all(soft))),
        free_energy_of(graph, {a: np.array([0.18, 0.24]) / 0.42}, evidence=soft),
    ):
        assert_identities(parts)
        assert parts.free_energy == pytest.approx(-math.log(0.42))
        assert parts.log_prior_normaliser == pytest.approx(0, abs=1e-12)
        assert parts.accuracy == pytest.approx((0.18 * math.log(0.9) + 0.24 * math.log(0.3)) / 0.42)
