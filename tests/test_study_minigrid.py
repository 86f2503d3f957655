"""The study of bodies in MiniGrid, small."""

from __future__ import annotations

import json
from pathlib import Path

from cogmap.experiments.studies import run_study
from cogmap.experiments.studies.minigrid import Bodies

CASES = ("3x3", "GoToObjMaze", "time")


def test_every_case_is_run_and_told(tmp_path: Path) -> None:
    outcome = run_study(Bodies(cases=CASES), tmp_path, runs=1)
    assert not outcome.failure
    told = json.loads((tmp_path / "minigrid.json").read_text())
    assert [row["case"] for row in told["summary"]] == list(CASES)
    assert [row["case"] for row in told["runs"]] == list(CASES)
    assert [row["done"] for row in told["summary"][:-1]] == [1, 1]
    assert [row["authors"] for row in told["summary"]] == [0.93, None, None]
    assert 0.5 < told["summary"][1]["over BabyAI's bot"] < 2.0
    assert told["runs"][2]["ms_low"] > 0.0
    assert 1.0 <= told["summary"][0]["over the fewest"] < 1.6
    assert (tmp_path / "minigrid_shares.png").stat().st_size > 5_000
