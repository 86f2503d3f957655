"""Factor graphs as JSON, HTML, SVG and Graphviz source."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from html.parser import HTMLParser
from typing import Any

import numpy as np
import pytest
from cogmap.model import CogmapError, ConditionalTable, FactorGraph, sparse_values
from cogmap.worlds import load_world
from hypothesis import given, settings
from hypothesis import strategies as st
from walks import walked

LABELS = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text(),
    lambda parts: st.lists(parts, max_size=3).map(tuple),
    max_leaves=4,
)
NUMBERS = st.floats(min_value=0.0, max_value=1e300) | st.sampled_from([0.0, 1e-323, 0.1, 1.0])
NASTY = '<b>"&amp;\\N\n\t\x01\ud7ff{}|</b>'


@st.composite
def graphs(draw: Any) -> FactorGraph:
    graph = FactorGraph()
    for i, name in enumerate(draw(st.lists(st.text(min_size=1), min_size=1, max_size=4, unique=True))):
        domain = draw(st.lists(LABELS, min_size=1, max_size=3, unique=True))
        graph.variable(f"{name}{i}", domain, time=draw(st.none() | st.integers(-3, 3)), observed=draw(st.booleans()))
    names = [variable.name for variable in graph.variables]
    for i in range(draw(st.integers(0, 4))):
        scope = draw(st.lists(st.sampled_from(names), min_size=1, max_size=2, unique=True))
        shape = tuple(graph.variable_named(name).cardinality for name in scope)
        flat = draw(st.lists(NUMBERS, min_size=int(np.prod(shape)), max_size=int(np.prod(shape))))
        values: Any = np.reshape(flat, shape)
        if draw(st.booleans()):
            values = sparse_values(shape, np.argwhere(values > 0.5), values[values > 0.5])
        graph.factor(f"{draw(st.text())}f{i}", scope, values, kind=draw(st.text()), equation=draw(st.text()))
    seen = {name: draw(st.sampled_from(graph.variable_named(name).domain)) for name in names if draw(st.booleans())}
    return graph.observe_all(seen)


@settings(max_examples=60, deadline=None)
@given(graphs())
def test_json_brings_back_the_same_graph(graph: FactorGraph) -> None:
    text = graph.to_json()
    twin = FactorGraph.from_json(text)
    assert twin.same_as(graph)
    assert twin == graph
    assert twin.to_json() == text
    assert repr(twin) == repr(graph)
    assert FactorGraph.from_dict(json.loads(graph.to_json(indent=1))).same_as(graph)


def weather(**changes: Any) -> FactorGraph:
    facts = {"label": 1, "time": 0, "p": 0.25, "kind": "prior", "equation": "P(x)", "seen": 1, "name": "P"} | changes
    graph = FactorGraph()
    graph.variable("x", (0, facts["label"]), time=facts["time"])
    graph.variable("y", ("a", ("b", None, 0.5)), observed=bool(changes.get("observed")))
    graph.factor(facts["name"], ["x"], [1 - facts["p"], facts["p"]], kind=facts["kind"], equation=facts["equation"])
    graph.factor("S", ["y", "x"], sparse_values((2, 2), [[0, 1], [1, 0]], [facts["p"], 1.0]))
    return graph.observe("x", facts["seen"])


CHANGES = [
    {"label": True},
    {"label": 1.0},
    {"time": None},
    {"time": 1},
    {"observed": True},
    {"p": np.nextafter(0.25, 1.0)},
    {"kind": "x"},
    {"equation": ""},
    {"seen": 0},
    {"name": "Q"},
]


@pytest.mark.parametrize("change", CHANGES, ids=str)
def test_graphs_that_differ_in_anything_are_not_the_same(change: dict[str, Any]) -> None:
    assert weather() == weather()
    assert weather() != weather(**change)
    assert weather() != "weather"
    assert not weather().same_as(weather(**change))
    assert not FactorGraph.from_json(weather().to_json()).same_as(weather(**change))


def test_more_factors_sparse_and_dense_are_told_apart() -> None:
    more, dense = weather(), FactorGraph()
    more.factor("M", ["x"], [1, 1])
    assert not weather().same_as(more)
    for variable in weather().variables:
        dense.add_variable(variable)
    for factor in weather().factors:
        dense.factor(factor.name, factor.scope, factor.dense(), kind=factor.kind, equation=factor.equation)
    assert not dense.observe("x", 1).same_as(weather())
    np.testing.assert_array_equal(dense.factor_named("S").dense(), weather().factor_named("S").dense())


def test_numpy_labels_become_plain_ones() -> None:
    graph = FactorGraph()
    graph.variable("x", np.arange(3), time=np.int64(2))  # type: ignore[arg-type]
    twin = FactorGraph.from_json(graph.to_json())
    assert [type(label) for label in twin.variables[0].domain] == [int] * 3
    assert twin.same_as(graph)


def test_shared_tables_stay_shared_and_go_on_learning() -> None:
    graph, table = FactorGraph(), ConditionalTable([[1.0, 2.0], [1.0, 0.1]])
    for t in range(3):
        graph.variable(f"s{t}", ("a", "b"), time=t)
    for t in (1, 2):
        graph.conditional(f"s{t}", [f"s{t - 1}"], table, name="B")
    table.learn([[1, 0], [0, 3]])
    twin = FactorGraph.from_json(graph.to_json())
    restored = [factor.table for factor in twin.factors]
    assert restored[0] is restored[1]
    assert twin.same_as(graph)
    assert twin.refreshed().same_as(graph.refreshed())
    assert not twin.refreshed().same_as(graph)


def test_the_window_of_an_agent_comes_back() -> None:
    graph = walked(load_world("3x3_alias"), 6).graph
    assert FactorGraph.from_json(graph.to_json()).same_as(graph)


@pytest.mark.parametrize("label", [frozenset({1}), b"x", float("inf"), ("a", 1j)])
def test_labels_that_json_cannot_hold(label: Any) -> None:
    graph = FactorGraph()
    graph.variable("x", [label])
    with pytest.raises(CogmapError, match=r"^graph: cannot write label .*label with"):
        graph.to_json()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "no JSON"),
        ("[" * 100_000, "no JSON"),
        ("3", "no factor graph"),
        ("[]", "no factor graph"),
        ('{"format": "x"}', "no factor graph"),
        ('{"format": "cogmap factor graph", "schema": 9}', "schema 9"),
        ('{"format": "cogmap factor graph", "schema": 1}', "damaged"),
    ],
)
def test_what_is_no_graph(text: str, message: str) -> None:
    with pytest.raises(CogmapError, match=message) as raised:
        FactorGraph.from_json(text)
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize("wrong", [None, 3, "x", [3], {"tuple": 3}, -1, [[]]])
def test_damaged_graphs_are_refused(wrong: Any) -> None:
    graph = weather()
    graph.conditional("y", ["x"], ConditionalTable(np.ones((2, 2))))
    whole, refused = graph.to_dict(), 0
    for key in ("variables", "factors", "evidence", "tables"):
        for part in [None, *(whole[key][0] if isinstance(whole[key], list) else whole[key])]:
            damaged = json.loads(json.dumps(whole))
            if part is None:
                damaged[key] = wrong
            elif isinstance(whole[key], list):
                damaged[key][0][part] = wrong
            else:
                damaged[key][part] = wrong
            try:
                FactorGraph.from_dict(damaged)
            except CogmapError:
                refused += 1
    assert refused >= 6


# -- Graphviz --------------------------------------------------------------------------------------------------


def accepted(source: str) -> str:
    if shutil.which("dot") is None and not os.environ.get("CI"):
        pytest.skip("Graphviz' dot is not installed")
    run = subprocess.run(["dot", "-Tplain"], input=source.encode(), capture_output=True, check=False, timeout=120)
    assert run.returncode == 0, run.stderr
    assert run.stderr == b""
    return run.stdout.decode()


def test_graphviz_accepts_a_window_and_a_map() -> None:
    agent = walked(load_world("3x3_alias"), 6)
    drawn = accepted(agent.graph.to_dot())
    assert drawn.count("\nnode") == len(agent.graph.variables) + len(agent.graph.factors)
    drawn = accepted(agent.map.to_dot())
    assert drawn.count("\nnode") == len(agent.map.places)


def test_graphviz_accepts_any_names_and_shows_them() -> None:
    graph = FactorGraph()
    graph.variable(NASTY, [NASTY], observed=True)
    graph.variable("y" * 20_000, [0])
    graph.factor("graph", [NASTY], [1.0], kind=NASTY)
    accepted(graph.to_dot())
    simple = FactorGraph()
    simple.variable("a&lt;b", [0])
    assert "a&lt;b" in accepted(simple.to_dot())


# -- notebooks -------------------------------------------------------------------------------------------------


class Tags(HTMLParser):
    """Collects the tags and the text of a page."""

    def __init__(self) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.text: list[str] = []

    def handle_starttag(self, tag: str, attrs: Any) -> None:
        self.tags.append(tag)

    def handle_data(self, data: str) -> None:
        self.text.append(data)


def test_html_has_the_equation_first_and_escapes_everything() -> None:
    graph = weather()
    graph.variable(NASTY, [NASTY, 2])
    graph.factor(NASTY, [NASTY], [1, 1], kind="<script>", equation="<i>")
    page = Tags()
    page.feed(graph._repr_html_())
    assert page.text[0] == repr(graph).replace("\x01", "\ufffd")
    assert set(page.tags) == {"div", "code", "table", "thead", "tbody", "tr", "th", "td"}
    for part in ("P(x)", "prior", "observed: 1", "2 x 2", "<script>"):
        assert part in page.text
    many = FactorGraph()
    for i in range(100):
        many.variable(f"x{i}", range(50))
    assert "… 70 more" in many._repr_html_()
    assert "(50 in all)" in many._repr_html_()
