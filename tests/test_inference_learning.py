"""Learning from data: EM and variational Bayes, against closed forms and against the truth."""

from __future__ import annotations

import math

import numpy as np
import pytest
from cogmap.inference import fit, infer
from cogmap.model import CogmapError, ConditionalTable, FactorGraph
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import gammaln


def asia():
    """The chest clinic of Lauritzen and Spiegelhalter."""
    graph = FactorGraph()
    yes = {
        ("asia",): 0.01,
        ("smoke",): 0.5,
        ("tub", "asia"): [0.05, 0.01],
        ("lung", "smoke"): [0.1, 0.01],
        ("bronc", "smoke"): [0.6, 0.3],
        ("either", "lung", "tub"): [[1.0, 1.0], [1.0, 0.0]],
        ("xray", "either"): [0.98, 0.05],
        ("dysp", "bronc", "either"): [[0.9, 0.8], [0.7, 0.1]],
    }
    for scope, values in yes.items():
        graph.variable(scope[0], ("yes", "no"))
        graph.factor("P", scope, np.stack([values, 1.0 - np.array(values)]), normalised=True)
    return graph


def seen(graph, count, missing, seed):
    """Samples with some values missing at random."""
    rng = np.random.default_rng(seed)
    data = infer(graph).sample(count, rng=rng)
    return {name: [None if rng.random() < missing else label for label in column] for name, column in data.items()}


@pytest.mark.parametrize("method", ["em", "variational"])
def test_asia_comes_back_with_a_fifth_missing(method):
    truth = asia()
    data = seen(truth, 10_000, 0.2, 0)
    found = fit(truth.with_tables().refreshed(), data, method=method)
    assert found.converged
    rises = np.diff(found.objective)
    assert (rises >= -1e-9 * abs(found.objective[-1])).all()
    for factor in truth.factors:
        whole = np.zeros(factor.shape[1:])  # rows that show the child and all parents: what it could be learned from
        for row in zip(*(data[variable.name] for variable in factor.scope), strict=True):
            if None not in row:
                whole[tuple(v.index(label) for v, label in zip(factor.scope[1:], row[1:], strict=True))] += 1
        learned = found.graph.factor_named(factor.label).dense()
        p = np.maximum(factor.dense() * (1 - factor.dense()), 1 / (whole + 1))  # none is known better than by one row
        error = np.sqrt(p / np.maximum(whole, 1))
        assert (abs(learned - factor.dense()) <= 3 * error).all()
    fresh = infer(found.graph).sample(2000, rng=1)
    assert fresh["either"].count("yes") == pytest.approx(2000 * 0.0648, abs=60)


def test_without_missing_values_em_counts():
    truth = asia()
    data = seen(truth, 500, 0.0, 1)
    found = fit(truth.with_tables(), data)
    for factor in truth.factors:
        counts = np.zeros(factor.shape)
        columns = [[v.index(label) for label in data[v.name]] for v in factor.scope]
        np.add.at(counts, tuple(columns), 1.0)
        np.testing.assert_allclose(found.counts[factor.label], counts, atol=1e-9)
        sums = counts.sum(axis=0)
        expected = np.where(sums > 0, counts / np.maximum(sums, 1), factor.dense())
        np.testing.assert_allclose(found.graph.factor_named(factor.label).dense(), expected, atol=1e-9)
    log_likelihood = sum(
        infer(found.graph, evidence={name: data[name][k] for name in data}).log_evidence for k in range(500)
    )
    assert found.objective[-1] == pytest.approx(log_likelihood, abs=1e-6)


def coin(prior):
    graph = FactorGraph()
    graph.variable("toss", ("heads", "tails"))
    graph.conditional("toss", [], ConditionalTable(prior))
    return graph


def test_a_coin_by_variational_bayes_is_the_conjugate_posterior():
    prior = np.array([2.0, 3.0])
    graph = coin(prior)
    found = fit(graph, {"toss": ["heads"] * 7 + ["tails"] * 2}, method="variational")
    np.testing.assert_allclose(found.graph.factors[0].dense(), [9 / 14, 5 / 14])
    np.testing.assert_allclose(found.graph.factors[0].table.counts, [9, 5])

    def log_beta(a):
        a = np.asarray(a)
        return gammaln(a).sum() - gammaln(a.sum())

    assert found.objective[-1] == pytest.approx(log_beta([9.0, 5.0]) - log_beta(prior), abs=1e-9)
    np.testing.assert_array_equal(graph.factors[0].table.counts, prior)  # what was given stays
    em = fit(graph, {"toss": ["heads"] * 7 + ["tails"] * 2})
    np.testing.assert_allclose(em.graph.factors[0].dense(), [7 / 9, 2 / 9])
    np.testing.assert_allclose(em.graph.factors[0].table.counts, [9, 5])


@pytest.mark.parametrize("method", ["em", "variational"])
@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10_000))
def test_the_objective_never_falls(method, seed):
    rng = np.random.default_rng(seed)
    graph = FactorGraph()
    graph.variable("hidden", range(3))
    graph.conditional("hidden", [], ConditionalTable(rng.uniform(0.1, 2, 3)))
    shared = ConditionalTable(rng.uniform(0.1, 2, (2, 3)))
    for i in range(3):
        graph.variable(f"o{i}", (0, 1))
        graph.conditional(f"o{i}", ["hidden"], shared, name=f"A{i}")
    graph.factor("f", ["o0", "o1"], rng.uniform(0.5, 1, (2, 2)))
    data = [{f"o{i}": int(rng.integers(2)) for i in range(3) if rng.random() < 0.8} for _ in range(60)]
    found = fit(graph, data, method=method, rng=seed, iterations=60)
    assert (np.diff(found.objective) >= -1e-9).all()
    counts = found.counts["A0(o0, hidden)"]
    np.testing.assert_array_equal(counts, found.counts["A2(o2, hidden)"])
    assert counts.sum() == pytest.approx(180)  # three factors, sixty rows


def test_hidden_markov_chain_by_baum_and_welch():
    """One long row: tables shared along a chain; one step of EM against the forward-backward algorithm."""
    rng = np.random.default_rng(0)
    step, look, first = rng.dirichlet([1, 1], 2).T, rng.dirichlet([1, 1, 1], 2).T, rng.dirichlet([1, 1])
    seen_ = rng.integers(0, 3, 50)
    graph = FactorGraph()
    tables = [ConditionalTable(np.ones(shape)) for shape in ((2,), (2, 2), (3, 2))]
    for t in range(50):
        graph.variable(f"s{t}", (0, 1), time=t)
        graph.variable(f"o{t}", (0, 1, 2), time=t)
        scope, values, table = ([f"s{t}", f"s{t - 1}"], step, tables[1]) if t else ([f"s{t}"], first, tables[0])
        graph.factor("B", scope, values, table=table)
        graph.factor("A", [f"o{t}", f"s{t}"], look, table=tables[2])
    found = fit(graph, [{f"o{t}": int(o) for t, o in enumerate(seen_)}], iterations=1)
    alpha = [first * look[seen_[0]]]
    for o in seen_[1:]:
        alpha.append(look[o] * (step @ alpha[-1]))
    beta = [np.ones(2)]
    for o in seen_[:0:-1]:
        beta.insert(0, step.T @ (look[o] * beta[0]))
    z = alpha[-1].sum()
    pairs = sum(step * np.outer(look[seen_[t]] * beta[t], alpha[t - 1]) / z for t in range(1, 50))
    np.testing.assert_allclose(found.counts["B(s1, s0)"], pairs, atol=1e-9)
    np.testing.assert_allclose(found.graph.factor_named("B(s1, s0)").dense(), pairs / pairs.sum(axis=0), atol=1e-9)
    assert found.objective[0] == pytest.approx(math.log(z), abs=1e-9)


def test_many_rows_in_parts_are_as_all_at_once(monkeypatch):
    truth = asia()
    data = seen(truth, 300, 0.3, 2)
    whole = fit(truth.with_tables(), data, iterations=3)
    monkeypatch.setattr("cogmap.inference.learning.CHUNK", 20_000)
    parts = fit(truth.with_tables(), data, iterations=3)
    np.testing.assert_allclose(whole.objective, parts.objective, rtol=1e-12)
    for label, counts in whole.counts.items():
        np.testing.assert_allclose(parts.counts[label], counts, atol=1e-9)


def test_data_may_be_rows_columns_or_a_frame():
    columns = {"toss": ["heads", None, "tails", "heads"]}
    rows = [{"toss": "heads"}, {}, {"toss": "tails"}, {"toss": "heads"}]
    found = [fit(coin([1.0, 1.0]), data) for data in (columns, rows, {"toss": ["heads", math.nan, "tails", "heads"]})]
    pandas = pytest.importorskip("pandas")
    found.append(fit(coin([1.0, 1.0]), pandas.DataFrame(columns)))
    for each in found:
        np.testing.assert_allclose(each.graph.factors[0].dense(), [2 / 3, 1 / 3], atol=1e-4)


def test_evidence_of_the_graph_holds_in_every_row():
    graph = asia().with_tables().observe("smoke", "yes")
    found = fit(graph, {"lung": ["yes"] * 3 + ["no"] * 7})
    np.testing.assert_allclose(found.graph.factor_named("P(lung, smoke)").dense()[:, 0], [0.3, 0.7], atol=1e-6)
    assert dict(found.graph.evidence) == {"smoke": "yes"}
    soft = fit(coin([1.0, 1.0]).observe("toss", {"heads": 1.0, "tails": 0.0}), [{}])
    np.testing.assert_allclose(soft.graph.factors[0].dense(), [1.0, 0.0])


@pytest.mark.parametrize(
    ("data", "options", "message"),
    [
        ({"toss": []}, {}, "no rows"),
        ({}, {}, "no rows"),
        ([], {}, "no rows"),
        ({"coin": ["heads"]}, {}, "no variable 'coin'"),
        ({"toss": ["heads", "edge"]}, {}, "row 1 .* no label 'edge'"),
        ([["heads"]], {}, "rows that are mappings"),
        ({"toss": ["heads"]}, {"method": "gibbs"}, "choose one of"),
        ({"toss": ["heads"]}, {"iterations": 0}, "1 or more"),
    ],
)
def test_bad_data(data, options, message):
    with pytest.raises(CogmapError, match=message):
        fit(coin([1.0, 1.0]), data, **options)


def test_what_cannot_be_learned():
    with pytest.raises(CogmapError, match="different numbers"):
        fit(asia().with_tables(), {"asia": ["yes", "no"], "smoke": ["yes"]})
    with pytest.raises(CogmapError, match="with_tables"):
        fit(asia(), {"asia": ["yes"]})
    with pytest.raises(CogmapError, match="evidence in the graph"):
        fit(coin([1.0, 1.0]).observe("toss", "heads"), {"toss": ["heads"]})
    with pytest.raises(CogmapError, match=r"row 1 .* probability 0"):
        fit(asia().with_tables(), [{"asia": "yes"}, {"either": "no", "lung": "yes"}, {}])
    graph = FactorGraph()
    table = ConditionalTable(np.ones((2, 2)))
    graph.variable("a", (0, 1))
    graph.variable("b", (0, 1, 2))
    with pytest.raises(CogmapError, match="shape"):
        graph.conditional("b", ["a"], table)
    graph.factor("f", ["a"], [1.0, 1.0], table=table)
    graph.factor("g", ["b"], [1.0, 1.0, 1.0], table=table)
    with pytest.raises(CogmapError, match="shape"):
        fit(graph, [{"a": 0}])


def test_checking_that_a_conditional_is_normalised():
    graph = FactorGraph()
    graph.variable("a", ("x", "y"))
    graph.variable("b", (0, 1))
    with pytest.raises(CogmapError, match=r"values of b given a = 'y' sum to 1\.1"):
        graph.factor("P", ["b", "a"], [[0.5, 0.6], [0.5, 0.5]], normalised=True)
    assert graph.factors == ()
    factor = graph.factor("P", ["b", "a"], [[0.5, 0.6], [0.5, 0.5]])
    assert not factor.normalised
    factor.check_normalised(tolerance=0.2)
    assert graph.with_tables().factors[0].table is None


def test_no_data_at_all_is_refused() -> None:
    graph = FactorGraph()
    graph.variable("x", ("a", "b"))
    with pytest.raises(CogmapError, match="the data are None; give labels by variable"):
        fit(graph, None)  # type: ignore[arg-type]
