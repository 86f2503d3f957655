"""Reports: what stands in the tables stands in the files, and the page needs nothing but itself."""

from __future__ import annotations

import csv
import json
import re
import sys
from base64 import b64decode
from io import StringIO
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from cogmap.experiments.studies import about, frame
from cogmap.experiments.studies.failures import failures
from cogmap.experiments.studies.frame import STUDIES, Study
from cogmap.experiments.studies.json_tables import flat, json_tables
from cogmap.experiments.studies.machine import machine, processor, versions
from cogmap.experiments.studies.report import Report, Table, shown
from cogmap.experiments.studies.report_html import html_page
from cogmap.model import CogmapError
from command_line import cogmap
from hypothesis import given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st
from matplotlib.figure import Figure
from pages import Page

NASTY = "a|b *c* _d_ <e> `f` [g](h) & ![i](j) \\ k_l"

# -- the document ------------------------------------------------------------------------------------------


def test_text_is_shown_as_it_is() -> None:
    report = Report(NASTY, NASTY, tables=(Table("t", (NASTY,), ((NASTY,),), NASTY),), failed=(NASTY,), notes=(NASTY,))
    page = Page(html_page(report.markdown(), Path()))
    assert page.text.count(NASTY) == 9  # title twice, question, caption twice, head, cell, failure, note
    assert not {"a", "img", "em", "e"} & {tag for tag, _ in page.tags}


@hypothesis_settings(max_examples=60, deadline=None)
@given(st.text(st.sampled_from("ab _*`<>&[]()!|\\\n#"), max_size=20))
def test_a_cell_holds_any_text(text: str) -> None:
    report = Report("a", "b", tables=(Table("t", ("x",), ((f"z{text}z",),)),))
    page = Page(html_page(report.markdown(), Path()))
    assert f"\n{' '.join(f'z{text}z'.split())}\n" in page.text
    assert not {"a", "img", "em", "strong"} & {tag for tag, _ in page.tags}


def test_values_for_people() -> None:
    values = (None, True, False, 3, 0.5, 12345.6, 1 / 3, "x")
    assert [shown(value) for value in values] == ["–", "yes", "no", "3", "0.5", "12346", "0.3333", "x"]


def test_a_table_as_csv_comes_back() -> None:
    table = Table("t", ("a", "b"), (("x, y", None), ('"', 0.1), ("two\nlines", 3)))
    rows = list(csv.reader(StringIO(table.csv(), newline="")))
    assert rows == [["a", "b"], ["x, y", ""], ['"', "0.1"], ["two\nlines", "3"]]


def test_empty_parts_are_left_out_but_for_failures() -> None:
    assert Report("a", "b").markdown() == "# a\n\nb\n\n## What failed\n\n- Nothing.\n"
    hidden = Report("a", "b", tables=(Table("t", ("c",), ((1,),), "d", shown=False),)).markdown()
    assert "| c |" not in hidden
    assert "- `t.csv`: d" in hidden


def test_the_page_holds_its_pictures(tmp_path: Path) -> None:
    Figure().savefig(tmp_path / "one.png")
    (tmp_path / "one.svg").write_text("<svg/>")
    Figure().savefig(tmp_path / "two.png")
    figures = (("one.png", "first"), ("two.png", "second"), ("none.png", "third"))
    page = Page(html_page(Report("a", "b", figures=figures).markdown(), tmp_path))
    pictures = [attrs for tag, attrs in page.tags if tag == "img"]
    assert [attrs["alt"] for attrs in pictures] == ["first", "second", "third"]
    kinds, contents = zip(*[str(attrs["src"]).split(",") for attrs in pictures[:2]], strict=True)
    assert kinds == ("data:image/svg+xml;base64", "data:image/png;base64")
    assert b64decode(contents[0]) == b"<svg/>"
    assert b64decode(contents[1]) == (tmp_path / "two.png").read_bytes()
    assert pictures[2]["src"] == "none.png"


def needs_nothing_else(html: str) -> bool:
    """Whether a page loads nothing: no scripts, no files, no addresses."""
    page = Page(html)
    names = {tag for tag, _ in page.tags}
    sources = [value for _, attrs in page.tags for key, value in attrs.items() if key in ("src", "srcset", "href")]
    style = re.findall(r"url\(|@import", html)
    return (
        not names & {"script", "link", "iframe", "object"}
        and not style
        and all(str(source).startswith("data:image/") for source in sources)
    )


# -- out of the JSON of a study ----------------------------------------------------------------------------


def test_every_list_of_rows_is_a_table() -> None:
    report: dict[str, Any] = {
        "seed": 0,
        "settings": {"a": [{"no": 1}]},
        "summary": {"agents": 2, "part": {"b": 1}},
        "rows": [
            {"seed": 5, "at": [1, 2], "choice": {"route": 3}, "steps": [{"x": 1, "ways": [{"p": 0.5}]}, {"x": 2}]},
            {"seed": 6, "at": [0, 0], "choice": None, "steps": [], "more": True},
        ],
    }
    tables = {table.name: table for table in json_tables("s", report)}
    assert list(tables) == ["s", "s_steps", "s_steps_ways", "s_summary"]
    assert tables["s"].columns == ("seed", "at", "choice.route", "choice", "steps", "more")
    assert tables["s"].rows == ((5, "[1, 2]", 3, None, None, None), (6, "[0, 0]", None, None, "[]", True))
    assert tables["s_steps"].columns == ("seed", "step", "x")
    assert tables["s_steps"].rows == ((5, 0, 1), (5, 1, 2))
    assert tables["s_steps_ways"].rows == ((5, 0, 0, 0.5),)
    assert tables["s_summary"].rows == (("agents", 2), ("part.b", 1))
    assert [table.shown for table in tables.values()] == [True, False, False, True]
    parts = json_tables("s", {"summary": {"one": {"n": 1}, "two": {"n": 2, "m": 3}}})
    assert (parts[0].columns, parts[0].rows) == (("part", "n", "m"), (("one", 1, None), ("two", 2, 3)))
    assert flat({"a": {"b": [1]}, "c": [{"d": 1}]}) == {"a.b": "[1]"}


def test_failures_are_found_in_the_json() -> None:
    row = {"seed": 3, "steps_to_explore": 9, "reached": False}
    rows = [row, {**row, "seed": 4, "steps_to_explore": None}, {**row, "seed": 5, "reached": True}]
    assert failures("donut", {"rows": rows}) == (
        "1 of 3 did not explore the maze (seeds 4)",
        "1 of 3 did not reach the goal (seeds 3)",
    )
    assert failures("martinet", {"summary": {"reached": 8, "runs": 9}}) == ("goal reached in 8 of 9 runs",)
    assert failures("martinet", {"summary": {"reached": 9, "runs": 9}}) == ()
    block = {"goal_reached": {"count": 3, "of": 5}, "missed": {"lost": 2, "searching": 0}}
    assert failures("tolman", {"summary": {"A closed": block}}) == ("A closed: goal reached in 3 of 5 runs (2 lost)",)
    goal = {"world": "w", "known": True, "goal": 1, "seed": 2, "reached": False}
    assert failures("goals", {"runs": [goal]}) == ("w, with a map, goal 1, seed 2: not reached",)
    choices = [{"seed": 0, "choice": None, "steps_to_goal": 3}]
    assert failures("insight", {"rows": choices, "controls": []}) == ("1 of 1 agents never met the block (seeds 0)",)
    part = {"trials": 4, "localised": 4, "reached": 3, "map_intact": 4}
    localisation = {"rows": [], "summary": {"conditions": {"told": part}}}
    assert failures("localisation", localisation) == ("told: reached 3 of 4",)
    assert failures("other", {}) == ()


def test_every_study_says_what_it_asks() -> None:
    assert set(about.ABOUT) == set(STUDIES)
    assert all(text.asked.count("?") and text.notes for text in about.ABOUT.values())


def test_the_machine_is_named(tmp_path: Path) -> None:
    (tmp_path / "cpuinfo").write_text("processor : 0\nmodel name\t: A Fast One\n")
    assert processor(tmp_path / "cpuinfo") == "A Fast One"
    assert processor(tmp_path / "none")
    assert json.loads(json.dumps(machine())) == machine()
    assert {"cogmap", "numpy", "python", "platform"} <= set(versions())


# -- everything --------------------------------------------------------------------------------------------


class Found:
    def to_dict(self) -> dict[str, Any]:
        return {"rows": [{"seed": 1}]}


def fail(**_: object) -> Found:
    raise RuntimeError("out of\nluck")


def refuse(**_: object) -> Found:
    raise CogmapError("a worker was killed")


@pytest.fixture
def three(monkeypatch: pytest.MonkeyPatch) -> list[dict[str, Any]]:
    """Three studies of which two fail; what the other was given."""
    asked: list[dict[str, Any]] = []

    def good(**given: Any) -> Found:
        asked.append(given)
        return Found()

    studies = {"broken": fail, "fine": good, "killed": refuse}
    for name, study in studies.items():
        module, drawn = ModuleType(f"{frame.__package__}.{name}"), ModuleType(f"{frame.__package__}.{name}_figures")
        setattr(module, f"{name}_study", study)
        setattr(module, f"{name}_lines", lambda result: ["a line"])
        setattr(drawn, f"{name}_figures", lambda result: {"drawn": Figure()})
        monkeypatch.setitem(sys.modules, module.__name__, module)
        monkeypatch.setitem(sys.modules, drawn.__name__, drawn)
    monkeypatch.setattr(frame, "STUDIES", {name: Study(name, 3) for name in studies})
    return asked


@pytest.mark.usefixtures("empty_folder")
def test_a_study_that_fails_does_not_stop_the_others(three: list[dict[str, Any]]) -> None:
    result = cogmap("study", "all", "--runs", 2, "--seed", 4, "--out", "here")
    assert result.exit_code == 1
    assert [given["agents"] for given in three] == [2]
    assert [given["seed"] for given in three] == [4]
    assert "broken failed: RuntimeError: out of luck" in result.stdout
    assert {path.name for path in Path("here").iterdir()} == {"fine", "index.md", "index.html", "index.csv"}
    markdown = Path("here/index.md").read_text()
    assert "1 of 3 studies" in markdown
    assert "- broken: RuntimeError: out of luck" in markdown
    assert "- killed: CogmapError: a worker was killed" in markdown
    assert "(<fine/fine.md>)" in markdown
    assert "cogmap study all --runs 2 --seed 4" in markdown
    links = [attrs["href"] for tag, attrs in Page(Path("here/index.html").read_text()).tags if tag == "a"]
    assert links == ["fine/fine.html"]
    assert all(Path("here", str(link)).is_file() for link in links)
    assert needs_nothing_else(Path("here/fine/fine.html").read_text())
    assert "cogmap study fine --runs 2 --seed 4" in Path("here/fine/fine.md").read_text()


@pytest.mark.usefixtures("empty_folder")
def test_where_nothing_fails_the_exit_code_is_0(three: list[dict[str, Any]]) -> None:
    del frame.STUDIES["broken"], frame.STUDIES["killed"]
    result = cogmap("study", "all")
    assert result.exit_code == 0
    assert three[0]["agents"] == 3
    assert "written: study-all/index.html" in result.stdout
    markdown = Path("study-all/index.md").read_text()
    assert "- Nothing." in markdown
    assert "cogmap study all --seed 0\n" in markdown
