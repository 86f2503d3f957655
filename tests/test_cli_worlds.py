from __future__ import annotations

import json
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path
from time import sleep

import pytest
from cogmap.experiments.cli import app, progress
from cogmap.worlds import MAZES
from typer.testing import CliRunner


def test_worlds_are_listed(tmp_path: Path) -> None:
    result = CliRunner().invoke(app, ["worlds", "--json", str(tmp_path / "w.json")])
    assert result.exit_code == 0
    rows = {row["world"]: row for row in json.loads((tmp_path / "w.json").read_text())}
    assert list(rows) == list(MAZES)
    assert rows["3x3"] == {
        "world": "3x3",
        "rooms": 9,
        "sights": 9,
        "aliased": False,
        "mean_oracle_steps": pytest.approx(76 / 9),
    }
    assert rows["4x4_alias"]["aliased"]
    assert all(name in result.stdout for name in MAZES)


def test_version_and_help() -> None:
    assert CliRunner().invoke(app, ["--version"]).stdout == f"cogmap {version('cogmap')}\n"
    bare = CliRunner().invoke(app, [])
    assert bare.exit_code == 0
    assert "explore" in bare.stdout


@pytest.mark.parametrize(
    "arguments",
    [
        ["frob"],
        ["--frob"],
        ["worlds", "x"],
        ["worlds", "--json", "/no/w.json"],
        ["explore", "4x4", "--told", "lengths"],  # mazes tell what moves do
    ],
)
def test_bad_input(arguments: list[str]) -> None:
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1


def test_help_does_not_wait_for_the_agent() -> None:
    code = (
        "import sys, cogmap.experiments.cli\n"
        "print([name for name in ('numpy', 'gymnasium', 'gtsam', 'matplotlib') if name in sys.modules])"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout == "[]\n"


def test_the_bar_comes_late_and_goes(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setattr(progress, "PATIENCE", 3600.0)
    with progress.progress("walking", 3) as report:
        report(1)
    assert "walking" not in capsys.readouterr().err
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    shown, out = "", ""
    with progress.progress("walking", 3) as report:
        report(2)
        while "walking" not in shown:  # however busy the machine is
            sleep(0.01)
            captured = capsys.readouterr()
            shown, out = shown + captured.err, out + captured.out
    assert out == ""
