from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
from cogmap.agent import Agent
from cogmap.experiments.studies import frame, saving
from cogmap.experiments.studies.donut import SETTINGS
from command_line import cogmap

pytestmark = pytest.mark.usefixtures("empty_folder")


def test_a_study_leaves_its_rows_and_figures() -> None:
    result = cogmap("study", "donut", "--runs", 1, "--seed", 3)
    assert result.exit_code == 0
    suffixes = ("json", "csv", "md", "html")
    names = [f"donut.{suffix}" for suffix in suffixes] + ["donut_frames.png", "donut_frames.svg", "donut_steps.csv"]
    for part in ("1 of 1 agents explored donut", *(f"written: study-donut/{name}" for name in names)):
        assert part in result.stdout
    assert set(os.listdir("study-donut")) == {*names, "donut_steps_paths.csv", "donut_summary.csv"}
    saved = json.loads(Path("study-donut/donut.json").read_text())
    assert (saved["study"], saved["agents"], saved["seed"]) == ("donut", 1, 3)
    assert saved["settings"] == json.loads(json.dumps(SETTINGS.to_dict()))
    assert [row["seed"] for row in saved["rows"]] == [3]


def test_agents_is_another_name_of_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(saving, "write_picture", lambda path, figure: None)
    result = cogmap("study", "localisation", "--agents", 2, "--look-ahead", 5, "--out", "here/there")
    assert result.exit_code == 0
    saved = json.loads(Path("here/there/localisation.json").read_text())
    assert (saved["agents"], len(saved["rows"]), saved["settings"]["look_ahead"]) == (2, 2, 5)
    assert "told, sights alone (the paper):" in result.stdout


def test_the_help_names_every_study() -> None:
    shown = " ".join(cogmap("study", "--help").stdout.split())
    assert all(name in shown for name in frame.STUDIES)


@pytest.mark.parametrize("name", frame.STUDIES)
def test_every_study_is_there(name: str) -> None:
    assert frame.STUDIES[name].settings(7).look_ahead == 7


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "Missing argument"),
        (["nothing"], "no study is called 'nothing'; choose one of exploration"),
        (["donut", "--runs", "0"], "--runs"),
        (["donut", "--agents", "-1"], "--agents"),
        (["donut", "--agents", "many"], "--agents"),
        (["donut", "--seed", "-1"], "--seed"),
        (["donut", "--jobs", "0"], "--jobs"),
        (["growth", "--jobs", "2", "--dask", "localhost:1"], "give one of them"),
        (["all", "--out", "file"], "cannot make folder file"),
        (["all", "--look-ahead", "0"], "--look-ahead"),
        (["donut", "--look-ahead", "0"], "--look-ahead"),
        (["donut", "--out", "file"], "cannot make folder file"),
        (["donut", "--out", "file/below"], "is a file"),
        (["donut", "--out", "n" * 300], "cannot make folder n"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(
    arguments: list[str], message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Agent, "step", lambda *_: pytest.fail("it walked"))
    Path("file").write_text("")
    result = cogmap("study", *arguments)
    assert result.exit_code == 2
    assert message in result.stderr
    assert result.stderr.startswith("cogmap: ")
    assert result.stderr.count("\n") == 1
    assert result.stdout == ""
    assert os.listdir() == ["file"]
