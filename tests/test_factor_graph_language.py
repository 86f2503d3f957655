"""Declaring factor graphs: variables, factors, conditionals, evidence, bad input."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from cogmap.inference import infer
from cogmap.model import (
    CogmapError,
    ConditionalTable,
    Factor,
    FactorGraph,
    LearnableTable,
    SparseValues,
    Variable,
    sparse_values,
)
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays


def sprinkler():
    graph = FactorGraph()
    for name in ("cloudy", "sprinkler", "rain", "wet"):
        graph.variable(name, (False, True))
    graph.factor("P", ["cloudy"], [0.5, 0.5])
    graph.factor("P", ["sprinkler", "cloudy"], [[0.5, 0.9], [0.5, 0.1]])
    graph.factor("P", ["rain", "cloudy"], [[0.8, 0.2], [0.2, 0.8]])
    wet = np.array([[0.0, 0.9], [0.9, 0.99]])
    graph.factor("P", ["wet", "sprinkler", "rain"], np.stack([1 - wet, wet]))
    return graph


def test_the_textbook_sprinkler():
    posterior = infer(sprinkler(), evidence={"wet": True})
    assert math.exp(posterior.log_evidence) == pytest.approx(0.6471)
    assert posterior.probability("sprinkler", True) == pytest.approx(0.2781 / 0.6471)
    assert posterior.probability("rain", True) == pytest.approx(0.4581 / 0.6471)


def test_observe_gives_a_new_graph_and_leaves_the_old_one():
    graph = sprinkler()
    wet = graph.observe("wet", True)
    assert dict(graph.evidence) == {}
    assert dict(wet.evidence) == {"wet": True}
    assert infer(wet).log_evidence == infer(graph, evidence={"wet": True}).log_evidence
    with pytest.raises(CogmapError, match="already"):
        wet.observe("wet", False)
    with pytest.raises(CogmapError, match="no label 'soaked'"):
        graph.observe("wet", "soaked")
    with pytest.raises(TypeError):
        wet.evidence["rain"] = True


def test_the_graph_reads_like_its_equation():
    graph = FactorGraph()
    graph.variable("s0", range(2), time=0)
    graph.variable("s1", range(2), time=1)
    graph.variable("o1", ["red"], time=1, observed=True)
    graph.factor("prior", ["s0"], [1, 1])
    graph.factor("B_s", ["s1", "s0"], np.eye(2))
    assert repr(graph) == "P(s0, s1 | o1='red') ∝ prior(s0) · B_s(s1, s0)"
    assert repr(graph.observe("s0", 1)) == "P(s1 | s0=1, o1='red') ∝ prior(s0) · B_s(s1, s0)"
    assert repr(FactorGraph()) == "P() ∝ 1"


def test_long_graphs_print_short():
    graph = FactorGraph()
    for i in range(50):
        graph.variable(f"x{i}", [0, 1])
        graph.factor("f", [f"x{i}"], [1, 1])
    assert "… (50 in all)" in repr(graph)
    assert len(repr(graph)) < 400


def test_looking_things_up():
    graph = sprinkler()
    assert graph.variable_named("rain") is graph.variables[2]
    assert graph.factor_named("P(rain, cloudy)") is graph.factors[2]
    with pytest.raises(CogmapError, match="4 factors are called 'P'"):
        graph.factor_named("P")
    with pytest.raises(CogmapError, match="no variable 'snow'; it has cloudy"):
        graph.variable_named("snow")
    with pytest.raises(CogmapError, match="none yet"):
        FactorGraph().variable_named("snow")


@pytest.mark.parametrize(
    ("name", "domain", "message"),
    [
        ("", (1,), "non-empty"),
        (3, (1,), "non-empty"),
        ("x", (), "empty"),
        ("x", "abc", "string"),
        ("x", {1, 2}, "a set"),
        ("x", frozenset({1}), "a set"),
        ("x", (1, 2, 1), "1 stands twice"),
        ("x", (1, True), "twice"),
        ("x", ([1],), "hashable"),
        ("x", 5, "sequence"),
    ],
)
def test_bad_variables(name, domain, message):
    with pytest.raises(CogmapError, match=message):
        Variable(name, domain)


def test_labels_may_be_anything_hashable():
    labels = ((0, 1), "red", None, frozenset({2}), 2.5)
    variable = Variable("x", labels)
    assert [variable.index(label) for label in labels] == [0, 1, 2, 3, 4]
    with pytest.raises(CogmapError, match="no label"):
        variable.index([0])


@pytest.mark.parametrize(
    ("scope", "values", "message"),
    [
        (["rain"], [1.0, 2.0, 3.0], r"shape \(3,\).*have \(2,\)"),
        (["rain"], [1.0, math.nan], "NaN"),
        (["rain"], [1.0, math.inf], "infinite"),
        (["rain"], [1.0, -0.1], "negative"),
        (["rain"], ["a", "b"], "no array of numbers"),
        (["rain"], [[1.0], [1.0, 2.0]], "no array of numbers"),
        ([], 1.0, "at least one variable"),
        (["rain", "rain"], np.ones((2, 2)), "none twice"),
        (["snow"], [1.0, 1.0], "no variable 'snow'"),
        ("rain", [1.0, 1.0], "string"),
        ([Variable("rain", (1, 2))], [1.0, 1.0], "not of this graph"),
        (["rain", "cloudy"], np.ones((2, 2)), "already"),
    ],
)
def test_bad_factors(scope, values, message):
    graph = sprinkler()
    with pytest.raises(CogmapError, match=message) as caught:
        graph.factor("P", scope, values)
    assert "\n" not in str(caught.value)
    assert len(graph.factors) == 4


def test_names_are_taken_once():
    graph = sprinkler()
    with pytest.raises(CogmapError, match="taken"):
        graph.variable("rain", (0, 1))
    with pytest.raises(CogmapError, match="taken"):
        graph.variable("P(cloudy)", (0, 1))
    with pytest.raises(CogmapError, match="empty"):
        graph.factor("", ["rain"], [1, 1])


def test_factors_keep_their_own_values():
    values = np.array([0.5, 0.5])
    graph = FactorGraph()
    graph.variable("x", (0, 1))
    factor = graph.factor("f", ["x"], values, kind="prior", equation="P(x)")
    values[0] = 9
    np.testing.assert_array_equal(factor.dense(), [0.5, 0.5])
    with pytest.raises(ValueError, match="read-only"):
        factor.dense()[0] = 1
    assert (factor.label, factor.shape, factor.kind, factor.equation) == ("f(x)", (2,), "prior", "P(x)")


@given(arrays(float, (3, 2, 2), elements=st.sampled_from([0.0, 0.5, 2.0])))
def test_sparse_values_are_the_dense_ones(values):
    indices = np.argwhere(values > 0)
    sparse = sparse_values(values.shape, indices, values[tuple(indices.T)])
    np.testing.assert_array_equal(sparse.dense(), values)


def test_sparse_factors_infer_like_dense_ones():
    dense, sparse = FactorGraph(), FactorGraph()
    table = np.array([[0.9, 0.0, 0.3], [0.0, 0.2, 0.0]])
    indices = np.argwhere(table)
    for graph, values in ((dense, table), (sparse, sparse_values((2, 3), indices, table[tuple(indices.T)]))):
        graph.variable("a", (0, 1))
        graph.variable("b", (0, 1, 2))
        graph.factor("f", ["a", "b"], values)
    assert isinstance(sparse.factors[0].values, SparseValues)
    np.testing.assert_allclose(infer(sparse).joint("b", "a"), infer(dense).joint("b", "a"))


@pytest.mark.parametrize(
    ("shape", "indices", "values", "message"),
    [
        ((2, 2), [[0, 2]], [1.0], "outside"),
        ((2, 2), [[0, -1]], [1.0], "outside"),
        ((2, 2), [[0, 1], [0, 1]], [1.0, 2.0], "twice"),
        ((2, 2), [[0, 1]], [1.0, 2.0], "do not fit"),
        ((2, 2), [[0]], [1.0], "do not fit"),
        ((2, 2), [[0.5, 1.0]], [1.0], "integers"),
    ],
)
def test_bad_sparse_values(shape, indices, values, message):
    with pytest.raises(CogmapError, match=message):
        sparse_values(shape, indices, values)


def test_sparse_factors_are_checked_too():
    x = Variable("x", (0, 1))
    with pytest.raises(CogmapError, match="negative"):
        Factor("f", (x,), sparse_values((2,), [[1]], [-1.0]))
    with pytest.raises(CogmapError, match="shape"):
        Factor("f", (x,), sparse_values((3,), [[1]], [1.0]))
    empty = Factor("f", (x,), sparse_values((2,), [], []))
    np.testing.assert_array_equal(empty.dense(), [0, 0])


def test_conditionals_follow_their_table_on_refresh():
    table = ConditionalTable([[1.0, 3.0], [1.0, 1.0]])
    graph = FactorGraph()
    graph.variable("s", (0, 1))
    graph.variable("o", (0, 1))
    factor = graph.conditional("o", ["s"], table, name="A", kind="sight")
    np.testing.assert_allclose(factor.dense(), [[0.5, 0.75], [0.5, 0.25]])
    assert factor.table is table
    table.learn([[2.0, 0.0], [0.0, 0.0]])
    np.testing.assert_allclose(graph.factors[0].dense()[:, 0], [0.5, 0.5])
    np.testing.assert_allclose(graph.refreshed().factors[0].dense()[:, 0], [0.75, 0.25])
    with pytest.raises(CogmapError, match="mean"):
        graph.conditional("s", [], np.ones(2))


@given(arrays(float, (2, 3), elements=st.floats(0, 5)), st.floats(-10, 10))
def test_counts_never_fall_below_their_prior(counts, rate):
    table = ConditionalTable(np.full((2, 3), 0.1))
    assert isinstance(table, LearnableTable)
    table.learn(counts, rate)
    assert (table.counts >= 0.1).all()
    np.testing.assert_allclose(table.mean().sum(axis=0), 1)


@pytest.mark.parametrize("prior", [1.0, [], [1.0, 0.0], [1.0, math.nan], [math.inf]])
def test_bad_priors(prior):
    with pytest.raises(CogmapError, match="prior counts"):
        ConditionalTable(prior)


def test_bad_counts():
    table = ConditionalTable([1.0, 1.0])
    with pytest.raises(CogmapError, match="shape"):
        table.learn([1.0])
    with pytest.raises(CogmapError, match="finite"):
        table.learn([math.nan, 0.0])
    np.testing.assert_array_equal(table.counts, [1, 1])


def test_marginals_of_the_sprinkler_by_hand():
    graph = sprinkler()
    total = 0.0
    for c, s, r, w in itertools.product((0, 1), repeat=4):
        tables = [factor.dense() for factor in graph.factors]
        total += (w == 1) * tables[0][c] * tables[1][s, c] * tables[2][r, c] * tables[3][w, s, r]
    assert infer(graph).probability("wet", True) == pytest.approx(total)
