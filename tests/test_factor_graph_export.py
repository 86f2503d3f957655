"""Factor graphs as networkx graphs and as Graphviz source."""

from __future__ import annotations

import re

import networkx as nx
import numpy as np
from cogmap.model import FactorGraph, equation, quoted
from hypothesis import given
from hypothesis import strategies as st

TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|--|[A-Za-z_][A-Za-z_0-9]*|[0-9.]+|[\[\]{}=,;]|\s+', re.DOTALL)


def slices():
    graph = FactorGraph()
    graph.variable("s0", ["hall", "kitchen"], time=0)
    graph.variable("s1", ["hall", "kitchen"], time=1)
    graph.variable("o1", ["red", "blue"], time=1, observed=True)
    graph.factor("prior", ["s0"], [0.5, 0.5], kind="prior")
    graph.factor("B_s", ["s1", "s0"], np.eye(2), kind="transition", equation="P(s'|s)")
    graph.factor("A_o", ["o1", "s1"], np.eye(2), kind="sight")
    return graph


def test_networkx_is_bipartite_and_says_everything():
    graph = slices().observe("o1", "red")
    net = graph.to_networkx()
    variables = {node for node, side in net.nodes(data="bipartite") if side == 0}
    assert variables == {"s0", "s1", "o1"}
    assert nx.bipartite.is_bipartite_node_set(net, variables)
    assert set(net["B_s(s1, s0)"]) == {"s0", "s1"}
    assert net.edges["s1", "B_s(s1, s0)"]["axis"] == 0
    assert net.nodes["s1"] | {"label": 0} == {
        "bipartite": 0,
        "node": "variable",
        "label": 0,
        "domain": ("hall", "kitchen"),
        "time": 1,
        "observed": False,
        "evidence": None,
    }
    assert net.nodes["o1"]["observed"]
    assert net.nodes["o1"]["evidence"] == "red"
    factor = net.nodes["B_s(s1, s0)"]
    assert (factor["kind"], factor["scope"], factor["shape"]) == ("transition", ("s1", "s0"), (2, 2))
    assert factor["equation"] == "P(s'|s)"


def test_dot_has_a_node_each_and_tells_observed_from_latent():
    lines = slices().to_dot().splitlines()
    assert lines[0] == "graph factor_graph {"
    assert lines[-1] == "}"
    assert sum("shape=ellipse" in line for line in lines) == 3
    assert sum("shape=box" in line for line in lines) == 3
    assert sum(" -- " in line for line in lines) == 5
    assert [line for line in lines if "style=filled" in line] == [line for line in lines if 'label="o1"' in line]


@given(st.text(min_size=1))
def test_quoted_text_is_one_graphviz_string(text):
    token = quoted(text)
    assert re.fullmatch(r'"(?:[^"\\]|\\["\\n])*"', token)
    shown = re.sub(r"\\(.)", lambda m: "\n" if m[1] == "n" else m[1], token[1:-1])
    assert shown.replace("&amp;", "&") == text.replace("\0", "").replace("\r", "")


@given(st.text(min_size=1), st.text(min_size=1), st.text())
def test_dot_is_tokens_of_the_language_whatever_the_names(name, label, kind):
    graph = FactorGraph()
    graph.variable(name, [label], observed=True)
    graph.factor(label, [name], [1.0], kind=kind)
    source = graph.to_dot()
    assert "".join(match[0] for match in TOKEN.finditer(source)) == source
    assert graph.to_networkx().number_of_nodes() == 2


def test_the_full_equation_leaves_nothing_out():
    graph = FactorGraph()
    for i in range(20):
        graph.variable(f"x{i}", [0, 1])
        graph.factor("f", [f"x{i}"], [1, 1])
    assert equation(graph).count("f(x") == 20
