from __future__ import annotations

import ast
import json
import os
import re
import runpy
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

FOLDER = Path(__file__).parent.parent / "examples"
SCRIPTS = sorted(FOLDER.glob("*.py"))
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
LECTURE = FOLDER / "lecture.ipynb"
SAYS = {
    "body_in_minigrid": ("low-level steps: floor", "all 9 rooms in", "9 places, 9 visited"),
    "inspect_factor_graph": ("M(moved19)", "{0: 0.5, 1: 0.5}", "less log evidence"),
    "kidnap_and_recover": ("P(moved) 1.000", "not certain", "still 16 places"),
    "own_factor_graph": ("evidence lower bound", "P(today | the day before)", "fever"),
    "own_gymnasium": ("step 0: in room 3, sees lab", "6 places, 6 visited", "free energy"),
    "own_loop": ("16 visited", "certain: True", "at step 25", "it would go"),
    "own_maze": ("half way", "15 visited", "15 steps; the shortest walk through all rooms has 15"),
    "quickstart": ("16 visited", "sight_information", "free energy"),
    "watch_it_grow": ("seen up of place 0", "'place': 9"),
}
DRAWS = {
    "own_loop": {"robot.npz"},
    "own_maze": {"house.png"},
    "quickstart": {"map.npz"},
    "watch_it_grow": {"growth.gif", "growth.png"},
}


def run(script: Path, folder: Path) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "MPLBACKEND": "Agg"}
    return subprocess.run(
        [sys.executable, "-W", "error::DeprecationWarning:__main__", str(script)],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        timeout=300,
    )


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_it_runs_says_what_it_should_and_draws(script: Path, tmp_path: Path) -> None:
    done = run(script, tmp_path)
    assert done.returncode == 0, done.stderr
    assert not done.stderr
    for words in SAYS[script.stem]:
        assert words in done.stdout
    assert {path.name for path in tmp_path.iterdir()} == DRAWS.get(script.stem, set())
    assert all(path.stat().st_size > 1000 for path in tmp_path.iterdir())


def test_what_is_learned_of_the_patient_explains_the_reports_better(tmp_path: Path) -> None:
    printed = run(FOLDER / "own_factor_graph.py", tmp_path).stdout
    evidence = [float(value) for value in re.findall(r"evidence lower bound (-[\d.]+)", printed)]
    assert len(evidence) == 6
    assert evidence == sorted(evidence)
    ill = [line.split()[0] for line in printed.splitlines() if line.endswith(" ill")]
    assert ill == ["4", "5", "6", "7", "8"]


def test_engines_agree_about_the_agent(tmp_path: Path) -> None:
    printed = run(FOLDER / "inspect_factor_graph.py", tmp_path).stdout
    answers = re.findall(r"^  (?:numpy|gtsam)  (.*)$", printed, re.M)
    assert len(answers) == 2
    assert len(set(answers)) == 1


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_it_is_short_and_says_what_one_learns(script: Path) -> None:
    code = script.read_text("utf-8")
    docstring = ast.get_docstring(ast.parse(code)) or ""
    assert len(docstring.splitlines()) >= 3
    assert len(code.splitlines()) <= 60


def test_every_script_is_in_the_list() -> None:
    listed = re.findall(r"\((\w+\.(?:py|ipynb))\)", (FOLDER / "README.md").read_text("utf-8"))
    assert sorted(listed) == sorted([*(file.name for file in (*SCRIPTS, *NOTEBOOKS))])
    assert set(SAYS) == {script.stem for script in SCRIPTS}


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda notebook: notebook.stem)
def test_notebooks_are_whole_and_keep_no_output(notebook: Path) -> None:
    content = json.loads(notebook.read_text("utf-8"))
    assert (content["nbformat"], len({cell["id"] for cell in content["cells"]})) == (4, len(content["cells"]))
    assert not any(cell.get("outputs") for cell in content["cells"])  # they are made anew by the build, and not kept
    assert "".join(content["cells"][0]["source"]).startswith("# ")
    for cell in content["cells"]:
        if cell["cell_type"] == "code":
            ast.parse("".join(cell["source"]))


@pytest.fixture
def notebooks(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """What the build of the documents does with notebooks."""
    pytest.importorskip("mkdocs")
    hooks = FOLDER.parent / "docs" / "hooks"
    monkeypatch.syspath_prepend(str(hooks))
    return runpy.run_path(str(hooks / "notebooks.py"))


def test_the_tutorial_and_a_world_of_your_own_run(notebooks: dict[str, Any]) -> None:
    tutorial, own = (notebooks["run_notebook"](FOLDER / f"{name}.ipynb") for name in ("tutorial", "own_world"))
    printed = [cell.printed for cell in tutorial]
    assert any("sees 5" in text for text in printed)
    assert any("is at (0, 0)" in text for text in printed)
    assert "6 places, map right: True" in "".join(cell.printed for cell in own)
    assert sum("<svg" in cell.shown for cell in (*tutorial, *own)) >= 6
    assert any(cell.shown.startswith("<iframe") for cell in own)


def test_the_lecture_runs_and_shows_maps_plans_and_beliefs(notebooks: dict[str, Any]) -> None:
    cells = notebooks["run_notebook"](LECTURE)
    shown = [cell.shown for cell in cells if cell.shown]
    assert len(shown) >= 6
    assert sum("<svg" in part for part in shown) >= 3
    split, mended = (cell.shown for cell in cells if "dim.belief" in cell.source)
    assert split.count("0.5") == 2
    assert mended.count("<tr>") == 2  # one place, under its heading
    assert any(cell.figure.startswith(b"\x89PNG") for cell in cells)


def test_a_notebook_that_fails_ends_the_build(tmp_path: Path, notebooks: dict[str, Any]) -> None:
    errors = pytest.importorskip("mkdocs.exceptions")
    bad = tmp_path / "bad.ipynb"
    bad.write_text(json.dumps({"cells": [{"cell_type": "code", "source": ["x = 1\n", "x / 0"]}]}))
    with pytest.raises(errors.PluginError, match=r"bad\.ipynb: a cell fails"):
        notebooks["notebook_page"](bad)
