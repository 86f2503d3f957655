from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

BENCHMARKS = Path(__file__).parent.parent / "benchmarks"


def measured(name: str, tmp_path: Path, *arguments: str) -> tuple[str, dict[str, Any]]:
    file = tmp_path / "out.json"
    command = [sys.executable, str(BENCHMARKS / name), *arguments, "--json", str(file)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    return done.stdout, json.loads(file.read_text())


def test_step_time(tmp_path: Path) -> None:
    asked = ("3x3", "--steps", "3", "--runs", "2", "--look-ahead", "2", "--policies", "map_guided", "l_shaped")
    printed, result = measured("step_time.py", tmp_path, *asked)
    assert (result["world"], result["steps"], result["look_ahead"]) == ("3x3", 3, 2)
    assert set(result["policies"]) == {"map_guided", "l_shaped"}
    for name, row in result["policies"].items():
        assert name in printed
        assert 0.0 < row["min"] <= row["median"]
        assert len(row["runs"]) == 2
        assert row["first"] == row["runs"][0]
        assert 10.0 < row["peak_megabytes"] < 2000.0
    assert 0.0 < result["import_seconds"] < 30.0
    assert result["machine"]["cores"] >= 1
    assert result["machine"]["python"] == sys.version.split()[0]


def test_inference_engines_agree(tmp_path: Path) -> None:
    _, result = measured("inference.py", tmp_path, "--windows", "1", "3", "--supports", "2", "7", "--runs", "1")
    assert [(row["window"], row["support"]) for row in result["rows"]] == [(1, 2), (1, 7), (3, 2), (3, 7)]
    for row in result["rows"]:
        assert min(row["numpy"], row["gtsam"]) > 0.0
        assert row["difference"] <= 1e-9


def test_ablations(tmp_path: Path) -> None:
    _, result = measured("ablations.py", tmp_path, "commit", "rates", "--mazes", "3x3", "corridor1", "--runs", "1")
    rows = [(row["ablation"], row["maze"], row["variant"]) for row in result["rows"]]
    assert rows[:4] == [
        ("commit", "3x3", "committed"),
        ("commit", "3x3", "kept apart"),
        ("commit", "corridor1", "committed"),
        ("commit", "corridor1", "kept apart"),
    ]
    assert [variant for _, _, variant in rows[4:]] == ["table", "text"] * 2
    assert all(row["runs"] == 1 and row["completed"] == 1 for row in result["rows"])


@pytest.mark.parametrize(
    ("measure", "maze", "variants"),
    [("kidnap", "random12_4", 1), ("doors", "random12_4", 2), ("exploring", "3x3", 3), ("search", "3x3", 2)],
)
def test_moves(measure: str, maze: str, variants: int, tmp_path: Path) -> None:
    printed, result = measured("moves.py", tmp_path, measure, "--mazes", maze, "--runs", "1")
    assert [row["maze"] for row in result["rows"]] == [maze] * variants
    assert maze in printed
    for row in result["rows"]:
        assert all(row[count] in (0, 1) for count in ("recovered", "intact", "right") if count in row)
    if measure == "search":
        assert result["rows"][0]["labels"] == result["rows"][0]["rooms"]  # each room of 3x3 has its own
        assert 4.0 <= result["rows"][0]["rooms"] < 6.0


def test_unknown_names_are_refused(tmp_path: Path) -> None:
    for arguments in (["discounts"], ["rates", "--mazes", "5x5"]):
        command = [sys.executable, str(BENCHMARKS / "ablations.py"), *arguments]
        done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
        assert done.returncode == 2
        assert arguments[-1] in done.stderr


@pytest.mark.parametrize("name", ["step_time.py", "inference.py", "ablations.py", "moves.py"])
def test_bad_arguments_are_refused(name: str) -> None:
    done = subprocess.run([sys.executable, str(BENCHMARKS / name), "--runs", "many"], capture_output=True, check=False)
    assert done.returncode == 2
