"""The study `exploration`: what is censored is marked, what was run is not run again."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cogmap.experiments import Cell, Row
from cogmap.experiments import cells as cells_module
from cogmap.experiments.studies import exploration, grid, rooms, saving
from cogmap.experiments.studies.exploration import exploration_lines, exploration_study, exploration_tables
from cogmap.experiments.studies.exploration_figures import exploration_figures
from cogmap.experiments.studies.exploration_rows import ExplorationResult
from cogmap.experiments.studies.grid import Grid
from cogmap.experiments.studies.published import AUTHORS_LEARN, PAPER_LEARN
from cogmap.experiments.studies.steps import MARK, Steps
from cogmap.model import CogmapError
from command_line import cogmap
from grids import CAP, cells
from hypothesis import given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st
from pages import Page

LINE_OF_ALL = "3x3, CSCG: 2 of 2 gave up after 30 moves (seeds 0, 1)"

# -- means of runs of which some gave up -------------------------------------------------------------------


def test_means_over_all_and_over_some_and_over_none() -> None:
    everyone = Steps.of([4, 6], 10)
    assert (everyone.mean, everyone.std, everyone.bound.value, everyone.censored) == (5.0, 1.0, 5.0, False)
    assert (everyone.mean_text(), everyone.count_text()) == ("5.0 ± 1.0", "2/2")
    some = Steps.of([4, None, 6, None], 10)
    assert (some.mean, some.std, some.got, some.runs) == (5.0, 1.0, 2, 4)
    assert some.bound.value == 7.5
    assert some.mean_text() == f"≥ 7.5{MARK} (5.0 ± 1.0 over 2 of 4)"
    nobody = Steps.of([None, None], 10)
    assert (nobody.mean, nobody.std, nobody.bound.value) == (None, None, 10.0)
    assert nobody.mean_text() == f"≥ 10.0{MARK} (0 of 2)"
    assert nobody.text() == f"≥ 10.0{MARK} (0 of 2) [10.0, 10.0]"


@hypothesis_settings(max_examples=30, deadline=None)
@given(st.lists(st.integers(1, 99), min_size=1, max_size=12), st.integers(1, 99))
def test_the_censored_mean_is_a_lower_bound(true: list[int], cap: int) -> None:
    steps = Steps.of([value if value <= cap else None for value in true], cap)
    assert steps.bound.value <= np.mean(true) + 1e-9
    assert steps.censored == (max(true) > cap)
    assert steps.bound.low <= steps.bound.value + 1e-9
    assert steps.bound.value <= steps.bound.high + 1e-9
    if not steps.censored:
        assert steps.bound.value == pytest.approx(steps.mean) == pytest.approx(np.mean(true))


# -- what the rows come to ---------------------------------------------------------------------------------


def test_the_ratio_is_of_the_best_and_marked_if_that_is_censored() -> None:
    found = ExplorationResult(cells({"cogmap": [8, 12], "cscg": [None, None], "cscg_pose": [20, None]}))
    (factor,) = found.factors
    assert (factor.best, factor.ratio and factor.ratio.value) == ("cscg_pose", 2.5)
    assert factor.paper == round(205.7 / 14.4, 1)
    assert exploration_lines(found)[-1].startswith(f"3x3: best CSCG (CSCG pose) over cogmap ≥ 2.5{MARK} [")
    assert found.failed() == (LINE_OF_ALL, "3x3, CSCG pose: 1 of 2 gave up after 30 moves (seed 1)")
    lost = ExplorationResult(cells({"cogmap": [8, None], "cscg": [20, 20]}))
    assert lost.factors[0].ratio is None  # neither a lower nor an upper bound
    assert ExplorationResult(cells({"cogmap": [8]})).factors == ()


def test_the_published_stand_beside_ours() -> None:
    found = ExplorationResult(cells({"cogmap": [8, 9], "cscg": [300, None]}, cap=400, world="3x3_alias"))
    compared = {row[1]: row[2:] for row in exploration_tables(found)[2].rows}
    assert compared["Oracle"] == ("8.0 ± 0.0", "8.0 to 8.0", "–", "11", "–")
    assert compared["cogmap"][0::2] == ("8.5 ± 0.5", "2/2", "19.1 ± 5.1 (20/20)")
    assert compared["cogmap"][3] == "18.1 ± 2"
    assert compared["CSCG"][0] == f"≥ 350.0{MARK} (300.0 ± 0.0 over 1 of 2)"
    assert compared["CSCG"][2:] == ("1/2", "376.3 ± 35", "360 (1/5)")
    saved = {row["agent"]: row for row in found.to_dict()["summary"]}
    assert (saved["cscg"]["paper_mean"], saved["cscg"]["authors_learned"], saved["cscg"]["authors_runs"]) == (
        376.3,
        1,
        5,
    )
    assert saved["oracle"]["authors_mean"] is None


def test_the_published_figures_cover_the_table() -> None:
    assert set(PAPER_LEARN) == set(AUTHORS_LEARN) == set(grid.TABLE) == set(exploration.GRID.worlds)
    assert all(set(row) == {"oracle", *grid.MODELS} for row in PAPER_LEARN.values())
    assert PAPER_LEARN["t_maze_alias"]["cscg_random"].mean == 602.0
    assert "cscg" not in AUTHORS_LEARN["4x4"]


def test_who_gave_up_is_drawn_hollow_with_an_arrow() -> None:
    found = ExplorationResult(cells({"cogmap": [8, 12], "cscg": [20, None]}))
    ax = exploration_figures(found)["exploration_steps"].axes[0]
    faces = {container.get_label(): container[0].get_markerfacecolor() for container in ax.containers}
    assert (faces["CSCG"], faces["cogmap"]) == ("white", "#0072b2")
    assert [text.get_text() for text in ax.texts] == ["", "1/2"]
    assert ax.get_yscale() == "log"
    assert any("cap of 30" in text.get_text() for text in ax.get_legend().get_texts())


# -- in a folder -------------------------------------------------------------------------------------------


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(grid, "CAP", CAP)
    monkeypatch.setattr(exploration, "GRID", Grid(("3x3",), ("cogmap", "cscg")))
    monkeypatch.setattr(rooms, "GRID", Grid(("3x3",), ("cogmap", "frontier", "cscg")))


@pytest.fixture
def walked(monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, int]]:
    """The cells that were run, not taken from the ledger."""
    monkeypatch.setattr(saving, "write_picture", lambda path, figure: None)  # which takes longer than the walk
    done: list[tuple[str, int]] = []
    run: Callable[..., Row] = cells_module.run_cell

    def noted(cell: Cell, **given: Any) -> Row:
        done.append((cell.agent, cell.seed))
        return run(cell, **given)

    monkeypatch.setattr(cells_module, "run_cell", noted)
    return done


def saved(folder: str, study: str = "exploration") -> dict[str, Any]:
    return json.loads(Path(folder, f"{study}.json").read_text())


@pytest.mark.usefixtures("small", "empty_folder")
def test_who_gave_up_is_in_every_file() -> None:
    result = cogmap("study", "exploration", "--runs", 2, "--out", "here")
    assert result.exit_code == 0
    assert f"CSCG             ≥ 30.0{MARK} (0 of 2)" in result.stdout
    names = {path.name for path in Path("here").iterdir()}
    tables = {f"exploration{part}.csv" for part in ("", "_table", "_compared", "_ratio", "_summary")}
    pages = {f"exploration.{suffix}" for suffix in ("json", "md", "html")}
    assert names == {*tables, *pages, "exploration_steps.png", "exploration_steps.svg", "cells.jsonl"}
    data = saved("here")
    assert [(row["agent"], row["seed"]) for row in data["rows"]] == [
        (agent, seed) for agent in ("cogmap", "cscg") for seed in (0, 1)
    ]
    assert [row["steps_to_learn"] is None for row in data["rows"]] == [False, False, True, True]
    assert data["protocol"]["max_steps"] == CAP
    assert data["protocol"]["cscg_settings"]["clones"] == 10
    with Path("here/exploration.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["steps_to_learn"] for row in rows[2:]] == ["", ""]
    assert [row["seed"] for row in rows] == ["0", "1", "0", "1"]
    markdown = Path("here/exploration.md").read_text()
    for part in (LINE_OF_ALL, f"≥ 30.0{MARK} (0 of 2)", "14.4 ± 2", "cogmap study exploration --runs 2 --seed 0"):
        assert part in markdown
    page = Page(Path("here/exploration.html").read_text())
    assert LINE_OF_ALL in page.text
    assert [attrs["src"].split(",")[0] for tag, attrs in page.tags if tag == "img"] == ["data:image/svg+xml;base64"]


@pytest.mark.usefixtures("small", "empty_folder")
def test_what_was_interrupted_goes_on(monkeypatch: pytest.MonkeyPatch, walked: list[tuple[str, int]]) -> None:
    noted = cells_module.run_cell

    def interrupted(cell: Cell, **given: Any) -> Row:
        if len(walked) == 3:
            raise KeyboardInterrupt
        return noted(cell, **given)

    monkeypatch.setattr(cells_module, "run_cell", interrupted)
    result = cogmap("study", "exploration", "--runs", 2, "--out", "here")
    assert result.exit_code == 130
    message = "cogmap: interrupted; the finished runs are kept in here/cells.jsonl; the same command goes on from there"
    assert result.stderr.strip() == message
    assert result.stdout == ""
    monkeypatch.setattr(cells_module, "run_cell", noted)
    assert cogmap("study", "exploration", "--runs", 2, "--out", "here").exit_code == 0
    assert walked == [("cogmap", 0), ("cogmap", 1), ("cscg", 0), ("cscg", 1)]
    assert cogmap("study", "exploration", "--runs", 2, "--out", "other").exit_code == 0
    again, fresh = saved("here"), saved("other")
    assert again["summary"] == fresh["summary"]
    for row in again["rows"] + fresh["rows"]:
        del row["seconds"]
    assert again["rows"] == fresh["rows"]


@pytest.mark.usefixtures("small", "empty_folder")
def test_studies_in_one_folder_share_their_cells(walked: list[tuple[str, int]]) -> None:
    assert cogmap("study", "exploration", "--runs", 1, "--out", "here").exit_code == 0
    assert cogmap("study", "rooms", "--runs", 2, "--out", "here").exit_code == 0
    assert sorted(walked) == [(agent, seed) for agent in ("cogmap", "cscg", "frontier") for seed in (0, 1)]
    assert len(saved("here", "rooms")["rows"]) == 6


@pytest.mark.usefixtures("small", "empty_folder")
@pytest.mark.parametrize(
    ("before", "arguments", "message"),
    [
        (None, ("--look-ahead", 3), "was made with settings.look_ahead = 6, this run has 3"),
        ('{"schema": "other"}\n', (), "give another file"),
        ("no JSON\n", (), "give another file"),
    ],
)
@pytest.mark.parametrize("study", ["exploration", "growth", "all"])
def test_a_ledger_of_something_else_is_refused_at_once(
    before: str | None,
    arguments: tuple[object, ...],
    message: str,
    study: str,
    walked: list[tuple[str, int]],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    if before is None:
        monkeypatch.setattr(exploration, "GRID", Grid(("3x3",), ("frontier",)))
        assert cogmap("study", "exploration", "--runs", 1, "--out", "here").exit_code == 0
    else:
        Path("here").mkdir()
        Path("here/cells.jsonl").write_text(before)
    kept, names = Path("here/cells.jsonl").read_text(), sorted(Path("here").iterdir())
    walked.clear()
    result = cogmap("study", study, "--runs", 1, "--out", "here", *arguments)
    assert (result.exit_code, result.stdout, result.stderr.count("\n")) == (2, "", 1)
    assert message in result.stderr
    assert walked == []
    assert Path("here/cells.jsonl").read_text() == kept
    assert sorted(Path("here").iterdir()) == names


@pytest.mark.parametrize(("numbers", "message"), [({"agents": 0}, "agents is 0"), ({"seed": -1}, "seed is -1")])
def test_bad_numbers_are_refused(numbers: dict[str, int], message: str) -> None:
    with pytest.raises(CogmapError, match=f"exploration: {message}"):
        exploration_study(**{"agents": 1, **numbers})
