"""All engines against brute force: evidence, marginals, joints, entropy, most probable assignment."""

from __future__ import annotations

import itertools
import math
import pickle

import numpy as np
import pytest
from cogmap.inference import ImpossibleEvidence, infer, log_product, most_probable
from cogmap.model import CogmapError, FactorGraph
from hypothesis import given, settings
from hypothesis import strategies as st
from test_inference_graphs import evidences, graphs, ladder

EXACT = ("numpy", "gtsam")


def by_hand(graph, evidence):
    """P(x, evidence) of every assignment, straight from the definition, in fractions of log space."""
    logs = {}
    for labels in itertools.product(*(v.domain for v in graph.variables)):
        x = dict(zip((v.name for v in graph.variables), labels, strict=True))
        if all(x[name] == label for name, label in evidence.items()):
            logs[labels] = log_product(graph, x)
    return logs


def assert_equal_posteriors(found, truth):
    names = [v.name for v in truth.graph.variables]
    assert found.log_evidence == pytest.approx(truth.log_evidence, abs=1e-9)
    for name in names:
        np.testing.assert_allclose(found.marginal(name), truth.marginal(name), atol=1e-9)
    for size in (2, 3):
        for some in itertools.permutations(names, size) if size == 2 else itertools.combinations(names, size):
            np.testing.assert_allclose(found.joint(*some), truth.joint(*some), atol=1e-9)


@settings(max_examples=40, deadline=None)
@given(graphs(max_variables=5), st.data())
def test_brute_force_is_the_definition(graph, data):
    evidence = data.draw(evidences(graph))
    logs = by_hand(graph, evidence)
    top = max(logs.values())
    if top == -math.inf:
        with pytest.raises(ImpossibleEvidence):
            infer(graph, evidence=evidence, engine="brute")
        return
    posterior = infer(graph, evidence=evidence, engine="brute")
    z = math.fsum(math.exp(value - top) for value in logs.values())
    assert posterior.log_evidence == pytest.approx(top + math.log(z), abs=1e-9)
    first = np.zeros(graph.variables[0].cardinality)
    for labels, value in logs.items():
        first[graph.variables[0].index(labels[0])] += math.exp(value - top) / z
    np.testing.assert_allclose(posterior.marginal("x0"), first, atol=1e-9)


@pytest.mark.parametrize("engine", EXACT)
@settings(max_examples=60, deadline=None)
@given(graphs(), st.data())
def test_engines_agree_with_brute_force(engine, graph, data):
    evidence = data.draw(evidences(graph))
    try:
        truth = infer(graph, evidence=evidence, engine="brute")
    except ImpossibleEvidence:
        with pytest.raises(ImpossibleEvidence):
            infer(graph, evidence=evidence, engine=engine)
        with pytest.raises(ImpossibleEvidence):
            most_probable(graph, evidence=evidence, engine=engine)
        return
    found = infer(graph, evidence=evidence, engine=engine)
    assert_equal_posteriors(found, truth)
    assert found.entropy == pytest.approx(truth.entropy, abs=1e-9)
    best = most_probable(graph, evidence=evidence, engine=engine)
    expected = max(by_hand(graph, evidence).values())
    assert best.log_probability == pytest.approx(expected, abs=1e-9)
    assert log_product(graph, best.assignment) == pytest.approx(expected, abs=1e-9)
    assert {name: best.assignment[name] for name in evidence} == evidence


@pytest.mark.parametrize("engine", EXACT)
@settings(max_examples=30, deadline=None)
@given(graphs(timed=False), st.data())
def test_any_order_gives_the_same_answer(engine, graph, data):
    order = data.draw(st.permutations([v.name for v in graph.variables]))
    try:
        truth = infer(graph, engine="brute")
    except ImpossibleEvidence:
        return
    assert_equal_posteriors(infer(graph, engine=engine, order=order), truth)
    best = most_probable(graph, engine=engine, order=order)
    assert best.log_probability == pytest.approx(most_probable(graph, engine="brute").log_probability, abs=1e-9)


@pytest.mark.parametrize("engine", EXACT)
@pytest.mark.parametrize("one_hot", [True, False])
def test_short_ladders_equal_brute_force(engine, one_hot):
    graph = ladder(3, 4, 3, np.random.default_rng(1), one_hot=one_hot)
    pairs = [("s1", "s0"), ("s2", "p2"), ("s2", "s1", "moved2"), ("p0", "moved2")]
    truth = infer(graph, engine="brute")
    found = infer(graph, engine=engine, pairs=pairs)
    for names in [*pairs, ("s0", "o1", "s2")]:
        np.testing.assert_allclose(found.joint(*names), truth.joint(*names), atol=1e-9)
    assert found.log_evidence == pytest.approx(truth.log_evidence, abs=1e-9)
    assert found.entropy == pytest.approx(truth.entropy, abs=1e-9)
    best, expected = (most_probable(graph, engine=each) for each in (engine, "brute"))
    assert best.assignment == expected.assignment
    assert best.log_probability == pytest.approx(expected.log_probability, abs=1e-9)


@pytest.mark.parametrize("one_hot", [True, False])
def test_engines_agree_on_two_hundred_steps_without_underflow(one_hot):
    graph = ladder(200, 4, 3, np.random.default_rng(2), one_hot=one_hot)
    found, other = (infer(graph, engine=engine) for engine in EXACT)
    assert found.log_evidence < -1000  # exp of it is 0 in floating point
    assert found.log_evidence == pytest.approx(other.log_evidence, abs=1e-8)
    for t in (0, 1, 100, 198, 199):
        for names in [(f"s{t}",), (f"p{t}",), (f"s{t}", f"p{t}"), (f"s{max(t, 1)}", f"s{max(t, 1) - 1}")]:
            np.testing.assert_allclose(found.joint(*names), other.joint(*names), atol=1e-9)
            assert found.joint(*names).sum() == pytest.approx(1, abs=1e-9)
    best, second = (most_probable(graph, engine=engine) for engine in EXACT)
    assert best.log_probability == pytest.approx(second.log_probability, abs=1e-8)
    assert best.log_probability <= found.log_evidence


def test_a_long_chain_equals_the_forward_algorithm():
    rng = np.random.default_rng(3)
    graph, log_z, message = FactorGraph(), 0.0, np.ones(3) / 3
    for t in range(300):
        graph.variable(f"s{t}", range(3), time=t)
        table = rng.random((3, 3)) * 1e-5 if t else np.ones((3, 1))
        likelihood = rng.random(3) * 1e-5
        graph.factor("A", [f"s{t}"], likelihood)
        if t:
            graph.factor("B", [f"s{t}", f"s{t - 1}"], table)
            message = table @ message
        else:
            graph.factor("prior", ["s0"], message)
        message = likelihood * message
        log_z += math.log(message.sum())
        message = message / message.sum()
    for engine in EXACT:
        posterior = infer(graph, engine=engine)
        assert posterior.log_evidence == pytest.approx(log_z, abs=1e-8)
        np.testing.assert_allclose(posterior.marginal("s299"), message, atol=1e-9)


@pytest.mark.parametrize("engine", EXACT)
def test_distant_joints_are_exact(engine):
    rng = np.random.default_rng(4)
    graph = FactorGraph()
    product = np.eye(3)
    for t in range(40):
        graph.variable(f"s{t}", range(3), time=t)
        if t:
            table = rng.dirichlet(np.ones(3), size=3).T
            graph.factor("B", [f"s{t}", f"s{t - 1}"], table)
            product = table @ product
    np.testing.assert_allclose(infer(graph, engine=engine).joint("s39", "s0"), product / 3, atol=1e-9)


@pytest.mark.parametrize("engine", ["numpy", "gtsam", "brute"])
def test_a_graph_of_known_variables_only(engine):
    graph = FactorGraph()
    graph.variable("a", ["only"])
    graph.variable("b", [0, 1], observed=True)
    graph.factor("f", ["b", "a"], [[0.25], [0.5]])
    posterior = infer(graph, evidence={"b": 1}, engine=engine)
    assert posterior.log_evidence == pytest.approx(math.log(0.5))
    np.testing.assert_array_equal(posterior.joint("b", "a"), [[0], [1]])
    assert posterior.entropy == pytest.approx(0)
    assert most_probable(graph, evidence={"b": 1}, engine=engine).assignment == {"a": "only", "b": 1}


def test_posteriors_of_every_engine_pickle():
    for engine in ("numpy", "gtsam", "brute"):
        posterior = infer(ladder(2, 3, 3, np.random.default_rng(0)), engine=engine)
        again = pickle.loads(pickle.dumps(posterior))
        np.testing.assert_allclose(again.joint("s1", "s0"), posterior.joint("s1", "s0"))


def test_zeros_in_opposite_tails_do_not_underflow():
    graph = FactorGraph()
    graph.variable("x", [0, 1])
    for name, low in (("f", 0), ("g", 1), ("h", 0)):
        graph.factor(name, ["x"], np.where(np.arange(2) == low, 1e-280, 1.0))
    assert infer(graph).log_evidence == pytest.approx(math.log(1e-280), abs=1e-9)


@pytest.mark.parametrize("engine", ["numpy", "gtsam", "brute"])
@pytest.mark.parametrize("size", [1e200, 1e-200])
def test_huge_and_tiny_tables_are_carried_in_the_log(engine, size):
    graph = FactorGraph()
    graph.variable("x", [0, 1])
    graph.variable("y", [0, 1])
    for name in "fgh":
        graph.factor(name, ["x"], np.array([1.0, 3.0]) * size)
    graph.factor("k", ["x", "y"], np.array([[1.0, 2.0], [3.0, 4.0]]) * size)
    posterior = infer(graph, engine=engine)
    assert posterior.log_evidence == pytest.approx(4 * math.log(size) + math.log(3 + 27 * 7), abs=1e-9)
    np.testing.assert_allclose(posterior.marginal("x"), [3 / 192, 189 / 192], atol=1e-12)
    assert most_probable(graph, engine=engine).assignment == {"x": 1, "y": 1}


def test_gtsam_says_so_where_it_underflows():
    graph = FactorGraph()
    graph.variable("x", [0, 1])
    graph.variable("y", [0, 1])
    graph.factor("k", ["x", "y"], np.full((2, 2), 0.5))
    for name, low in (("f", 0), ("g", 1), ("h", 0), ("i", 1)):
        graph.factor(name, ["x"], np.where(np.arange(2) == low, 1e-280, 1.0))
    assert infer(graph).log_evidence == pytest.approx(math.log(2e-280) * 2 - math.log(2), abs=1e-9)
    with pytest.raises(CogmapError, match="try engine='numpy'") as caught:
        infer(graph, engine="gtsam")
    assert not isinstance(caught.value, ImpossibleEvidence)


def test_expected_counts_and_logs():
    graph = ladder(3, 4, 3, np.random.default_rng(5))
    posterior = infer(graph)
    factor = graph.factor_named("B_s(s2, s1, moved2)")
    joint = posterior.joint("s2", "s1", "moved2")
    assert posterior.expected_log(factor) == pytest.approx(float((joint * np.log(factor.dense())).sum()))
    assert posterior.probability("moved1", True) == pytest.approx(posterior.marginal("moved1")[1])


def test_learning_from_expected_counts_recovers_a_coin():
    from cogmap.model import ConditionalTable

    table = ConditionalTable([1.0, 1.0])
    graph = FactorGraph()
    for t in range(3):
        graph.variable(f"x{t}", ("h", "t"), time=t)
        graph.conditional(f"x{t}", [], table)
    counts = infer(graph, evidence={"x0": "h", "x1": "h"}).expected_counts(table)
    np.testing.assert_allclose(counts, [2.5, 0.5])
    table.learn(counts)
    np.testing.assert_allclose(graph.refreshed().factors[0].dense(), [3.5 / 5, 1.5 / 5])
