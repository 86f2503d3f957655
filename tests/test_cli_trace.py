from __future__ import annotations

from pathlib import Path

import pytest
from cogmap.experiments import explore, navigate
from cogmap.views import Recording
from cogmap.worlds import MAZES
from command_line import cogmap

pytestmark = pytest.mark.usefixtures("empty_folder")


def test_an_exploration_is_recorded_from_the_first_room_to_the_last() -> None:
    cogmap("explore", "3x3_alias", "--seed", "4", "--trace", "walk.json", "--out", "walk.png")
    recording = Recording.load("walk.json")
    run = explore(MAZES["3x3_alias"], seed=4)
    assert run.steps_to_complete is not None
    assert len(recording) == run.steps_to_complete + 1
    walked = [recording.places[frame["at"]] for frame in recording.frames]
    assert walked[0] == run.start
    assert set(walked) == set(MAZES["3x3_alias"].rooms)


def test_of_a_sweep_the_first_walk_is_recorded() -> None:
    cogmap("explore", "3x3", "--runs", "2", "--seed", "7", "--trace", "walk.json.gz")
    recording = Recording.load("walk.json.gz")
    assert recording.places[recording.frames[0]["at"]] == explore(MAZES["3x3"], seed=7, max_steps=1).start


def test_a_way_to_a_goal_is_recorded_with_the_exploring_before() -> None:
    cogmap("navigate", "donut", "--goal", "12", "--close", "0,2", "--trace", "walk.json")
    run = navigate(MAZES["donut"], goal=12, closed=[(0, 2)])
    assert run.steps is not None
    assert run.steps_to_explore is not None
    recording = Recording.load("walk.json")
    assert len(recording) == run.steps_to_explore + run.steps + 2
    assert [frame.get("closed_rooms") for frame in recording.frames][-1] == [recording.places.index((0, 2))]
    assert recording.frames[0].get("closed_rooms") is None


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("explore", "3x3", "--agent", "random"), "agent random leaves no trace"),
        (("navigate", "3x3", "--goal", "1", "--agent", "cscg"), "agent cscg leaves no trace"),
        (("explore", "3x3", "--growth", "all"), "keep one walk"),
    ],
)
def test_what_leaves_no_trace_is_refused(words: tuple[str, ...], message: str) -> None:
    result = cogmap(*words, "--trace", "walk.json")
    assert (result.exit_code, len(result.stderr.splitlines())) == (2, 1)
    assert message in result.stderr
    assert not Path("walk.json").exists()


def test_a_trace_that_cannot_be_written_is_refused_before_walking() -> None:
    result = cogmap("explore", "3x3", "--trace", "no/walk.json")
    assert result.exit_code == 2
    assert "cannot write no/walk.json" in result.stderr
