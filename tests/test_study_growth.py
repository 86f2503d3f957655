"""The study `growth`: three ways to grow a map, side by side."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest
from cogmap.experiments import Parts, explore
from cogmap.experiments.studies import growth
from cogmap.experiments.studies.grid import CAP, Grid
from cogmap.experiments.studies.growth import GROWN, growth_study, growth_tables
from cogmap.experiments.studies.growth_figures import growth_figures
from cogmap.model import CogmapError
from cogmap.worlds import MAZES
from command_line import cogmap

SMALL = Grid(("3x3", "t_maze"), ("cogmap",), GROWN)


def test_every_maze_and_way_to_grow_takes_part() -> None:
    assert growth.GRID.worlds == tuple(MAZES)
    assert growth.growth_tasks(2) == 2 * 3 * len(MAZES)


def test_rows_are_those_of_explore() -> None:
    found = growth_study(agents=1, seed=4, grid=SMALL)
    for row in found.cells.rows:
        alone = explore(MAZES[row.world], agent=Parts(growth=row.growth), seed=4, max_steps=CAP)
        assert row.run.steps_to_complete == alone.steps_to_complete
    means = {row[0]: row[1:] for row in growth_tables(found)[1].rows}
    assert means["3x3"] == tuple(found.steps("3x3", name).text() for name in GROWN)


def test_who_gave_up_is_counted() -> None:
    found = growth_study(agents=2, grid=Grid(("3x3",), ("cogmap",), ("observed", "predicted")), max_steps=8)
    failed = {row["growth"]: row["runs"] - row["got_there"] for row in found.to_dict()["summary"]}
    alone = [explore(MAZES["3x3"], seed=seed, max_steps=8).steps_to_complete for seed in (0, 1)]
    assert failed["predicted"] == alone.count(None)
    assert failed["observed"] == 2
    assert found.failed()[0] == "3x3, cogmap (observed): 2 of 2 gave up after 8 moves (seeds 0, 1)"
    names = [container.get_label() for container in growth_figures(found)["growth_steps"].axes[0].containers]
    assert [name for name in names if name != "_"] == ["Oracle", "observed", "predicted"]


def test_in_a_folder(monkeypatch: pytest.MonkeyPatch, empty_folder: None) -> None:
    monkeypatch.setattr(growth, "GRID", SMALL)
    result = cogmap("study", "growth", "--runs", 1)
    assert result.exit_code == 0
    assert "steps to complete" in result.stdout
    names = {path.name for path in Path("study-growth").iterdir()}
    assert {"cells.jsonl", "growth.json", "growth.csv", "growth_table.csv", "growth_summary.csv"} < names
    assert {"growth.md", "growth.html", "growth_steps.png", "growth_steps.svg"} < names
    data = json.loads(Path("study-growth/growth.json").read_text())
    assert [row["growth"] for row in data["rows"]] == list(GROWN) * 2
    with Path("study-growth/growth_summary.csv").open(newline="") as file:
        summary = list(csv.DictReader(file))
    assert [float(row["mean"]) for row in summary] == [row["steps_to_complete"] for row in data["rows"]]


def test_bad_numbers_are_refused() -> None:
    with pytest.raises(CogmapError, match="growth: agents is 0"):
        growth_study(agents=0)
