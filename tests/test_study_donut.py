from __future__ import annotations

import json

import pytest
from cogmap.experiments import workers
from cogmap.experiments.studies.donut import DonutResult, detour, donut_lines, donut_study
from cogmap.experiments.studies.donut_figures import FRAMES, donut_figures
from cogmap.experiments.studies.donut_rows import CLOSED, CORNER, DOORS, GOAL_ROOM, MAZE, DonutRow, DonutStep
from cogmap.model import CogmapError


@pytest.fixture(scope="module")
def result() -> DonutResult:
    return donut_study(agents=2)


def row(*walk: tuple[tuple[int, int], str], reached: bool = True) -> DonutRow:
    """A row made by hand, of rooms and actions."""
    steps = [DonutStep(room, action, 1.0, {action: 1.0}, (), dict.fromkeys(DOORS, 0.5)) for room, action in walk]
    return DonutRow(0, CORNER, 9, tuple(steps), reached)


def test_there_and_back_and_round(result: DonutResult) -> None:
    assert detour() == 10
    for agent in result.rows:
        assert agent.path[:3] == [CORNER, (0, 1), CORNER]
        assert agent.path[-1] == GOAL_ROOM
        assert CLOSED not in agent.path
        assert (agent.moves, agent.second_tries, agent.bumps, agent.met) == (10, 0, 0, True)
        assert agent.steps[-1].action == "stay"


def test_the_door_is_believed_closed_once_it_was_met(result: DonutResult) -> None:
    for agent in result.rows:
        left = [step.way_open["from the left"] for step in agent.steps]
        assert left[0] > 0.99
        assert max(left[1:]) < 0.01
        assert agent.steps[1].way_open["from the right"] > 0.99  # it never was there


def test_it_first_imagines_the_short_way_then_the_long_one(result: DonutResult) -> None:
    steps = result.rows[0].steps
    assert CLOSED in steps[0].paths[0].rooms
    assert all(CLOSED not in path.rooms for step in steps[1:] for path in step.paths)
    assert all(set(path.rooms) <= set(MAZE.rooms) for step in steps for path in step.paths)


def test_second_tries_are_counted() -> None:
    again = row((CORNER, "right"), ((0, 1), "left"), (CORNER, "right"), ((0, 1), "right"), ((0, 1), "left"))
    assert (again.second_tries, again.bumps, again.moves) == (2, 1, 4)
    around = row((CORNER, "down"), ((1, 0), "stay"), reached=False)
    assert (around.second_tries, around.met, around.moves) == (0, False, None)
    assert row(((0, 3), "left")).bumps == 1


def test_as_json(result: DonutResult) -> None:
    saved = json.loads(json.dumps(result.to_dict(), allow_nan=False))
    assert saved["summary"] == {
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
    assert saved["rows"][1]["path"][-1] == [2, 4]
    assert saved["rows"][1]["moves"] == len(saved["rows"][1]["steps"]) - 1


def test_processes_change_nothing(result: DonutResult) -> None:
    told: list[None] = []
    with workers(jobs=2) as executor:
        assert donut_study(agents=2, executor=executor, on_done=lambda: told.append(None)) == result
    assert len(told) == 2


def test_lines(result: DonutResult) -> None:
    lines = donut_lines(result)
    assert lines[0].startswith("2 of 2 agents explored donut")
    assert "in exactly 10 moves (there, back, and round) 2/2" in lines
    assert "second tries at the closed way 0, of them against its door 0" in lines


def test_frames(result: DonutResult) -> None:
    long = DonutResult((row(*[(CORNER, "stay")] * 41, reached=False),))
    for shown, frames in ((result, 11), (long, FRAMES)):
        figure = donut_figures(shown)["donut_frames"]
        figure.draw_without_rendering()
        titles = [ax.get_title() for ax in figure.axes if ")" in ax.get_title()]
        assert len(titles) == frames
        box = figure.get_tightbbox()
        assert box.x0 >= 0.0
        assert box.x1 <= figure.get_figwidth()
    assert titles[-1].startswith("41) stay")


def test_who_has_not_explored_is_not_moved(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cogmap.experiments.session.default_steps", lambda maze: 1)
    lost = donut_study(agents=1)
    assert lost.rows[0].moves is None
    assert lost.summary()["explored"] == 0
    assert donut_figures(lost) == {}
    assert "reached the goal 0/1, in - moves" in donut_lines(lost)[1]


@pytest.mark.parametrize(("given", "message"), [({"agents": 0}, "use 1 or more"), ({"seed": -1}, "seed is -1")])
def test_bad_input(given: dict[str, int], message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        donut_study(**{"agents": 1, **given})
