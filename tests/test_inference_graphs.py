"""Random factor graphs for the inference tests, and the reduction they all pass through."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from cogmap.inference import ImpossibleEvidence, compile_graph, infer
from cogmap.model import FactorGraph
from hypothesis import given, settings
from hypothesis import strategies as st

STYLES = ("dense", "zeros", "one-hot", "wide")


def random_values(rng, shape, style):
    values = rng.random(shape)
    if style == "zeros":
        values[rng.random(shape) < 0.4] = 0
    if style == "one-hot":
        rows = values.reshape(shape[0], -1)
        values = (rows == rows.max(axis=0)).astype(float).reshape(shape)
    if style == "wide":
        values = 10.0 ** rng.uniform(-18, 18, shape)
    return values


@st.composite
def graphs(draw, max_variables=6, styles=STYLES, timed=True):
    """Loopy graphs with zeros, one-hot tables, wide ranges, single-label and free variables, some with times."""
    cards = draw(st.lists(st.integers(1, 3), min_size=1, max_size=max_variables))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    graph = FactorGraph()
    for i, card in enumerate(cards):
        time = draw(st.sampled_from([None, 0, 1, 2])) if timed else None
        graph.variable(f"x{i}", [f"l{k}" for k in range(card)], time=time)
    for f in range(draw(st.integers(1, 8))):
        scope = draw(st.permutations(range(len(cards))))[: draw(st.integers(1, min(3, len(cards))))]
        values = random_values(rng, tuple(cards[i] for i in scope), draw(st.sampled_from(styles)))
        graph.factor(f"f{f}", [f"x{i}" for i in scope], values)
    return graph


@st.composite
def evidences(draw, graph):
    names = draw(st.lists(st.sampled_from([v.name for v in graph.variables]), max_size=2, unique=True))
    return {name: draw(st.sampled_from(graph.variable_named(name).domain)) for name in names}


def ladder(steps, places, positions, rng, *, one_hot=True):
    """The window of a map: places s, positions p, moved; sights and walls observed."""
    graph = FactorGraph()
    own = rng.permuted(np.resize(np.arange(positions), places))
    place = np.eye(positions)[:, own]
    if not one_hot:
        place = (place + 0.01) / (place + 0.01).sum(axis=0)
    for t in range(steps):
        graph.variable(f"s{t}", range(places), time=t)
        graph.variable(f"p{t}", range(positions), time=t)
        graph.variable(f"o{t}", ["green"], time=t, observed=True)
        graph.variable(f"c{t}", ["open"], time=t, observed=True)
        if t == 0:
            graph.factor("prior", ["s0", "p0"], rng.random((places, positions)), kind="prior")
        else:
            graph.variable(f"moved{t}", (False, True), time=t)
            go = rng.dirichlet(np.full(places, 0.3), size=(places, 2)).transpose(2, 0, 1)
            shift = rng.dirichlet(np.full(positions, 0.3), size=(positions, 2)).transpose(2, 0, 1)
            graph.factor("B_s", [f"s{t}", f"s{t - 1}", f"moved{t}"], go, kind="transition")
            graph.factor("B_p", [f"p{t}", f"p{t - 1}", f"moved{t}"], shift, kind="motion")
            graph.factor("P", [f"moved{t}"], [0.99, 0.01], kind="displacement")
        graph.factor("A_p", [f"p{t}", f"s{t}"], place, kind="place")
        graph.factor("A_o", [f"o{t}", f"s{t}"], rng.random((1, places)) * 1e-3, kind="sight")
        graph.factor("c", [f"c{t}", f"s{t}"], rng.random((1, places)), kind="walls")
    return graph


@settings(max_examples=60, deadline=None)
@given(graphs(styles=("one-hot", "one-hot", "dense")), st.data())
def test_substituted_variables_come_back_as_they_are_in_the_full_enumeration(graph, data):
    evidence = data.draw(evidences(graph))
    try:
        truth = infer(graph, evidence=evidence, engine="brute")
    except ImpossibleEvidence:
        with pytest.raises(ImpossibleEvidence):
            infer(graph, evidence=evidence)
        return
    found = infer(graph, evidence=evidence)
    assert found.log_evidence == pytest.approx(truth.log_evidence, abs=1e-9)
    for names in itertools.combinations([v.name for v in graph.variables], 2):
        np.testing.assert_allclose(found.joint(*names), truth.joint(*names), atol=1e-9)


@settings(max_examples=40, deadline=None)
@given(st.permutations(range(3)), st.permutations(range(4)), st.integers(0, 10_000))
def test_chains_of_determined_variables_follow_to_one_root(factors, variables, seed):
    rng = np.random.default_rng(seed)
    graph = FactorGraph()
    cards = [5, 4, 3, 2]
    for i in variables:
        graph.variable(f"x{i}", range(cards[i]))
    for i in factors:
        own = rng.permuted(np.resize(np.arange(cards[i + 1]), cards[i]))  # not one to one: x_i decides x_i+1
        graph.factor("f", [f"x{i + 1}", f"x{i}"], np.eye(cards[i + 1])[:, own] * rng.uniform(0.5, 1, cards[i]))
    graph.factor("g", ["x3"], rng.random(2))
    assert compile_graph(graph).bytes == 8 * (5 + 1)  # x0 alone is left
    found, truth = infer(graph), infer(graph, engine="brute")
    assert found.log_evidence == pytest.approx(truth.log_evidence, abs=1e-9)
    for names in itertools.combinations(["x3", "x1", "x0", "x2"], 3):
        np.testing.assert_allclose(found.joint(*names), truth.joint(*names), atol=1e-9)


def chain_of_places(steps, places):
    """What is left of a ladder whose positions are determined: places and `moved`."""
    graph = FactorGraph()
    for t in range(steps):
        graph.variable(f"s{t}", range(places), time=t)
        if t:
            graph.variable(f"moved{t}", (False, True), time=t)
            graph.factor("B", [f"s{t}", f"s{t - 1}", f"moved{t}"], np.ones((places, places, 2)))
    return graph


def test_a_ladder_with_one_hot_places_becomes_a_chain_of_places():
    graph = ladder(6, 5, 4, np.random.default_rng(0))
    assert compile_graph(graph).bytes == compile_graph(chain_of_places(6, 5)).bytes


def test_a_ladder_with_doubtful_places_keeps_its_positions():
    graph = ladder(6, 5, 4, np.random.default_rng(0), one_hot=False)
    assert compile_graph(graph).bytes > 2 * compile_graph(chain_of_places(6, 5)).bytes


def test_a_determined_variable_stays_where_replacing_it_would_enlarge_a_cluster():
    graph = FactorGraph()
    rng = np.random.default_rng(0)
    for t in range(3):
        graph.variable(f"u{t}", range(8), time=t)
        graph.variable(f"v{t}", range(2), time=t)
        graph.factor("f", [f"v{t}", f"u{t}"], np.eye(2)[:, np.arange(8) % 2])
        if t:
            graph.factor("B", [f"v{t}", f"v{t - 1}"], rng.random((2, 2)))
    # three clusters (u, v) with messages over v, and (v, v), (v, v), (v): not (u, u)
    assert compile_graph(graph).bytes == 8 * (3 * (16 + 2) + 2 * (4 + 2) + 2 + 1)
