"""Graphs in the files of other programs: what is written is read back, and malformed files are refused by line."""

from __future__ import annotations

import json
import math

import networkx as nx
import numpy as np
import pytest
from cogmap.inference import infer
from cogmap.model import (
    CogmapError,
    FactorGraph,
    load_graph,
    read_bif,
    read_uai,
    read_uai_evidence,
    read_xmlbif,
    save_graph,
    write_bif,
    write_graphml,
    write_uai,
    write_uai_evidence,
    write_xmlbif,
)
from hypothesis import given, settings
from hypothesis import strategies as st

DOG = """// a comment
network dog { property author = nobody; }
variable family-out { type discrete[2] { true, false }; property position = (1, 2); }
variable "light on" { type discrete [ 2 ] { true, "not true" }; }
variable bark { /* two
lines */ type discrete [ 3 ] { <5, 5-10, 12+ }; }
probability ( family-out ) { table 0.15 0.85; }
probability ( "light on" | family-out ) { table 0.6 0.05 0.4 0.95; }
probability ( bark | family-out, "light on" ) {
  default 0.2, 0.3, 0.5;
  (true, true) 1e-1, 0.2, 0.7;
}
"""
XML = """<?xml version="1.0" encoding="US-ASCII"?>
<!DOCTYPE BIF [ <!ELEMENT BIF ( NETWORK )*> ]>
<BIF VERSION="0.3">
<NETWORK>
<NAME>Dog</NAME>
<VARIABLE TYPE="nature"><NAME>family-out</NAME><OUTCOME>true</OUTCOME><OUTCOME>false</OUTCOME></VARIABLE>
<VARIABLE TYPE="nature"><NAME>light</NAME><OUTCOME>on &amp; bright</OUTCOME><OUTCOME>off</OUTCOME></VARIABLE>
<DEFINITION><FOR>family-out</FOR><TABLE>.15 .85</TABLE></DEFINITION>
<DEFINITION><FOR>light</FOR><GIVEN>family-out</GIVEN>
<TABLE>0.6 0.4
0.05 0.95</TABLE></DEFINITION>
</NETWORK>
</BIF>
"""
UAI = """MARKOV
3
2 2 3
2
2 0 1
3 1 2 0
4
 4.0 2.4
 1.0 0.0
12
 2.25 3.25 3.75 0.0 0.0 10.0
 1.875 4.0 3.333 2.0 2.0 3.4
"""


def test_bif_reads_tables_defaults_rows_comments_and_quotes():
    graph = read_bif(DOG)
    assert [variable.name for variable in graph.variables] == ["family-out", "light on", "bark"]
    assert graph.variable_named("bark").domain == ("<5", "5-10", "12+")
    light = graph.factor_named("P(light on, family-out)")
    np.testing.assert_allclose(light.dense(), [[0.6, 0.05], [0.4, 0.95]])
    bark = graph.factor_named("P(bark, family-out, light on)").dense()
    np.testing.assert_allclose(bark[:, 0, 0], [0.1, 0.2, 0.7])
    np.testing.assert_allclose(bark[:, 1, 0], [0.2, 0.3, 0.5])
    assert infer(graph).log_evidence == pytest.approx(0, abs=1e-12)


def test_xmlbif_lists_the_child_fastest():
    graph = read_xmlbif(XML)
    light = graph.factor_named("P(light, family-out)")
    np.testing.assert_allclose(light.dense(), [[0.6, 0.05], [0.4, 0.95]])
    assert graph.variable_named("light").domain == ("on & bright", "off")


def test_uai_lists_the_last_variable_fastest():
    graph = read_uai(UAI, "1\n2 0 1 2 2\n")
    assert dict(graph.evidence) == {"x0": 1, "x2": 2}
    np.testing.assert_allclose(graph.factor_named("f0").dense(), [[4.0, 2.4], [1.0, 0.0]])
    assert graph.factor_named("f1").dense()[1, 2, 0] == 2.0
    assert read_uai_evidence("2 0 1 2 2", graph) == {"x0": 1, "x2": 2}
    assert read_uai_evidence("0", graph) == read_uai_evidence("\n", graph) == read_uai_evidence("1 0", graph) == {}
    bayes = read_uai("BAYES 2 2 3 2 1 0 2 0 1 2 .5 .5 6 .1 .2 .7 .3 .3 .4")
    assert bayes.factors[1].label == "f1(x1, x0)"
    np.testing.assert_allclose(bayes.factors[1].dense()[:, 0], [0.1, 0.2, 0.7])


@st.composite
def networks(draw):
    """Small Bayesian networks with odd names."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    text = st.text(st.characters(codec="utf-8", exclude_characters='"', exclude_categories=["C", "Z"]), min_size=1)
    names = draw(st.lists(text, min_size=1, max_size=4, unique=True))
    graph = FactorGraph()
    for at, name in enumerate(names):
        graph.variable(name, draw(st.lists(text, min_size=1, max_size=3, unique=True)))
        parents = draw(st.permutations(names[:at]))[:2]
        shape = [graph.variable_named(each).cardinality for each in [name, *parents]]
        values = rng.dirichlet(np.ones(shape[0]), size=shape[1:])
        graph.factor("P", [name, *parents], np.moveaxis(values, -1, 0), kind="conditional")
    return graph


def assert_same(found, graph):
    assert [(v.name, v.domain) for v in found.variables] == [(v.name, v.domain) for v in graph.variables]
    for one, other in zip(found.factors, graph.factors, strict=True):
        assert one.label == other.label
        np.testing.assert_allclose(one.dense(), other.dense(), rtol=1e-14)


@settings(max_examples=60, deadline=None)
@given(networks())
def test_networks_come_back(graph):
    assert_same(read_bif(write_bif(graph)), graph)
    assert_same(read_xmlbif(write_xmlbif(graph)), graph)
    for bayes in (True, False):
        again = read_uai(write_uai(graph, bayes=bayes))
        for one, other in zip(again.factors, graph.factors, strict=True):
            np.testing.assert_array_equal(one.dense(), other.dense())


def test_files_go_by_their_suffix(tmp_path):
    graph = read_bif(DOG)
    for suffix in (".bif", ".xmlbif", ".json"):
        save_graph(graph, tmp_path / f"dog{suffix}")
        assert_same(load_graph(tmp_path / f"dog{suffix}"), graph)
    save_graph(graph, tmp_path / "dog.uai")
    (tmp_path / "dog.evid").write_text(write_uai_evidence(graph, {"bark": "12+"}))
    again = load_graph(tmp_path / "dog.uai", evidence=tmp_path / "dog.evid")
    assert infer(again).log_evidence == pytest.approx(infer(graph, evidence={"bark": "12+"}).log_evidence)
    for name, message in (("dog.txt", "unknown suffix"), ("no.bif", "cannot be read")):
        with pytest.raises(CogmapError, match=message):
            load_graph(tmp_path / name)
    (tmp_path / "bad.bif").write_text(DOG.replace("0.95", "often"))
    with pytest.raises(CogmapError, match=r"bad\.bif: BIF, line 8"):
        load_graph(tmp_path / "bad.bif")
    with pytest.raises(CogmapError, match="cannot write"):
        save_graph(graph, tmp_path / "none" / "dog.bif")


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ("0.95;", "0.95 0.1;", 8, "5 numbers"),
        ("0.95;", "often;", 8, "often"),
        ("0.95;", "0.5;", 8, "sums to"),
        ("0.95;", "-0.95;", 8, "negative"),
        ("0.95;", "nan;", 8, "missing"),
        ("0.95; }", "0.95 }", 8, "semicolon"),
        ("(true, true)", "(true, maybe)", 11, "label is unknown"),
        ("(true, true)", "(true)", 11, "do not fit"),
        ("  default 0.2, 0.3, 0.5;\n", "", 9, "missing"),
        ("( bark | family-out,", "( bark | cat,", 9, "unknown variable 'cat'"),
        ("( bark | family-out,", "( bark | bark,", 9, "each variable once"),
        ('( bark | family-out, "light on"', "( family-out", 10, "do not fit"),
        ("[ 3 ]", "[ 4 ]", 6, "3 labels, not 4"),
        ("5-10", "<5", 6, "2 labels"),
        ("variable bark", "variable family-out", 5, "second variable"),
        ("type discrete[2]", "type continuous", 3, "type discrete"),
        ("variable bark", "node bark", 5, "expected 'variable'"),
        ("(true, true) 1e-1, 0.2, 0.7;\n}", "(true, true) 1e-1, 0.2, 0.7;\n", 9, "does not end"),
    ],
)
def test_malformed_bif(old, new, line, message):
    assert old in DOG
    with pytest.raises(CogmapError, match=message) as caught:
        read_bif(DOG.replace(old, new))
    assert f"line {line}:" in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("text", ["", "hello", "network x { }"])
def test_no_bif_at_all(text):
    with pytest.raises(CogmapError, match="BIF, line 1"):
        read_bif(text)


def test_a_variable_without_a_table_or_with_two():
    with pytest.raises(CogmapError, match="line 5: variable 'bark' has no table"):
        read_bif(DOG[: DOG.index("probability ( bark")])
    with pytest.raises(CogmapError, match="line 13: a second table"):
        read_bif(DOG + "probability ( family-out ) { table 0.5 0.5; }")


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ("</NETWORK>", "", 13, "no XML"),
        ("0.05 0.95", "0.05", 10, "does not fit"),
        ("0.05 0.95", "0.05 much", 10, "does not fit"),
        ("0.05 0.95", "0.05 0.5", 9, "sums to"),
        ("<GIVEN>family-out", "<GIVEN>cat", 9, "unknown variable 'cat'"),
        ("<GIVEN>family-out", "<GIVEN>light", 9, "twice"),
        ("<OUTCOME>off</OUTCOME>", "", 9, "does not fit|sums"),
        ("<NAME>light</NAME>", "", 7, "0 elements NAME"),
        ("<NAME>light</NAME>", "<NAME>family-out</NAME>", 7, "twice"),
        ("<FOR>light</FOR>", "", 9, "0 elements FOR"),
    ],
)
def test_malformed_xmlbif(old, new, line, message):
    assert old in XML
    with pytest.raises(CogmapError, match=message) as caught:
        read_xmlbif(XML.replace(old, new))
    assert f"line {line}:" in str(caught.value) or (old.startswith("<OUTCOME>") and "line 10:" in str(caught.value))


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ("MARKOV", "CLIQUES", 1, "MARKOV"),
        ("2 2 3", "2 two 3", 3, "'two'"),
        ("2 2 3", "2 0 3", 3, "'0'"),
        ("2 0 1\n", "2 0 7\n", 5, "'7'"),
        ("2 0 1\n", "2 0 0\n", 5, "twice"),
        ("\n4\n", "\n5\n", 7, "need 4"),
        (" 1.0 0.0\n", " 1.0 -1.0\n", 9, "'-1.0'"),
        (" 1.0 0.0\n", " 1.0 inf\n", 9, "'inf'"),
        ("3.4\n", "\n", 12, "ends within"),
        ("3.4\n", "3.4 7\n", 12, "after the end"),
    ],
)
def test_malformed_uai(old, new, line, message):
    assert old in UAI
    with pytest.raises(CogmapError, match=message) as caught:
        read_uai(UAI.replace(old, new, 1))
    assert f"line {line}:" in str(caught.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("1 9 0", "'9'"),
        ("1 0 9", "'9'"),
        ("1", "ends"),
        ("2 2 0 0 1 1", "2 samples"),
        ("x", "'x'"),
    ],
)
def test_malformed_evidence(text, message):
    with pytest.raises(CogmapError, match=message) as caught:
        read_uai_evidence(text, read_uai(UAI))
    assert "line 1:" in str(caught.value)


def test_formats_of_networks_refuse_what_they_cannot_hold():
    markov = read_uai(UAI)
    cycle = FactorGraph()
    for name in "ab":
        cycle.variable(name, (0, 1))
    cycle.factor("P", ["a", "b"], np.full((2, 2), 0.5))
    cycle.factor("P", ["b", "a"], np.full((2, 2), 0.5))
    mixed = FactorGraph()
    mixed.variable("x", (1, "1"))
    mixed.factor("P", ["x"], [0.5, 0.5])
    for write in (write_bif, write_xmlbif):
        for graph, message in ((markov, "no Bayesian network"), (cycle, "cycle"), (mixed, "same as text")):
            with pytest.raises(CogmapError, match=message):
                write(graph)
    with pytest.raises(CogmapError, match="soft evidence"):
        write_uai_evidence(markov.observe("x0", {0: 0.5, 1: 1.0}))
    quoted = FactorGraph()
    quoted.variable('a"b', (0, 1))
    quoted.factor("P", ['a"b'], [0.5, 0.5])
    with pytest.raises(CogmapError, match="quotation marks"):
        write_bif(quoted)


def test_graphml_of_graphs_and_of_other_networks(tmp_path):
    graph = FactorGraph()
    graph.variable("s0", [(0, 1), "hall"], time=0)
    graph.variable("o0", ["red", "blue"], observed=True)
    graph.factor("A", ["o0", "s0"], np.full((2, 2), 0.5), kind="sight")
    save_graph(graph.observe("o0", "red"), tmp_path / "graph.graphml")
    again = nx.read_graphml(tmp_path / "graph.graphml")
    assert json.loads(again.nodes["s0"]["domain"]) == [[0, 1], "hall"]
    assert again.nodes["s0"]["time"] == 0
    assert again.nodes["o0"]["evidence"] == "red"
    assert again.edges["o0", "A(o0, s0)"]["axis"] == 0
    walk = nx.MultiDiGraph()
    walk.add_node(0, position=(0, 1), sights={"red": 0.5}, visited=np.bool_(True), note=None)
    walk.add_edge(0, 0, key="stay", probability=np.float64(0.25))
    (tmp_path / "walk.graphml").write_text(write_graphml(walk))
    again = nx.read_graphml(tmp_path / "walk.graphml")
    assert json.loads(again.nodes["0"]["position"]) == [0, 1]
    assert json.loads(again.nodes["0"]["sights"]) == {"red": 0.5}
    assert list(again.edges(data="probability")) == [("0", "0", 0.25)]
    assert math.isclose(again.number_of_edges(), 1)
