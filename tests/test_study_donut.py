"""The study `donut`: there, back and round."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from cogmap.experiments.studies import run_study, study_named
from cogmap.worlds import MAZES

MAZE = MAZES["donut"]
CORNER, CLOSED, GOAL = (0, 0), (0, 2), (2, 4)
DONUT = study_named("donut")


@pytest.fixture(scope="module")
def rows() -> list[Any]:
    return DONUT.rows(2)


def walked(row: Any, *walk: tuple[tuple[int, int], str]) -> Any:
    """The row of an agent that was in these rooms and chose these actions."""
    steps = [replace(row.steps[0], room=room, action=action) for room, action in walk]
    return type(row).of(row.seed, row.start, 9, steps)


def test_there_and_back_and_round(rows: list[Any]) -> None:
    for row in rows:
        assert list(row.path[:3]) == [CORNER, (0, 1), CORNER]
        assert row.path[-1] == GOAL
        assert CLOSED not in row.path
        assert (row.reached, row.moves, row.second_tries, row.bumps, row.met_closed_room) == (True, 10, 0, 0, True)
        assert row.steps[-1].action == "stay"


def test_an_agent_whose_map_lacks_the_room_is_counted_too() -> None:
    (row,) = DONUT.rows(1, seed=9)
    assert row.met_closed_room
    assert all(0.0 <= p <= 1.0 for step in row.steps for p in step.way_open.values())


def test_the_door_is_believed_closed_once_it_was_met(rows: list[Any]) -> None:
    for row in rows:
        left = [step.way_open["from the left"] for step in row.steps]
        assert left[0] > 0.99
        assert max(left[1:]) < 0.01
        assert row.steps[1].way_open["from the right"] > 0.99  # it never was there


def test_it_first_imagines_the_short_way_then_the_long_one(rows: list[Any]) -> None:
    steps = rows[0].steps
    assert CLOSED in steps[0].paths[0].rooms
    assert all(CLOSED not in path.rooms for step in steps[1:] for path in step.paths)
    for step in steps:
        assert all(set(path.rooms) <= set(MAZE.rooms) for path in step.paths)
        assert sum(path.probability for path in step.paths) == pytest.approx(1.0, abs=0.05)
        shares = [path.probability for path in step.paths]
        assert shares == sorted(shares, reverse=True)


def test_second_tries_are_counted(rows: list[Any]) -> None:
    again = walked(rows[0], (CORNER, "right"), ((0, 1), "left"), (CORNER, "right"), ((0, 1), "right"), (GOAL, "stay"))
    assert (again.second_tries, again.bumps, again.moves) == (2, 1, 4)
    around = walked(rows[0], (CORNER, "down"), ((1, 0), "stay"))
    assert (around.second_tries, around.met_closed_room, around.reached, around.moves) == (0, False, False, None)
    assert walked(rows[0], ((0, 3), "left")).bumps == 1


def test_what_is_left(tmp_path: Path) -> None:
    lines = run_study(DONUT, tmp_path, runs=2).lines
    assert lines[0].startswith("2 of 2 agents explored donut; moved to (0, 0), sight 12 preferred")
    assert lines[1] == "met the closed room 2/2, reached the goal 2/2, in 10.0 moves (mean)"
    assert lines[2] == "in exactly 10 moves (there, back, and round) 2/2"
    report = json.loads((tmp_path / "donut.json").read_text())
    assert report["summary"] == {
        "agents": 2,
        "explored": 2,
        "met_closed_room": 2,
        "reached": 2,
        "detour": 10,
        "in_detour": 2,
        "mean_moves": 10.0,
        "second_tries": 0,
        "bumps": 0,
    }
    assert report["rows"][1]["path"][-1] == list(GOAL)


def test_who_failed_is_named_and_who_has_not_explored_is_not_drawn(rows: list[Any]) -> None:
    lost, stuck = type(rows[0]).of(3, CORNER, None, []), walked(replace(rows[0], seed=4), (CORNER, "stay"))
    found = DONUT.summarise([lost, stuck])
    assert found.failed == [
        "1 of 2 did not explore the maze (seeds 3)",
        "1 of 2 did not reach the goal (seeds 4)",
    ]
    assert "reached the goal 0/2, in - moves" in found.lines[1]
    assert DONUT.summarise([lost]).figures == {}


@pytest.mark.parametrize("steps", [11, 41])
def test_frames_are_spread_over_the_way_and_nothing_is_cut(rows: list[Any], steps: int) -> None:
    figure = DONUT.summarise([walked(rows[0], *[(CORNER, "stay")] * steps)]).figures["donut_frames"]()
    figure.draw_without_rendering()
    titles = [ax.get_title() for ax in figure.axes if ")" in ax.get_title().split(",")[0]]
    assert len([title for title in titles if title[0].isdigit()]) == 11
    assert any(title.startswith(f"{steps}) stay") for title in titles)
    box = figure.get_tightbbox()
    assert box.x0 >= 0.0
    assert box.x1 <= figure.get_figwidth()
