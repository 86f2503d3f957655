"""Tables with labels: plain text, pandas frames, and those of factors and maps."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pytest
from cogmap.model import (
    CogmapError,
    CognitiveMap,
    ConditionalTable,
    FactorGraph,
    LabelledTable,
    Motions,
    counts_of,
    labelled,
    map_table,
    table,
)
from cogmap.worlds import load_world
from hypothesis import given, settings
from hypothesis import strategies as st
from walks import GRID, walked


@pytest.fixture
def without_pandas(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)


def sensor() -> FactorGraph:
    graph = FactorGraph()
    graph.variable("o", ("red", (0, 1), True, 1.5), observed=True)
    graph.variable("s", ("hall", None))
    graph.variable("m", (False, True))
    graph.factor("prior", ["s"], [0.25, 0.75])
    graph.factor("A", ["o", "s"], np.arange(8).reshape(4, 2) / 8, equation="P(o | s)")
    graph.factor("J", ["o", "s", "m"], np.arange(16).reshape(4, 2, 2) / 16)
    return graph


def test_a_factor_has_labels_on_both_axes() -> None:
    graph = sensor()
    shown = labelled(graph.factor_named("A"))
    assert (shown.index, shown.columns) == (("red", (0, 1), True, 1.5), ("hall", None))
    assert (shown.index_name, shown.column_names) == ("o", ("s",))
    assert shown.title == "A(o, s): P(o | s)"
    np.testing.assert_array_equal(shown.cells, graph.factor_named("A").dense())
    joint = labelled(graph.factor_named("J"))
    assert joint.columns == (("hall", False), ("hall", True), (None, False), (None, True))
    column = joint.columns.index((None, True))
    np.testing.assert_array_equal(np.asarray(joint.cells)[:, column], graph.factor_named("J").dense()[:, 1, 1])
    assert labelled(graph.factor_named("prior")).columns == ("value",)


def test_plain_text_is_aligned() -> None:
    shown = sensor().table("A")
    assert isinstance(shown, LabelledTable)
    assert str(shown).splitlines() == [
        "A(o, s): P(o | s)",
        "o \\ s   hall   None",
        "red        0  0.125",
        "(0, 1)  0.25  0.375",
        "True     0.5  0.625",
        "1.5     0.75  0.875",
    ]


@settings(max_examples=40, deadline=None)
@given(st.lists(st.text(min_size=1) | st.integers() | st.tuples(st.text()), min_size=1, max_size=5, unique=True))
def test_plain_text_is_one_line_a_row_whatever_the_labels(labels: list[Any]) -> None:
    shown = LabelledTable(np.zeros((len(labels), 1)), tuple(labels), ("x",), "row")
    lines = str(shown).split("\n")
    assert len(lines) == 1 + len(labels)
    assert shown.html().count("<tr>") == 1 + len(labels)


def test_wide_and_long_tables_are_cut_and_counted() -> None:
    shown = LabelledTable(np.ones((100, 30)), tuple(range(100)), tuple(range(30)))
    lines = shown.text(most_rows=3, most_columns=2).splitlines()
    assert lines[-2:] == ["… 97 more rows", "… 28 more columns"]
    assert len(lines) == 1 + 3 + 2
    assert "… 40 more" in shown.html()
    wide = LabelledTable([["日本", 1], ["b", None]], ("x", "y"), ("名", "n"))
    assert wide.text().splitlines() == ["   名    n", "x  日本  1", "y  b     -"]


def test_pandas_frames_have_the_same_labels_and_numbers() -> None:
    pytest.importorskip("pandas")
    graph = sensor()
    frame: Any = graph.table("A").to_pandas()
    assert list(frame.index) == ["red", (0, 1), True, 1.5]
    assert list(frame.columns) == ["hall", None]
    assert (frame.index.name, frame.columns.name) == ("o", "s")
    np.testing.assert_array_equal(frame.to_numpy(), graph.factor_named("A").dense())
    assert frame.loc["red", "hall"] == 0.0
    joint: Any = graph.table("J(o, s, m)").to_pandas()
    assert joint.columns.names == ["s", "m"]
    assert joint["hall"][True]["red"] == graph.factor_named("J").dense()[0, 0, 1]
    frame.iloc[0, 0] = 9.0  # a copy: the factor stays as it is
    assert graph.factor_named("A").dense()[0, 0] == 0.0


def test_without_pandas_one_line_says_how_to_get_it(without_pandas: None) -> None:
    with pytest.raises(CogmapError, match=r"^table: pandas is not installed; run: pip install 'cogmap\[tables\]'$"):
        labelled(sensor().factor_named("A")).to_pandas()


def test_learnable_tables_and_wrong_things() -> None:
    shown = table(ConditionalTable([[1.0, 3.0], [1.0, 1.0]]))
    assert isinstance(shown, LabelledTable)
    assert np.asarray(shown.cells)[0].tolist() == [0.5, 0.75]
    with pytest.raises(CogmapError, match="cannot show a int"):
        table(3)  # type: ignore[arg-type]
    with pytest.raises(CogmapError, match="do not fit"):
        LabelledTable([[1, 2]], ("a",), ("b",))
    with pytest.raises(CogmapError, match="factors are called"):
        sensor().table("nothing")


# -- maps ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["A_o", "A_p", "B_s"])
def test_map_tables_are_the_arrays_with_labels(name: str) -> None:
    map_ = walked(load_world("3x3_alias"), 7).map
    for action in range(5) if name == "B_s" else [None]:
        shown = map_table(map_, name, action=action)
        dense = {"A_o": map_.A(), "A_p": map_.positions_given_places(), "B_s": map_.B()[:, :, action or 0]}[name]
        cells = np.asarray(shown.cells)
        np.testing.assert_allclose(cells.sum(axis=0), 1.0, atol=1e-12)
        domain = {"A_o": map_.sights, "A_p": map_.positions}.get(name)
        for row, label in enumerate(shown.index[:-1]):
            number = label if domain is None else domain.index(label)
            np.testing.assert_allclose(cells[row], dense[number], atol=1e-15)
        if name != "A_o":
            np.testing.assert_allclose(cells[-1], dense[-1], atol=1e-12)


def test_places_asked_for_bring_only_their_outcomes() -> None:
    map_ = walked(load_world("4x4"), 12).map
    shown = map_table(map_, "A_o", places=[3, 0])
    assert shown.columns == (3, 0)
    assert len(shown.index) == 1 + len({map_.A_o.keys(np.array([place]))[0, 0] for place in (3, 0)})
    up = map_table(map_, "B_s", action="up", places=[3])
    assert len(up.index) <= 3
    assert up.title == "B_s: P(next place | place, up)"
    pytest.importorskip("pandas")
    frame: Any = map_.table("B_s", action="up", places=[3]).to_pandas()
    assert frame.loc[3, 3] == pytest.approx(map_.transition(3, 3, 0))


def test_counts_of_a_place_leave_the_prior_out() -> None:
    map_ = CognitiveMap(Motions.of(GRID))
    map_.new_place((0, 0), step=0)
    assert all(not found for found in counts_of(map_, 0).values())
    map_.sensors["sight"].read("hall", step=0)
    map_.A_o.add(0, 0, 2.0)
    map_.B_s.add(map_.row(0, 1), -1, 3.0)
    assert counts_of(map_, 0)["A_o"] == {"hall": 2.0}
    assert counts_of(map_, 0)["B_s[down]"] == {"(elsewhere)": 3.0}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"name": "A"}, "no table 'A'"),
        ({"name": "B_s"}, "one table an action"),
        ({"name": "B_s", "action": "jump"}, "no action 'jump'; choose one of up"),
        ({"name": "B_s", "action": 5}, "no action 5"),
        ({"name": "B_s", "action": True}, "no action True"),
        ({"name": "A_o", "action": "up"}, "A_o has no actions"),
        ({"name": "A_o", "places": [0, 99]}, "no place 99; places are 0 to"),
        ({"name": "A_o", "places": [-1]}, "no place -1"),
    ],
)
def test_tables_that_a_map_does_not_have(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        walked(load_world("3x3"), 2).map.table(**arguments)
