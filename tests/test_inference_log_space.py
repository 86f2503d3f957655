"""Nothing that is small is lost: right values by hand, and random graphs against enumeration in exact arithmetic."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest
from cogmap.inference import ImpossibleEvidence, compile_graph, infer, log_product, most_probable
from cogmap.model import CogmapError, FactorGraph
from hypothesis import given, settings
from hypothesis import strategies as st


def readings(labels, prior, table):
    """One hidden cause and a reading of it for each of `labels`."""
    graph = FactorGraph()
    graph.variable("cause", range(len(prior)))
    graph.factor("P", ["cause"], prior)
    for i, label in enumerate(labels):
        graph.variable(f"reading{i}", (0, 1))
        graph.factor("P", [f"reading{i}", "cause"], table)
        graph = graph.observe(f"reading{i}", label)
    return graph


def test_many_readings_of_one_cause():
    graph = readings([0] * 345 + [1] * 346, [0.5, 0.5], [[0.9, 0.1], [0.1, 0.9]])
    posterior = infer(graph)
    assert posterior.probability("cause", 1) == pytest.approx(0.9, abs=1e-9)
    log_z = math.log(0.5) + 345 * math.log(0.9 * 0.1) + math.log(1.0)  # 0.1 + 0.9: one reading more for b
    assert posterior.log_evidence == pytest.approx(log_z, abs=1e-9)
    assert most_probable(graph).assignment["cause"] == 1


def test_a_bias_on_a_grid():
    grid = np.arange(1, 20) / 20
    posterior = infer(readings([0] * 1200 + [1] * 1200, np.full(19, 1 / 19), np.stack([grid, 1 - grid])))
    assert posterior.probability("cause", 9) == pytest.approx(0.9999884320, abs=1e-9)
    assert posterior.log_evidence == pytest.approx(-1666.498, abs=1e-3)
    exact = [Fraction(k, 20) ** 1200 * Fraction(20 - k, 20) ** 1200 for k in range(1, 20)]
    np.testing.assert_allclose(posterior.marginal("cause"), [float(each / sum(exact)) for each in exact], atol=1e-9)


def test_two_tiny_factors_and_a_zero():
    graph = FactorGraph()
    graph.variable("x", (0, 1))
    for name, values in (("f", (1, 1e-200)), ("g", (1, 1e-200)), ("h", (0, 1))):
        graph.factor(name, ["x"], values)
    posterior = infer(graph)
    np.testing.assert_array_equal(posterior.marginal("x"), [0, 1])
    assert posterior.log_evidence == pytest.approx(2 * math.log(1e-200), abs=1e-9)
    assert most_probable(graph).assignment == {"x": 1}
    assert most_probable(graph).log_probability == pytest.approx(2 * math.log(1e-200), abs=1e-9)


@pytest.mark.parametrize("timed", [True, False])
def test_a_context_that_never_changes(timed):
    graph = FactorGraph()
    for t, cue in enumerate([0] * 340 + [1] * 341):
        graph.variable(f"context{t}", ("a", "b"), time=t if timed else None)
        graph.factor("cue", [f"context{t}"], [0.9, 0.1] if cue == 0 else [0.1, 0.9])
        if t:
            graph.factor("stays", [f"context{t}", f"context{t - 1}"], np.eye(2))
    posterior = infer(graph)
    for t in (0, 300, 680):
        assert posterior.probability(f"context{t}", "b") == pytest.approx(0.9, abs=1e-9)
    assert posterior.joint("context0", "context680")[1, 1] == pytest.approx(0.9, abs=1e-9)
    compiled = compile_graph(graph).infer()
    assert compiled.probability("context340", "b") == pytest.approx(0.9, abs=1e-9)


def test_a_context_that_hardly_changes_is_in_logs_between_its_ends():
    """The message is out of a float's range in the middle of the chain, and within it at both ends."""
    graph = FactorGraph()
    for t in range(2000):
        graph.variable(f"x{t}", (0, 1), time=t)
        graph.factor("cue", [f"x{t}"], [1.0, 1e-3] if t < 1000 else [1e-3, 1.0])
        if t:
            graph.factor("step", [f"x{t}", f"x{t - 1}"], [[1.0, 1e-9], [0.0, 1.0]])
    posterior = infer(graph)
    # it never goes from 0 to 1: all 0, all 1, or 1 up to some step and 0 from then on, at 1e-9
    logs = [1000 * math.log(1e-3), 1000 * math.log(1e-3)]
    for change in range(1, 2000):
        wrong = min(change, 1000) + max(2000 - max(change, 1000), 0)
        logs.append(math.log(1e-9) + wrong * math.log(1e-3))
    top = max(logs)
    log_z = top + math.log(math.fsum(math.exp(each - top) for each in logs))
    assert posterior.log_evidence == pytest.approx(log_z, abs=1e-9)
    assert posterior.probability("x0", 0) == pytest.approx(math.exp(logs[0] - log_z), abs=1e-9)


@st.composite
def wild_graphs(draw):
    cards = draw(st.lists(st.integers(1, 3), min_size=1, max_size=4))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    graph = FactorGraph()
    for i, card in enumerate(cards):
        graph.variable(f"x{i}", range(card), time=draw(st.sampled_from([None, 0, 1])))
    for f in range(draw(st.integers(1, 9))):
        scope = draw(st.permutations(range(len(cards))))[: draw(st.integers(1, min(3, len(cards))))]
        shape = [cards[i] for i in scope]
        width = draw(st.sampled_from([1, 30, 150, 300]))
        values = 10.0 ** rng.uniform(-width, width, shape)
        values[rng.random(shape) < draw(st.sampled_from([0.0, 0.3]))] = 0
        graph.factor(f"f{f}", [f"x{i}" for i in scope], values)
    return graph


def exactly(graph):
    """The product of all factors at every assignment, in fractions."""
    products = {}
    for x in itertools.product(*(range(v.cardinality) for v in graph.variables)):
        product = Fraction(1)
        for factor, scope in zip(graph.factors, graph.wiring.scopes, strict=True):
            product *= Fraction(float(factor.dense()[tuple(x[i] for i in scope)]))
        products[x] = product
    return products


def log_of(fraction):
    return math.log(fraction.numerator) - math.log(fraction.denominator)


def answer(ask, *, may_refuse):
    """What is answered; None where gtsam says that another engine must be asked."""
    if not may_refuse:
        return ask()
    try:
        return ask()
    except CogmapError as error:
        if "engine='numpy'" not in str(error):
            raise
        return None


@pytest.mark.parametrize("engine", ["numpy", "gtsam", "brute", "compiled"])
@settings(max_examples=150, deadline=None)
@given(wild_graphs())
def test_factors_from_1e_minus_300_to_1e300(engine, graph):
    products = exactly(graph)
    total = sum(products.values())

    def ask():
        return compile_graph(graph).infer() if engine == "compiled" else infer(graph, engine=engine)

    if total == 0:
        with pytest.raises(ImpossibleEvidence):
            ask()
        return
    if (posterior := answer(ask, may_refuse=engine == "gtsam")) is None:
        return
    assert posterior.log_evidence == pytest.approx(log_of(total), abs=1e-9)
    for i, variable in enumerate(graph.variables):
        expected = np.zeros(variable.cardinality)
        for k in range(variable.cardinality):
            expected[k] = float(sum(value for x, value in products.items() if x[i] == k) / total)
        np.testing.assert_allclose(posterior.marginal(variable), expected, atol=1e-9)
    every = posterior.joint(*graph.variables)
    for x, value in products.items():
        assert every[x] == pytest.approx(float(value / total), abs=1e-9)


@pytest.mark.parametrize("engine", ["numpy", "gtsam", "brute"])
@settings(max_examples=100, deadline=None)
@given(wild_graphs())
def test_the_most_probable_of_them(engine, graph):
    best = max(exactly(graph).values())
    if best == 0:
        with pytest.raises(ImpossibleEvidence):
            most_probable(graph, engine=engine)
        return
    if (found := answer(lambda: most_probable(graph, engine=engine), may_refuse=engine == "gtsam")) is None:
        return
    assert found.log_probability == pytest.approx(log_of(best), abs=1e-9)
    assert log_product(graph, found.assignment) == pytest.approx(log_of(best), abs=1e-9)


def test_gtsam_raises_where_it_would_lose_the_winner():
    graph = readings([0] * 345 + [1] * 346, [0.5, 0.5], [[0.9, 0.1], [0.1, 0.9]])
    for ask in (infer, most_probable):
        with pytest.raises(CogmapError, match="engine='numpy'") as caught:
            ask(graph, engine="gtsam")
        assert not isinstance(caught.value, ImpossibleEvidence)
