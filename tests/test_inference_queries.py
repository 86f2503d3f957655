"""Queries: targets, compiled graphs, soft evidence, interventions, samples, information, k best, marginal MAP."""

from __future__ import annotations

import itertools
import math
import pickle

import numpy as np
import pytest
from cogmap.inference import (
    ImpossibleEvidence,
    compile_graph,
    fit,
    infer,
    k_most_probable,
    log_product,
    marginal_map,
    most_probable,
)
from cogmap.model import CogmapError, FactorGraph, sparse_values
from hypothesis import given, settings
from hypothesis import strategies as st
from test_inference_graphs import evidences, graphs, ladder


@st.composite
def directed(draw, most=6):
    """Random Bayesian networks, zeros among them; sometimes a factor more."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    graph = FactorGraph()
    cards = draw(st.lists(st.integers(1, 3), min_size=1, max_size=most))
    for i, card in enumerate(cards):
        graph.variable(f"x{i}", [f"l{k}" for k in range(card)])
    for i, card in enumerate(cards):
        parents = draw(st.permutations(range(i)))[: draw(st.integers(0, 2))]
        values = rng.random((card, *(cards[j] for j in parents)))
        values[rng.random(values.shape) < draw(st.sampled_from([0.0, 0.4]))] = 0
        values[0] += values.sum(axis=0) == 0
        graph.factor("P", [f"x{i}", *(f"x{j}" for j in parents)], values / values.sum(axis=0))
    if draw(st.booleans()):
        graph.factor("f", ["x0"], rng.random(cards[0]))
    return graph


@settings(max_examples=150, deadline=None)
@given(st.one_of(directed(), graphs()), st.data())
def test_targets_alone_are_as_with_all_the_rest(graph, data):
    evidence = data.draw(evidences(graph))
    names = data.draw(st.lists(st.sampled_from([v.name for v in graph.variables]), min_size=1, max_size=3, unique=True))
    try:
        truth = infer(graph, evidence=evidence, engine="brute")
    except ImpossibleEvidence:
        with pytest.raises(ImpossibleEvidence):
            infer(graph, evidence=evidence, targets=names)
        return
    found = infer(graph, evidence=evidence, targets=names)
    for name in names:
        np.testing.assert_allclose(found.marginal(name), truth.marginal(name), atol=1e-12)
    np.testing.assert_allclose(found.joint(*names), truth.joint(*names), atol=1e-12)
    assert found.log_evidence == pytest.approx(truth.log_evidence, abs=1e-9)


def chain(length):
    graph = FactorGraph()
    rng = np.random.default_rng(0)
    for i in range(length):
        graph.variable(f"x{i}", (0, 1))
        graph.factor("P", [f"x{i}", *([f"x{i - 1}"] if i else [])], rng.dirichlet([1, 1], size=[2] * bool(i)).T)
    return graph


def test_what_is_no_target_is_said_to_be_none():
    posterior = infer(chain(4), targets=["x1"])
    with pytest.raises(CogmapError, match="add it to `targets`"):
        posterior.marginal("x3")
    for ask in (lambda: posterior.entropy, lambda: posterior.sample(3, rng=0)):
        with pytest.raises(CogmapError, match="ask without `targets`"):
            ask()
    for targets, message in (("x1", "list of variables"), ([], "name one"), (["y"], "no variable 'y'")):
        with pytest.raises(CogmapError, match=message):
            infer(chain(4), targets=targets)


@settings(max_examples=80, deadline=None)
@given(st.one_of(directed(), graphs()), st.data())
def test_a_compiled_graph_answers_as_one_that_is_not(graph, data):
    try:
        compiled = compile_graph(graph)
    except ImpossibleEvidence:  # whatever the evidence
        with pytest.raises(ImpossibleEvidence):
            infer(graph, engine="brute")
        return
    for _ in range(4):
        evidence = data.draw(evidences(graph))
        soft = data.draw(st.sampled_from(list(graph.variables)))
        if soft.name not in evidence and data.draw(st.booleans()):
            evidence[soft.name] = {label: 0.1 + k for k, label in enumerate(soft.domain)}
        try:
            truth = infer(graph, evidence=evidence, engine="brute")
        except ImpossibleEvidence:
            for ask in (compiled.infer, compiled.most_probable):
                with pytest.raises(ImpossibleEvidence):
                    ask(evidence)
            continue
        found = compiled.infer(evidence)
        assert found.log_evidence == pytest.approx(truth.log_evidence, abs=1e-9)
        for variable in graph.variables:
            np.testing.assert_allclose(found.marginal(variable), truth.marginal(variable), atol=1e-9)
        names = [v.name for v in graph.variables][:3]
        np.testing.assert_allclose(found.joint(*names), truth.joint(*names), atol=1e-9)
        assert found.entropy == pytest.approx(truth.entropy, abs=1e-9)
        best = most_probable(graph, evidence=evidence, engine="brute").log_probability
        assert compiled.most_probable(evidence).log_probability == pytest.approx(best, abs=1e-9)


def test_posteriors_of_a_compiled_graph_stay_what_they_were():
    compiled = compile_graph(chain(6))
    first = compiled.infer({"x5": 0})
    before = [first.marginal(f"x{i}").copy() for i in range(3)]
    compiled.infer({"x5": 1}).marginal("x0")
    np.testing.assert_array_equal(before, [first.marginal(f"x{i}") for i in range(3)])
    again = infer(chain(6), evidence={"x5": 0})
    np.testing.assert_allclose(first.marginal("x4"), again.marginal("x4"), atol=1e-14)


def test_a_graph_compiled_for_what_is_always_observed():
    graph = FactorGraph()
    for i in range(24):
        graph.variable(f"x{i}", range(4))
        graph.variable(f"o{i}", range(4))
        graph.factor("A", [f"o{i}", f"x{i}"], np.full((4, 4), 0.25))
        for j in range(i):
            graph.factor("B", [f"o{i}", f"o{j}"], np.ones((4, 4)))
    with pytest.raises(CogmapError, match="GB"):
        compile_graph(graph)
    compiled = compile_graph(graph, observed=[f"o{i}" for i in range(24)])
    evidence = {f"o{i}": 1 for i in range(24)}
    assert compiled.infer(evidence).probability("x3", 2) == pytest.approx(0.25)
    with pytest.raises(CogmapError, match="compiled with 'o0' observed"):
        compiled.infer({})


@settings(max_examples=60, deadline=None)
@given(graphs(), st.data())
def test_soft_evidence_is_a_factor(graph, data):
    name = data.draw(st.sampled_from([v.name for v in graph.variables]))
    domain = graph.variable_named(name).domain
    likelihoods = data.draw(st.lists(st.sampled_from([0.0, 0.2, 3.0]), min_size=len(domain), max_size=len(domain)))
    likelihoods[0] = 1.0
    plain = graph.copy()
    plain.factor("likelihood", [name], likelihoods)
    given_ = dict(zip(domain, likelihoods, strict=True))
    for engine in ("numpy", "gtsam", "brute"):
        try:
            truth = infer(plain, engine="brute")
        except ImpossibleEvidence:
            with pytest.raises(ImpossibleEvidence):
                infer(graph, evidence={name: given_}, engine=engine)
            continue
        found = infer(graph.observe(name, given_), engine=engine)
        assert found.log_evidence == pytest.approx(truth.log_evidence, abs=1e-9)
        for variable in graph.variables:
            np.testing.assert_allclose(found.marginal(variable), truth.marginal(variable), atol=1e-9)
        best = most_probable(graph, evidence={name: given_}, engine=engine)
        assert best.log_probability == pytest.approx(most_probable(plain, engine="brute").log_probability, abs=1e-9)


def coin():
    graph = FactorGraph()
    graph.variable("x", ("a", "b", "c"))
    graph.factor("P", ["x"], [0.2, 0.3, 0.5])
    return graph


@pytest.mark.parametrize(
    ("evidence", "message"),
    [
        ({"x": {"a": -1.0}}, "finite number, 0 or more"),
        ({"x": {"a": math.nan}}, "finite number"),
        ({"x": {"a": math.inf}}, "finite number"),
        ({"x": {"a": "much"}}, "finite number"),
        ({"x": {"a": 0.0}}, "every likelihood"),
        ({"x": {}}, "every likelihood"),
        ({"x": {"d": 1.0}}, "no label 'd'"),
        ({"y": {"a": 1.0}}, "no variable 'y'"),
    ],
)
def test_bad_soft_evidence(evidence, message):
    for ask in (infer, most_probable, lambda graph, evidence: compile_graph(graph).infer(evidence)):
        with pytest.raises(CogmapError, match=message):
            ask(coin(), evidence=evidence)


def test_evidence_of_both_kinds_does_not_mix():
    soft = coin().observe("x", {"a": 0.7, "b": 0.2})
    np.testing.assert_allclose(infer(soft).marginal("x"), np.array([0.14, 0.06, 0.0]) / 0.2)
    for graph, more in ((soft, "a"), (soft, {"a": 1.0}), (coin().observe("x", "a"), {"a": 1.0})):
        with pytest.raises(CogmapError, match="already"):
            graph.observe("x", more)
    assert dict(soft.without_evidence("x").likelihoods) == {}
    assert FactorGraph.from_json(soft.to_json()) == soft
    assert soft != coin()
    assert "x" in soft.to_dot()


def test_factors_and_evidence_can_be_taken_back():
    graph = chain(3).observe_all({"x0": 0, "x2": 1})
    assert dict(graph.without_evidence("x0").evidence) == {"x2": 1}
    assert dict(graph.without_evidence().evidence) == {}
    assert dict(graph.evidence) == {"x0": 0, "x2": 1}
    with pytest.raises(CogmapError, match="no evidence about 'x1'"):
        graph.without_evidence("x1")
    left = graph.without_factor("P(x1, x0)")
    assert [factor.label for factor in left.factors] == ["P(x0)", "P(x2, x1)"]
    assert len(graph.factors) == 3
    left.factor("P", ["x1", "x0"], [[0.5, 0.5], [0.5, 0.5]])
    assert infer(left).log_evidence != infer(graph).log_evidence
    with pytest.raises(CogmapError, match="0 factors"):
        graph.without_factor("Q")


def test_intervening_is_not_observing():
    graph = FactorGraph()
    for name in ("cause", "treated", "well"):
        graph.variable(name, (False, True))
    graph.factor("P", ["cause"], [0.5, 0.5])
    graph.factor("P", ["treated", "cause"], [[0.9, 0.1], [0.1, 0.9]])
    well = np.array([[0.2, 0.6], [0.4, 0.8]])  # [treated, cause]
    graph.factor("P", ["well", "treated", "cause"], np.stack([1 - well, well]))
    done = infer(graph.intervene("treated", True))
    assert done.probability("well", True) == pytest.approx(0.5 * (0.4 + 0.8))
    assert done.probability("cause", True) == pytest.approx(0.5)
    seen = infer(graph, evidence={"treated": True})
    assert seen.probability("well", True) == pytest.approx(0.1 * 0.4 + 0.9 * 0.8)
    graph.factor("Q", ["treated"], [1.0, 2.0])
    with pytest.raises(CogmapError, match="2 factors have it first"):
        graph.intervene("treated", True)


@settings(max_examples=60, deadline=None)
@given(graphs(max_variables=4), st.integers(1, 12), st.data())
def test_the_k_best_are_the_k_best(graph, count, data):
    evidence = data.draw(evidences(graph))
    products = []
    for labels in itertools.product(*(v.domain for v in graph.variables)):
        x = dict(zip((v.name for v in graph.variables), labels, strict=True))
        if all(x[name] == label for name, label in evidence.items()):
            products.append(log_product(graph, x))
    expected = sorted((value for value in products if value > -math.inf), reverse=True)[:count]
    if not expected:
        with pytest.raises(ImpossibleEvidence):
            k_most_probable(graph, count, evidence=evidence)
        return
    found = k_most_probable(graph, count, evidence=evidence)
    np.testing.assert_allclose([each.log_probability for each in found], expected, atol=1e-9)
    assert len({tuple(each.assignment.values()) for each in found}) == len(found)


@settings(max_examples=60, deadline=None)
@given(graphs(max_variables=5), st.data())
def test_marginal_map_sums_the_others_out(graph, data):
    names = data.draw(st.lists(st.sampled_from([v.name for v in graph.variables]), min_size=1, max_size=3, unique=True))
    try:
        truth = infer(graph, engine="brute")
    except ImpossibleEvidence:
        with pytest.raises(ImpossibleEvidence):
            marginal_map(graph, names)
        return
    found = marginal_map(graph, names)
    best = math.log(truth.joint(*names).max()) + truth.log_evidence
    assert found.log_probability == pytest.approx(best, abs=1e-9)
    indices = tuple(graph.variable_named(name).index(found.assignment[name]) for name in names)
    assert list(found.assignment) == names
    assert math.log(truth.joint(*names)[indices]) + truth.log_evidence == pytest.approx(best, abs=1e-9)


def test_bad_counts_of_answers():
    for ask, message in (
        (lambda: k_most_probable(coin(), 0), "1 or more"),
        (lambda: marginal_map(coin(), []), "name one"),
        (lambda: infer(coin()).sample(-1, rng=0), "0 or more"),
    ):
        with pytest.raises(CogmapError, match=message):
            ask()


@pytest.mark.parametrize("engine", ["numpy", "gtsam", "brute"])
def test_samples_come_from_the_posterior(engine):
    graph = ladder(3, 4, 3, np.random.default_rng(1))
    posterior = infer(graph, engine=engine)
    drawn = posterior.sample(20_000, rng=0)
    assert drawn == posterior.sample(20_000, rng=np.random.default_rng(0))
    for names in (("s0",), ("s2", "p2"), ("s1", "moved2")):
        p = posterior.joint(*names)
        counts = np.zeros_like(p)
        for labels in zip(*(drawn[name] for name in names), strict=True):
            counts[tuple(graph.variable_named(n).index(x) for n, x in zip(names, labels, strict=True))] += 1
        error = np.sqrt(p * (1 - p) / 20_000)
        assert (abs(counts / 20_000 - p) <= 4.5 * error + 1e-12).all()
    assert set(drawn["o1"]) == {"green"}


def test_samples_agree_with_hard_zeros_and_with_compiled_evidence():
    posterior = compile_graph(chain(5)).infer({"x2": 1})
    assert set(posterior.sample(50, rng=1)["x2"]) == {1}
    graph = FactorGraph()
    graph.variable("a", (0, 1))
    graph.variable("b", (0, 1))
    graph.factor("f", ["a", "b"], [[0.0, 0.3], [0.7, 0.0]])
    drawn = infer(graph).sample(200, rng=0)
    assert all(a != b for a, b in zip(drawn["a"], drawn["b"], strict=True))


@settings(max_examples=40, deadline=None)
@given(graphs(max_variables=4))
def test_entropy_and_information(graph):
    try:
        posterior = infer(graph)
    except ImpossibleEvidence:
        return
    names = [v.name for v in graph.variables]
    p = posterior.joint(*names)
    assert posterior.entropy_of(*names) == pytest.approx(-(p[p > 0] @ np.log(p[p > 0])), abs=1e-9)
    assert posterior.entropy_of(*names) == pytest.approx(posterior.entropy, abs=1e-9)
    if len(names) > 2:
        one, rest = names[0], names[1:]
        a, b = posterior.marginal(one), posterior.joint(*rest)
        expected = sum(q * math.log(q / (a[x[0]] * b[x[1:]])) for x, q in np.ndenumerate(p) if q > 0)
        assert posterior.mutual_information(one, rest) == pytest.approx(expected, abs=1e-9)


def test_names_and_variables_are_alike():
    graph = chain(4)
    x0, x1, x2, x3 = graph.variables
    by_name = infer(graph, evidence={"x3": 1}, pairs=[("x0", "x1")], order=["x0", "x1", "x2"])
    by_self = infer(graph, evidence={x3: 1}, pairs=[(x0, x1)], order=[x0, x1, x2])
    np.testing.assert_array_equal(by_name.joint("x0", "x1"), by_self.joint(x0, x1))
    assert by_self.probability(x2, 1) == by_name.probability("x2", 1)
    assert by_self.mutual_information(x0, [x1, "x2"]) == by_name.mutual_information("x0", ["x1", "x2"])
    assert most_probable(graph, evidence={x3: 1}).assignment == most_probable(graph, evidence={"x3": 1}).assignment
    assert infer(graph, targets=[x2]).entropy_of(x2) == infer(graph, targets=["x2"]).entropy_of("x2")
    assert marginal_map(graph, [x0]).assignment == marginal_map(graph, ["x0"]).assignment
    assert dict(graph.observe_all({x0: 1}).without_evidence(x0).evidence) == {}
    assert graph.observe(x0, 1).is_observed("x0")
    every = dict.fromkeys(graph.variables, 0)
    assert log_product(graph, every) == log_product(graph, {variable.name: 0 for variable in every})
    with pytest.raises(CogmapError, match="no label for 'x1'"):
        log_product(graph, {x0: 0})
    assert fit(graph.with_tables(), {x0: [0, 1]}).objective == fit(graph.with_tables(), [{"x0": 0}, {x0: 1}]).objective
    stranger = chain(1).variables[0].__class__("x0", ("p", "q"))
    for ask in (lambda: infer(graph).marginal(stranger), lambda: infer(graph, evidence={stranger: "p"})):
        with pytest.raises(CogmapError, match="not of this graph"):
            ask()


def test_results_cannot_be_changed():
    for posterior in (infer(chain(3), pairs=[("x0", "x1")]), compile_graph(chain(3)).infer({"x2": 0})):
        for array in (posterior.marginal("x0"), posterior.joint("x0", "x1"), posterior.joint("x0", "x2")):
            before = array.copy()
            with pytest.raises(ValueError, match="read-only"):
                array *= 2
            np.testing.assert_array_equal(array, before)
        with pytest.raises(TypeError):
            posterior.evidence["x0"] = 1
    best = most_probable(chain(3))
    with pytest.raises(TypeError):
        best.assignment["x0"] = 7
    assert pickle.loads(pickle.dumps(best)).assignment == best.assignment


def test_a_sparse_factor_of_forty_variables():
    rng = np.random.default_rng(0)
    rows = np.unique(rng.integers(0, 2, (50, 40)), axis=0)
    weights = rng.random(len(rows))
    graph = FactorGraph()
    names = [graph.variable(f"b{i}", (0, 1)).name for i in range(40)]
    factor = graph.factor("S", names, sparse_values([2] * 40, rows, weights))
    for i in range(40):
        values = rng.random((2, 2))
        graph.factor("w", [names[i], names[(i + 1) % 40]], values)
        weights = weights * values[rows[:, i], rows[:, (i + 1) % 40]]
    for evidence in ({}, {"b3": 1}, {"b3": 1, "b7": 0, "b9": {0: 0.5, 1: 2.0}}):
        live = weights * np.prod(
            [
                np.array([label.get(0), label.get(1)])[rows[:, int(n[1:])]]
                if isinstance(label, dict)
                else rows[:, int(n[1:])] == label
                for n, label in evidence.items()
            ],
            axis=0,
        )
        for posterior in (infer(graph, evidence=evidence), compile_graph(graph).infer(evidence)):
            assert posterior.log_evidence == pytest.approx(math.log(live.sum()), abs=1e-9)
            for i in range(40):
                expected = (live * rows[:, i]).sum() / live.sum()
                assert posterior.probability(f"b{i}", 1) == pytest.approx(expected, abs=1e-9)
            drawn = posterior.sample(20, rng=0)
            chosen = {row.tobytes() for row in rows[live > 0]}
            assert all(np.array([drawn[n][k] for n in names]).tobytes() in chosen for k in range(20))
        best = most_probable(graph, evidence=evidence)
        assert best.log_probability == pytest.approx(math.log(live.max()), abs=1e-9)
        assert k_most_probable(graph, 3, evidence=evidence)[2].log_probability == pytest.approx(
            math.log(np.sort(live)[-3]), abs=1e-9
        )
    p = weights / weights.sum()
    entries = factor.at(list(rows.T))
    assert infer(graph).expected_log(factor) == pytest.approx(float(p @ np.log(entries)), abs=1e-9)
    with pytest.raises(CogmapError, match="ask for fewer at once"):
        infer(graph).joint(*names)
    with pytest.raises(CogmapError, match="too many to write"):
        factor.dense()
    nothing = FactorGraph()
    for name in names:
        nothing.variable(name, (0, 1))
    nothing.factor("S", names, sparse_values([2] * 40, rows[:1], [0.5]))
    assert infer(nothing).probability("b0", int(rows[0, 0])) == 1
    with pytest.raises(ImpossibleEvidence, match=r"S\(b0"):
        infer(nothing, evidence={"b0": 1 - int(rows[0, 0])})


def star(leaves):
    graph = FactorGraph()
    rng = np.random.default_rng(0)
    graph.variable("hub", range(3))
    for i in range(leaves):
        graph.variable(f"leaf{i}", (0, 1))
        graph.factor("f", [f"leaf{i}", "hub"], rng.random((2, 3)))
    return graph


def test_a_hub_with_thousands_of_leaves():
    graph = star(5000)
    logs = np.zeros(3)
    for factor in graph.factors:
        logs += np.log(factor.dense().sum(axis=0))
    posterior = infer(graph)
    assert posterior.log_evidence == pytest.approx(np.logaddexp.reduce(logs), rel=1e-12)
    np.testing.assert_allclose(posterior.marginal("hub"), np.exp(logs - np.logaddexp.reduce(logs)), atol=1e-9)
    leaf = graph.factors[7].dense() / graph.factors[7].dense().sum(axis=0)
    np.testing.assert_allclose(posterior.marginal("leaf7"), leaf @ posterior.marginal("hub"), atol=1e-9)


def test_a_chain_of_ten_thousand_without_times():
    graph = chain(10_000)
    posterior = infer(graph)
    assert posterior.log_evidence == pytest.approx(0, abs=1e-9)
    marginal = graph.factors[0].dense()
    for factor in graph.factors[1:]:
        marginal = factor.dense() @ marginal
    np.testing.assert_allclose(posterior.marginal("x9999"), marginal, atol=1e-9)


def test_the_window_of_an_agent_lost_among_a_thousand_places():
    rng = np.random.default_rng(0)
    places, steps = 1000, 3
    graph = FactorGraph()
    successors = np.zeros((places, places))
    successors[rng.integers(0, places, places), np.arange(places)] = 1.0
    look = rng.random(places)
    forward = np.full(places, 1 / places)
    for t in range(steps):
        graph.variable(f"s{t}", range(places), time=t)
        graph.variable(f"p{t}", range(places), time=t)
        graph.factor("A_p", [f"p{t}", f"s{t}"], np.eye(places))
        graph.factor("A_o", [f"s{t}"], look)
        if t:
            graph.variable(f"moved{t}", (False, True), time=t)
            graph.factor("M", [f"moved{t}"], [0.99, 0.01])
            way = np.stack([successors, np.full((places, places), 1 / places)], axis=-1)
            graph.factor("B_s", [f"s{t}", f"s{t - 1}", f"moved{t}"], way)
            forward = 0.99 * successors @ forward + 0.01 * forward.sum() / places
        else:
            graph.factor("Q", ["s0"], forward)
        forward = forward * look
    posterior = infer(graph, pairs=[("s1", "s0", "moved1")])
    assert posterior.log_evidence == pytest.approx(math.log(forward.sum()), abs=1e-9)
    np.testing.assert_allclose(posterior.marginal("p2"), forward / forward.sum(), atol=1e-12)


def test_too_little_memory_says_what_is_needed():
    graph = ladder(4, 30, 30, np.random.default_rng(0), one_hot=False)
    for ask in (infer, most_probable, compile_graph):
        with pytest.raises(CogmapError, match=r"needs .* GB \(.* bytes\), above memory=1e\+05; the largest cluster"):
            ask(graph, memory=1e5)
    assert infer(graph, memory=1e9).exact
