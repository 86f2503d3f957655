"""The study `rooms`: until every room was entered once, and the paper's claim about it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from cogmap.experiments import explore
from cogmap.experiments.studies import grid, rooms
from cogmap.experiments.studies.grid import Grid
from cogmap.experiments.studies.grid_rows import VISIT
from cogmap.experiments.studies.rooms import rooms_lines, rooms_study, rooms_tables
from cogmap.experiments.studies.rooms_figures import rooms_figures
from cogmap.experiments.studies.rooms_rows import RoomsResult
from cogmap.experiments.studies.steps import MARK
from cogmap.model import CogmapError
from cogmap.worlds import MAZES
from command_line import cogmap
from grids import cells

SMALL = Grid(("3x3", "t_maze"), ("cogmap", "frontier", "random"))


def test_rows_are_those_of_explore() -> None:
    found = rooms_study(agents=2, seed=3, grid=SMALL, max_steps=200)
    for row in found.cells.rows:
        alone = explore(MAZES[row.world], agent=row.agent, seed=row.run.seed, max_steps=200)
        assert row.run.steps_to_visit_all == alone.steps_to_visit_all
        assert row.run.start == alone.start
    oracle = [row.run.oracle_steps for row in found.cells.rows if row.world == "t_maze" and row.agent == "random"]
    assert list(found.cells.steps(VISIT, "t_maze", "oracle").values) == oracle
    assert (
        found.cells.steps(VISIT, "3x3", "cogmap").bound.value <= found.cells.steps(VISIT, "3x3", "random").bound.value
    )


def test_a_random_walk_that_gave_up_is_counted(monkeypatch: pytest.MonkeyPatch, empty_folder: None) -> None:
    monkeypatch.setattr(grid, "CAP", 13)
    monkeypatch.setattr(rooms, "GRID", SMALL)
    result = cogmap("study", "rooms", "--runs", 2, "--out", "here")
    assert result.exit_code == 0
    data = json.loads(Path("here/rooms.json").read_text())
    lost = [row for row in data["rows"] if row["steps_to_visit_all"] is None]
    assert {row["agent"] for row in lost} == {"random"}
    summary = {(row["world"], row["agent"]): row for row in data["summary"]}
    assert len(data["rows"]) == 12
    assert sum(row["runs"] - row["got_there"] for row in summary.values()) == len(lost)
    assert summary["t_maze", "random"]["bound"] == 13.0
    assert summary["t_maze", "random"]["mean"] is None
    markdown = Path("here/rooms.md").read_text()
    assert "t_maze, random: 2 of 2 gave up after 13 moves (seeds 0, 1)" in markdown
    assert f"≥ 13.0{MARK} (0 of 2) [13.0, 13.0]" in markdown
    assert "at least 30 % faster than CSCG" in markdown
    assert Path("here/rooms_steps.png").stat().st_size


def test_the_claim_is_of_the_best_and_holds_at_the_lower_end() -> None:
    found = RoomsResult(cells({"cogmap": [10, 10], "cscg": [100, None], "cscg_random": [20, 20]}, cap=200))
    (part,) = found.faster
    assert (part.best, part.holds) == ("cscg_random", True)
    assert part.share is not None
    assert (part.share.value, part.share.low, part.share.high) == (0.5, 0.5, 0.5)
    assert rooms_lines(found)[-2] == "3x3: 50% [50%, 50%] fewer steps than the best CSCG (CSCG random)"
    (claim,) = rooms_tables(found)[2].rows
    assert claim[-1] is True
    near = RoomsResult(cells({"cogmap": [10, 10], "cscg": [12, 20]}))
    assert near.faster[0].share is not None
    assert near.faster[0].share.value > 0.3
    assert not near.faster[0].holds  # one of the runs alone is only 17 % faster
    bound = RoomsResult(cells({"cogmap": [10, 10], "cscg": [None, None]}, cap=40))
    assert rooms_tables(bound)[2].rows[0][-2:] == (f"≥ 75%{MARK} [75%, 75%]", True)
    lost = RoomsResult(cells({"cogmap": [10, None], "cscg": [12, 20]}))
    assert rooms_tables(lost)[2].rows[0][-2:] == ("–", False)


def test_every_model_of_the_grid_is_in_the_figure() -> None:
    steps: dict[str, list[int | None]] = {agent: [10, 20] for agent in rooms.GRID.agents}
    figure = rooms_figures(RoomsResult(cells(steps)))["rooms_steps"]
    names = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert names[:8] == [
        "Oracle",
        "cogmap",
        "frontier",
        "random",
        "CSCG",
        "CSCG pose",
        "CSCG random",
        "CSCG pose random",
    ]


def test_bad_numbers_are_refused() -> None:
    with pytest.raises(CogmapError, match="rooms: agents is 0"):
        rooms_study(agents=0)
    with pytest.raises(CogmapError, match="max_steps is 0"):
        rooms_study(agents=1, grid=SMALL, max_steps=0)
