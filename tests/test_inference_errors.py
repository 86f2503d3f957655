"""Bad questions to inference: one clear line each."""

from __future__ import annotations

import numpy as np
import pytest
from cogmap.agent import Agent
from cogmap.inference import ImpossibleEvidence, infer, most_probable
from cogmap.model import CogmapError, FactorGraph
from test_inference_graphs import ladder


def weather():
    graph = FactorGraph()
    graph.variable("rain", ["no", "yes"])
    graph.variable("wet", ["no", "yes"], observed=True)
    graph.factor("P", ["rain"], [1.0, 0.0])
    graph.factor("P", ["wet", "rain"], [[1.0, 0.2], [0.0, 0.8]])
    return graph


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"evidence": {"snow": "yes"}}, "no variable 'snow'"),
        ({"evidence": {"wet": "maybe"}}, "no label 'maybe'"),
        ({"evidence": {"wet": ["no"]}}, "no label"),
        ({"evidence": {}}, "declared observed but has none"),
        ({"evidence": {"wet": "no"}, "engine": "magic"}, "choose one of numpy, gtsam, brute"),
        ({"evidence": {"wet": "no"}, "order": []}, "misses 'rain'"),
        ({"evidence": {"wet": "no"}, "order": ["rain", "rain"]}, "twice"),
        ({"evidence": {"wet": "no"}, "order": ["sun", "rain"]}, "no variable 'sun'"),
    ],
)
@pytest.mark.parametrize("ask", [infer, most_probable])
def test_bad_questions(ask, arguments, message):
    with pytest.raises(CogmapError, match=message) as caught:
        ask(weather(), **arguments)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("engine", ["numpy", "gtsam", "brute"])
@pytest.mark.parametrize("ask", [infer, most_probable])
def test_impossible_evidence_names_what_to_check(engine, ask):
    with pytest.raises(ImpossibleEvidence, match=r"wet='yes'.*P\(wet, rain\)") as caught:
        ask(weather(), evidence={"wet": "yes"}, engine=engine)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("engine", ["numpy", "gtsam", "brute"])
def test_a_factor_that_is_zero_everywhere_is_named(engine):
    graph = FactorGraph()
    graph.variable("a", [0, 1])
    graph.factor("wall", ["a"], [0.0, 0.0])
    with pytest.raises(ImpossibleEvidence, match=r"wall\(a\)"):
        infer(graph, engine=engine)


def test_evidence_must_agree_with_the_graph():
    graph = weather().observe("wet", "no")
    assert infer(graph, evidence={"wet": "no"}).evidence == {"wet": "no"}
    with pytest.raises(CogmapError, match="in the graph already"):
        infer(graph, evidence={"wet": "yes"})


@pytest.mark.parametrize("pairs", [["rain"], [("rain", "sun")], [()]])
def test_bad_pairs(pairs):
    with pytest.raises(CogmapError):
        infer(weather(), evidence={"wet": "no"}, pairs=pairs)


def test_bad_joints():
    posterior = infer(weather(), evidence={"wet": "no"})
    with pytest.raises(CogmapError, match="at least one"):
        posterior.joint()
    with pytest.raises(CogmapError, match="no variable 'sun'"):
        posterior.marginal("sun")
    with pytest.raises(CogmapError, match="no label"):
        posterior.probability("rain", "perhaps")
    with pytest.raises(CogmapError, match="no factor of the graph is tied"):
        posterior.expected_counts(object())


def dense_clique(variables, card):
    graph = FactorGraph()
    for i in range(variables):
        graph.variable(f"x{i}", range(card))
        for j in range(i):
            graph.factor("f", [f"x{j}", f"x{i}"], np.ones((card, card)))
    return graph


@pytest.mark.parametrize(("engine", "variables"), [("numpy", 9), ("gtsam", 7), ("brute", 8)])
def test_too_large_is_refused_before_memory_is_touched(engine, variables):
    with pytest.raises(CogmapError, match=r"entries|assignments"):
        infer(dense_clique(variables, 10), engine=engine)


def test_the_refusal_names_the_cluster_and_a_remedy():
    with pytest.raises(CogmapError, match=r"cluster \(x0, x1.*narrow the domains"):
        infer(dense_clique(9, 10))


def test_a_costly_time_order_falls_back_to_minimum_fill():
    graph = FactorGraph()
    graph.variable("hub", range(10), time=0)
    for i in range(12):
        graph.variable(f"leaf{i}", range(10), time=1)
        graph.factor("f", [f"leaf{i}", "hub"], np.full((10, 10), 0.1))
    assert infer(graph).log_evidence == pytest.approx(np.log(10))
    order = ["hub"] + [f"leaf{i}" for i in range(12)]
    with pytest.raises(CogmapError, match="give another `order`"):
        infer(graph, order=order)


@pytest.mark.parametrize("ask", [infer, most_probable])
@pytest.mark.parametrize("graph", [Agent({"stay": (0,)}), None, {"x": (0, 1)}], ids=["an agent", "None", "a dict"])
def test_what_is_no_graph_is_refused(ask, graph):
    with pytest.raises(CogmapError, match=r"is no factor graph; give one, such as agent\.graph"):
        ask(graph)


def test_the_posterior_does_not_follow_later_additions():
    graph = ladder(2, 3, 3, np.random.default_rng(0))
    posterior = infer(graph)
    graph.variable("new", [0, 1])
    with pytest.raises(CogmapError, match="no variable 'new'"):
        posterior.marginal("new")
