from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
from cogmap.agent import Agent
from cogmap.experiments import WEIGHT, Parts
from cogmap.worlds import MAZES
from command_line import cogmap

pytestmark = pytest.mark.usefixtures("empty_folder")


def test_one_kidnapping_is_told() -> None:
    result = cogmap("kidnap", "3x3", "--json", "k.json")
    assert result.exit_code == 0
    for part in ("moved to (", "recovered after 0 steps", "map intact: yes", "runs saved: k.json"):
        assert part in result.stdout
    assert [run["seed"] for run in json.loads(Path("k.json").read_text())["runs"]] == [0]


def test_a_sweep_of_kidnappings() -> None:
    result = cogmap("kidnap", "3x3", "--runs", 2, "--seed", 6, "--look-ahead", 4, "--json", "k.json")
    assert result.exit_code == 0
    assert "recovered 2/2" in result.stdout
    saved = json.loads(Path("k.json").read_text())
    assert [run["seed"] for run in saved["runs"]] == [6, 7]
    assert saved["settings"]["look_ahead"] == 4


def test_one_way_to_a_goal_is_told() -> None:
    known = cogmap("navigate", "3x3", "--goal", 8)
    assert known.exit_code == 0
    assert "reached after" in known.stdout
    assert "without a word" in known.stdout
    unknown = cogmap("navigate", "3x3", "--goal", 8, "--unexplored", "--weight", 4)
    assert unknown.exit_code == 0
    assert "nearest-frontier search" in unknown.stdout
    assert os.listdir() == []


@pytest.mark.parametrize("options", [[], ["--unexplored"]])
def test_a_sweep_of_ways(options: list[str]) -> None:
    result = cogmap("navigate", "3x3", "--goal", 8, "--runs", 2, "--json", "n.json", *options)
    assert result.exit_code == 0
    assert "reached 2/2" in result.stdout
    saved = json.loads(Path("n.json").read_text())
    assert (saved["goal"], saved["weight"], saved["unexplored"]) == (8, 8.0, bool(options))


def test_words_are_goals_too() -> None:
    Path("words.txt").write_text("[red] b\n")
    result = cogmap("navigate", "words.txt", "--goal", "[red]")
    assert result.exit_code == 0
    assert "goal [red]" in result.stdout


@pytest.mark.parametrize("command", [["kidnap", "3x3"], ["navigate", "3x3", "--goal", "8"]])
def test_a_run_that_fails_says_so(command: list[str]) -> None:
    single = cogmap(*command, "--max-steps", 2)
    assert single.exit_code == 1
    assert "Not explored after 2 steps" in single.stdout
    sweep = cogmap(*command, "--max-steps", 2, "--runs", 2, "--json", "x.json")
    assert sweep.exit_code == 0
    assert "with seeds 0, 1" in sweep.stdout
    assert json.loads(Path("x.json").read_text())["summary"]["runs"] == 2


def test_a_goal_that_is_not_found_in_time() -> None:
    far = cogmap("navigate", "4x4", "--goal", 3, "--unexplored", "--max-steps", 1)
    assert far.exit_code == 1
    assert "not reached after 1 step;" in far.stdout


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["kidnap"], "Missing argument"),
        (["kidnap", "nowhere"], "no world 'nowhere'"),
        (["kidnap", "one.txt"], "has one room"),
        (["kidnap", "3x3", "--runs", "0"], "--runs"),
        (["kidnap", "3x3", "--jobs", "0"], "--jobs"),
        (["kidnap", "3x3", "--max-steps", "0"], "--max-steps"),
        (["kidnap", "3x3", "--policies", "x"], "policies is 'x'"),
        (["kidnap", "3x3", "--json", "no/x.json"], "cannot write no/x.json"),
        (["navigate", "3x3"], "--goal"),
        (["navigate", "nowhere", "--goal", "1"], "no world 'nowhere'"),
        (["navigate", "3x3", "--goal", "9"], "has label 9; use one of 0, 1, 2, 3, 4, 5, 6, 7, 8"),
        (["navigate", "3x3", "--goal", "red"], "has label 'red'"),
        (["navigate", "3x3", "--goal", "8", "--weight", "0"], "weight is 0"),
        (["navigate", "3x3", "--goal", "8", "--weight", "nan"], "weight is nan"),
        (["navigate", "3x3", "--goal", "8", "--weight", "much"], "--weight"),
        (["navigate", "3x3", "--goal", "8", "--look-ahead", "0"], "--look-ahead"),
        (["navigate", "3x3", "--goal", "8", "--seed", "-1"], "--seed"),
        (["navigate", "3x3", "--goal", "8", "--json", "."], "cannot write ."),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(
    arguments: list[str], message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Agent, "step", lambda *_: pytest.fail("it walked"))
    Path("one.txt").write_text("7\n")
    result = cogmap(*arguments)
    assert result.exit_code == 2
    assert message in result.stderr
    assert result.stderr.startswith("cogmap: ")
    assert result.stderr.count("\n") == 1
    assert result.stdout == ""
    assert os.listdir() == ["one.txt"]


def test_the_defaults_are_those_of_the_library() -> None:
    for command in (("kidnap", "3x3"), ("navigate", "3x3", "--goal", 8)):
        cogmap(*command, "--runs", 1, "--json", "d.json")
        saved = json.loads(Path("d.json").read_text())
        assert saved["settings"] == json.loads(json.dumps(Parts().to_dict(MAZES["3x3"])))
        assert saved.get("weight", WEIGHT) == WEIGHT


def test_a_room_can_be_closed_before_it_sets_out(tmp_path: Path) -> None:
    saved = tmp_path / "ways.json"
    done = cogmap("navigate", "donut", "--goal", 12, "--runs", 2, "--close", "0,2", "--look-ahead", 12, "--json", saved)
    assert done.exit_code == 0, done.output
    result = json.loads(saved.read_text())
    assert result["closed"] == [[0, 2]]
    assert result["summary"]["reached"] == 2
    assert all(run["start"] != [0, 2] for run in result["runs"])


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        (["--close", "9,9"], "has no room at"),
        (["--close", "0"], "is no room; give ROW,COLUMN"),
        (["--close", "a,b"], "is no room; give ROW,COLUMN"),
        (["--close", "2,2"], "there is no way from"),
        (["--close", "0,1", "--unexplored"], "sets out unexplored"),
    ],
)
def test_closures_that_cannot_be(options: list[str], complaint: str) -> None:
    refused = cogmap("navigate", "3x3", "--goal", 8, *options)
    assert refused.exit_code == 2
    assert complaint in " ".join(refused.output.split())
    assert "Traceback" not in refused.output


def test_graphs_are_worlds_too() -> None:
    way = {"right": ("a", "b"), "left": ("b", "a"), "down": ("b", "c"), "up": ("c", "b")}
    motions = {"left": [0, -1], "right": [0, 1], "up": [-1, 0], "down": [1, 0]}
    graph = {
        "directed": True,
        "graph": {"name": "bend", "motions": motions},
        "nodes": [{"id": node, "sight": f"room {node}"} for node in "abc"],
        "edges": [{"source": source, "target": target, "way": name} for name, (source, target) in way.items()],
    }
    Path("bend.json").write_text(json.dumps(graph))
    explored = cogmap("explore", "bend.json", "--json", "e.json", "--trace", "t.json")
    assert (explored.exit_code, explored.stderr) == (0, "")
    run = json.loads(Path("e.json").read_text())["runs"][0]
    assert run["start"] in ("a", "b", "c")
    assert run["steps_to_complete"] == run["oracle_steps"]
    assert "map intact: yes" in cogmap("kidnap", "bend.json").stdout
    known = cogmap("navigate", "bend.json", "--goal", "room c", "--runs", 2, "--agent", "frontier", "--unexplored")
    assert "reached 2/2" in known.stdout
    assert cogmap("replay", "t.json").exit_code == 0
