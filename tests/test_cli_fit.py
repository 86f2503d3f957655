from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from cogmap.behaviour import MODELS, Ground, simulate
from cogmap.worlds import load_world
from command_line import cogmap


@pytest.fixture
def walks(tmp_path: Path) -> Path:
    ground = Ground.of(load_world("4x4").chart, home=(0, 0))
    folder = tmp_path / "walks"
    folder.mkdir()
    for seed, name in enumerate(("ann", "bob")):
        route = simulate(MODELS["habit"], ground, steps=80, parameters={"habit right": 1.5}, seed=seed, name=name)
        bouts = [
            [ground.places[at] for at in route.places[route.bout == b].tolist()] for b in range(max(route.bout) + 1)
        ]
        (folder / f"{name}.json").write_text(json.dumps({"individual": name, "bouts": bouts}), "utf-8")
    return folder


def fitted(*arguments: object, file: Path) -> dict[str, Any]:
    result = cogmap("fit", *arguments, "--json", file)
    assert result.exit_code == 0, result.stderr
    return json.loads(file.read_text("utf-8"))


def test_models_are_fitted_compared_and_written(walks: Path, tmp_path: Path) -> None:
    words = [walks, "--world", "4x4", "--home", "0,0", "--folds", 2, "--starts", 1, "--look-ahead", 2]
    names = ["uniform", "habit", "cogmap"]
    out = ["--out", tmp_path / "kept", *(word for name in names for word in ("--model", name))]
    found = fitted(*words, *out, file=tmp_path / "fit.json")
    assert [row["name"] for row in found["models"]] == names
    for row in found["models"]:
        assert set(row["parameters"]) == {parameter.name for parameter in MODELS[row["name"]].parameters}
        assert row["log_likelihood"] < 0.0 < row["held_out_nats_per_choice"]
        assert row["bic"] > -2.0 * row["log_likelihood"] - 1e-9
    assert [one["individual"] for one in found["individuals"]] == ["ann", "bob"]
    for one in found["individuals"]:
        assert one["map"]["steps_astray"] == 0
        assert one["map"]["places"] == one["map"]["nodes_entered"]
        assert [row["name"] for row in one["models"]] == names
    held = [
        sum(one["models"][i]["held_out_nats_per_choice"] * one["choices"] for one in found["individuals"])
        for i in (0, 1)
    ]
    assert [row["held_out_nats_per_choice"] * row["choices"] for row in found["models"][:2]] == pytest.approx(held)
    ledger = (tmp_path / "kept" / "fits.jsonl").read_text("utf-8")
    again = fitted(*words, *out, file=tmp_path / "again.json")
    assert again == found
    assert (tmp_path / "kept" / "fits.jsonl").read_text("utf-8") == ledger
    other = cogmap("fit", *words, *out, "--seed", 1)
    assert (other.exit_code, other.stderr.count("\n")) == (2, 1)


def test_a_trace_is_a_walk(tmp_path: Path) -> None:
    trace = tmp_path / "walk.json.gz"
    assert cogmap("explore", "4x4", "--trace", trace, "--out", tmp_path / "w.png").exit_code == 0
    found = fitted(trace, "--world", "4x4", "--model", "habit", "--folds", 2, file=tmp_path / "fit.json")
    assert [one["individual"] for one in found["individuals"]] == ["walk"]
    assert found["models"][0]["choices"] > 5


@pytest.mark.parametrize(
    ("bouts", "options", "says"),
    [
        ([[[0, 0], [2, 2]]], [], "bout 1, step 2: no way"),
        ([[[0, 0], [9, 9]]], [], "has no node"),
        ([[]], [], "is empty"),
        ([[[0, 0], [0, 1]]], ["--model", "hope"], "no model is called 'hope'"),
        ([[[0, 0], [0, 1]]], ["--until", "7,7"], "until"),
        ([[[0, 0], [0, 1]]], ["--level", "herd"], "--level is 'herd'"),
        ([[[0, 0], [0, 1]]], ["--home", "nowhere"], "home"),
        ([[[0, 0]]], ["--model", "uniform"], "is left"),
    ],
)
def test_bad_input(tmp_path: Path, bouts: Any, options: list[str], says: str) -> None:
    (tmp_path / "w.json").write_text(json.dumps({"bouts": bouts}), "utf-8")
    result = cogmap("fit", tmp_path / "w.json", "--world", "4x4", *options)
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1
    assert says in result.stderr
