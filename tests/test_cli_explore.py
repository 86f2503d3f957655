from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from cogmap.agent import Agent
from cogmap.experiments import Parts
from cogmap.experiments.cli import app
from cogmap.experiments.cli import explore as command
from cogmap.worlds import MAZES, format_maze, hall
from command_line import cogmap, heeding_ctrl_c
from matplotlib.figure import Figure
from typer.testing import CliRunner

COMMAND = [sys.executable, "-c", "from cogmap.experiments.cli import main; main()"]


pytestmark = pytest.mark.usefixtures("empty_folder")


def test_one_walk_is_shown_and_drawn() -> None:
    result = cogmap("explore", "3x3", "--seed", 2)
    assert result.exit_code == 0
    for part in ("path from", "complete after", "9 places (9 visited)", "free energy F", "picture saved: 3x3.png"):
        assert part in result.stdout
    assert Path("3x3.png").read_bytes().startswith(b"\x89PNG")
    assert max(map(len, result.stdout.splitlines())) <= 80


def test_one_room() -> None:
    Path("one.txt").write_text("7\n")
    result = cogmap("explore", "one.txt", "--json", "one.json", "--out", "one.svg")
    assert result.exit_code == 0
    assert json.loads(Path("one.json").read_text())["runs"][0]["steps_to_complete"] == 0
    assert "<svg" in Path("one.svg").read_text()


def test_labels_are_not_markup() -> None:
    Path("words.txt").write_text("[red] [/red]\n日本 b\n")
    result = cogmap("explore", "words.txt")
    assert result.exit_code == 0
    assert "[/red]" in result.stdout
    assert result.stderr == ""


def test_noise_and_steps() -> None:
    noise = [
        word for kind in ("sight=0.1", "door=.05", "slip=0.1", "fail=.1", "moved=0.2") for word in ("--noise", kind)
    ]
    result = cogmap("explore", "3x3", *noise, "--steps", 30, "--json", "x.json")
    assert result.exit_code == 0
    assert "certain but wrong" in result.stdout
    saved = json.loads(Path("x.json").read_text())
    assert saved["noise"] == {"sight": 0.1, "door": 0.05, "slip": 0.1, "fail": 0.1, "moved": 0.2}
    assert {"places", "map_right", "known", "certain_but_wrong"} <= saved["runs"][0].keys()
    assert cogmap("kidnap", "3x3", "--noise", "slip=0.01", "--runs", 1, "--json", "k.json").exit_code == 0
    assert json.loads(Path("k.json").read_text())["noise"] == {"slip": 0.01}
    cogmap("navigate", "3x3", "--goal", 3, "--noise", "slip=0.01", "--runs", 1, "--json", "n.json")
    assert json.loads(Path("n.json").read_text())["noise"] == {"slip": 0.01}


def test_sights_and_formats_of_files() -> None:
    Path("ways.json").write_text(
        json.dumps(
            {
                "directed": True,
                "graph": {"motions": {"left": [0, -1], "right": [0, 1]}},
                "nodes": [{"id": i} for i in range(4)],
                "edges": [{"source": i, "target": i + 1, "way": "right"} for i in range(3)]
                + [{"source": i + 1, "target": i, "way": "left"} for i in range(3)],
            }
        )
    )
    for sights, different in (("distinct", 4), ("ways", 2)):
        result = cogmap("explore", "ways.json", "--sights", sights)
        assert result.exit_code == 0
        assert f"{different} sight" in result.stdout
    Path("walls.txt").write_text("####\n#..#\n####\n")
    assert cogmap("explore", "walls.txt").exit_code == 2
    assert cogmap("explore", "walls.txt", "--format", "ascii", "--sights", "1", "--runs", 1).exit_code == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["3x3", "--noise", "sight"], "'sight' is no kind with a rate"),
        (["3x3", "--noise", "sight=much"], "'sight=much' is no kind with a rate"),
        (["3x3", "--noise", "frob=0.1"], "unknown noise 'frob'"),
        (["3x3", "--noise", "slip=1.5"], "noise 'slip' is 1.5"),
        (["3x3", "--noise", "slip=-1"], "noise 'slip' is -1.0"),
        (["3x3", "--noise", "slip=nan"], "noise 'slip' is nan"),
        (["3x3", "--noise", "slip=.1", "--noise", "slip=.2"], "slip is given twice"),
        (["3x3", "--pose", "sphere"], "pose is 'sphere'"),
        (["3x3", "--pose", "turning"], "use --pose lattice, or a body that may be turned"),
        (["3x3", "--cost", "metres"], "here every way is one step: leave --cost out"),
        (["3x3", "--steps", 0], "--steps"),
        (["3x3", "--steps", 5, "--max-steps", 5], "give one of them"),
        (["bare.json"], "sight"),
        (["bare.json", "--sights", "many"], "many"),
        (["bare.json", "--sights", "0"], "0"),
        (["bare.json", "--sights", "distinct", "--agent", "random"], "reckons"),
        (["maze.txt", "--format", "morse"], "unknown format 'morse'"),
    ],
)
def test_bad_noise_poses_sights_and_formats(arguments: list[object], message: str) -> None:
    ends = [{"source": a, "target": b} for a, b in ((0, 1), (1, 0))]
    Path("bare.json").write_text(json.dumps({"directed": True, "nodes": [{"id": 0}, {"id": 1}], "edges": ends}))
    Path("maze.txt").write_text("0 1\n")
    result = cogmap("explore", *arguments, "--runs", 1)
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1
    assert message in result.stderr


def test_a_walk_that_does_not_complete_says_so() -> None:
    result = cogmap("explore", "3x3", "--max-steps", 2)
    assert result.exit_code == 1
    assert "Not complete after 2 steps" in result.stdout
    sweep = cogmap("explore", "3x3", "--max-steps", 2, "--runs", 2, "--json", "x.json")
    assert sweep.exit_code == 0
    assert "not complete with seeds 0, 1" in sweep.stdout
    saved = json.loads(Path("x.json").read_text())
    assert saved["summary"]["completed"] == 0
    assert saved["runs"][0]["steps_to_complete"] is None


def test_a_sweep_writes_runs_agent_and_picture() -> None:
    result = cogmap("explore", "3x3", "--runs", 2, "--seed", 8, "--json", "r.json", "--save", "m.npz", "--out", "p.png")
    assert result.exit_code == 0
    saved = json.loads(Path("r.json").read_text())
    assert [run["seed"] for run in saved["runs"]] == [8, 9]
    assert saved["settings"] == json.loads(json.dumps(Parts().to_dict(MAZES["3x3"])))
    assert Agent.load("m.npz").steps == saved["runs"][0]["steps_to_complete"] + 1
    assert sorted(os.listdir()) == ["m.npz", "p.png", "r.json"]


def test_a_sweep_draws_nothing_unless_asked() -> None:
    assert cogmap("explore", "3x3", "--runs", 1, "--agent", "frontier").exit_code == 0
    assert os.listdir() == []


@pytest.mark.parametrize("growth", ["all", "static, observed,predicted"])
def test_growths_are_compared(growth: str) -> None:
    result = cogmap("explore", "t_maze", "--runs", 1, "--growth", growth, "--json", "g.json")
    assert result.exit_code == 0
    saved = json.loads(Path("g.json").read_text())
    assert [part["settings"]["growth"] for part in saved] == ["static", "observed", "predicted"]
    assert all(name in result.stdout for name in ("static", "observed", "predicted"))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["nowhere"], "no world 'nowhere'"),
        (["ragged.txt"], "line 2 has 1 labels"),
        (["empty.txt"], "is empty"),
        (["binary.txt"], "is not text"),
        ([], "Missing argument"),
        (["3x3", "4x4"], "unexpected extra argument"),
        (["3x3", "--agent", "genius"], "no agent is called 'genius'"),
        (["3x3", "--policies", "x"], "policies is 'x'"),
        (["3x3", "--growth", "x"], "growth is 'x'"),
        (["3x3", "--growth", "static,"], "growth is ''"),
        (["3x3", "--engine", "x"], "engine is 'x'"),
        (["3x3", "--look-ahead", "0"], "--look-ahead"),
        (["3x3", "--runs", "0"], "--runs"),
        (["3x3", "--jobs", "0"], "--jobs"),
        (["3x3", "--max-steps", "0"], "--max-steps"),
        (["3x3", "--seed", "-1"], "--seed"),
        (["3x3", "--runs", "two"], "--runs"),
        (["3x3", "--fast"], "--fast"),
        (["3x3", "--json", "no/x.json"], "cannot write no/x.json"),
        (["3x3", "--json", "."], "cannot write ."),
        (["3x3", "--out", "no/x.png"], "cannot write no/x.png"),
        (["3x3", "--out", "x.bmp"], "no picture suffix"),
        (["3x3", "--save", "no/x.npz"], "cannot write no/x.npz"),
        (["3x3", "--json", "a.png", "--out", "a.png"], "two outputs"),
        (["3x3", "--agent", "random", "--save", "m.npz"], "no map to save"),
        (["3x3", "--agent", "random", "--growth", "all"], "does not grow"),
        (["3x3", "--growth", "all", "--save", "m.npz"], "keep one walk"),
        (["3x3", "--policies", "exhaustive", "--look-ahead", "12"], "look less far ahead"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(options: list[str], message: str) -> None:
    Path("ragged.txt").write_text("0 1\n2\n")
    Path("empty.txt").write_text("")
    Path("binary.txt").write_bytes(b"\x00\xff\xfe")
    before = sorted(os.listdir())
    result = cogmap("explore", *options)
    assert result.exit_code == 2
    assert message in result.stderr
    assert result.stderr.startswith("cogmap: ")
    assert result.stderr.count("\n") == 1
    assert result.stdout == ""
    assert sorted(os.listdir()) == before


def test_outputs_are_checked_before_walking(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Agent, "step", lambda *_: pytest.fail("it walked"))
    assert cogmap("explore", "3x3", "--json", "no/x.json").exit_code == 2
    assert cogmap("explore", "3x3", "--runs", 3, "--save", "no/x.npz").exit_code == 2


def test_our_mistakes_are_not_hidden(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> None:
        raise ValueError("a bug")

    monkeypatch.setattr(Agent, "step", broken)
    assert isinstance(CliRunner().invoke(app, ["explore", "3x3"]).exception, ValueError)


def test_an_interrupt_is_one_line_and_exit_code_130(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Agent, "step", interrupt)
    result = cogmap("explore", "3x3", "--json", "x.json")
    assert result.exit_code == 130
    assert result.stderr.strip() == "cogmap: interrupted; nothing more was written"
    assert os.listdir() == []


def test_ctrl_c_ends_the_workers_too() -> None:
    Path("hall.txt").write_text(format_maze(hall(12, 12, sights=None)))
    command = [*COMMAND, "explore", "hall.txt", "--runs", "50", "--jobs", "2"]
    process = subprocess.Popen(
        command, stderr=subprocess.PIPE, text=True, start_new_session=True, preexec_fn=heeding_ctrl_c
    )
    while _children(process.pid) < 3:  # two workers, and what counts their resources
        assert process.poll() is None
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGINT)
    _, errors = process.communicate(timeout=90)
    assert process.returncode == 130
    assert errors == "cogmap: interrupted; nothing more was written\n"


def _children(pid: int) -> int:
    found = subprocess.run(["ps", "-o", "pid=", "--ppid", str(pid)], capture_output=True, text=True, check=False)
    return len(found.stdout.split())


def test_the_real_command() -> None:
    run = subprocess.run([*COMMAND, "explore", "3x3", "--runs", "2"], capture_output=True, text=True, check=True)
    assert "2/2" in run.stdout
    bad = subprocess.run([*COMMAND, "explore", "3x3", "--runs", "0"], capture_output=True, text=True, check=False)
    assert (bad.returncode, bad.stderr.count("\n")) == (2, 1)


def test_a_terminal_without_unicode() -> None:
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    command = [*COMMAND, "explore", "3x3", "--agent", "frontier"]
    run = subprocess.run(command, capture_output=True, check=True, env=environment)
    assert run.stdout.isascii()


def test_the_defaults_are_those_of_the_library() -> None:
    assert cogmap("explore", "3x3", "--runs", 1, "--json", "d.json").exit_code == 0
    saved = json.loads(Path("d.json").read_text())
    assert saved["settings"] == json.loads(json.dumps(Parts().to_dict(MAZES["3x3"])))


def test_the_agent_of_the_paper() -> None:
    assert cogmap("explore", "3x3", "--runs", 2, "--preset", "paper", "--json", "p.json").exit_code == 0
    settings = json.loads(Path("p.json").read_text())["settings"]
    assert (settings["policies"], settings["choice"], settings["discount"]) == ("l_shaped", "sampled", 1.0)
    assert settings["hypotheses"] is None
    other = cogmap(
        "explore", "3x3", "--runs", 1, "--preset", "paper", "--policies", "self_avoiding", "--json", "o.json"
    )
    assert other.exit_code == 0
    assert json.loads(Path("o.json").read_text())["settings"]["policies"] == "self_avoiding"
    refused = cogmap("explore", "3x3", "--preset", "rat")
    assert (refused.exit_code, refused.stderr.count("\n")) == (2, 1)
    assert "choose one of cogmap, paper" in refused.stderr


def test_energies_are_drawn_as_lines_of_signs() -> None:
    lines = cogmap("explore", "3x3").stdout.splitlines()
    drawn = [set(line) & set("▁▂▃▄▅▆▇█") for line in lines if line.startswith(("free energy F", "expected free"))]
    assert len(drawn) == 2
    assert all({"▁", "█"} <= signs for signs in drawn)


def test_what_is_there_and_was_not_named_is_not_overwritten() -> None:
    for picture in ("3x3.png", "3x3-2.png", "3x3-3.png"):
        assert f"picture saved: {picture}" in cogmap("explore", "3x3", "--agent", "frontier").stdout
    Path("3x3.png").write_text("mine")
    assert cogmap("explore", "3x3", "--agent", "frontier").exit_code == 0
    assert Path("3x3.png").read_text() == "mine"
    assert cogmap("explore", "3x3", "--agent", "frontier", "--out", "3x3.png").exit_code == 0
    assert Path("3x3.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    "command",
    [
        ["explore", "house.txt", "--json", "house.txt"],
        ["explore", "house.txt", "--save", "./house.txt"],
        ["explore", "house.txt", "--trace", "link.txt"],
        ["kidnap", "house.txt", "--json", "house.txt"],
        ["navigate", "house.txt", "--goal", "hall", "--json", "house.txt"],
    ],
)
def test_the_maze_that_is_read_is_not_written(command: list[str]) -> None:
    Path("house.txt").write_text("hall attic\n")
    Path("link.txt").symlink_to("house.txt")
    refused = cogmap(*command)
    assert refused.exit_code == 2
    assert "is the file that is read; write to another" in refused.stderr
    assert Path("house.txt").read_text() == "hall attic\n"


def test_of_a_large_world_the_part_walked_is_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[int] = []
    monkeypatch.setattr(command, "PARTLY_DRAWN", 8)
    monkeypatch.setattr(
        "cogmap.views.explore_figure", lambda chart, *_, **__: drawn.append(len(chart.places)) or Figure()
    )
    assert cogmap("explore", "3x3", "--max-steps", 1, "--out", "x.svg").exit_code == 1
    assert len(drawn) == 1
    assert drawn[0] < 9
    monkeypatch.setattr(command, "MOST_DRAWN", 3)
    result = cogmap("explore", "3x3", "--max-steps", 1, "--out", "y.svg")
    assert "No picture: more than 3 rooms" in result.stdout
    assert not Path("y.svg").exists()
    assert len(drawn) == 1


def test_what_is_too_large_is_left_out_and_said() -> None:
    Path("big.txt").write_text(format_maze(hall(142, 142, sights=None)))
    started = cogmap("explore", "big.txt", "--max-steps", 2, "--runs", 1, "--json", "x.json")
    assert started.exit_code == 0
    row = json.loads(Path("x.json").read_text())["runs"][0]
    assert row["oracle_steps"] is None
    assert "frontier_steps" not in row
    assert row["not_worked_out"] == "oracle_steps, frontier_steps: more than 20000 places"
    refused = cogmap("explore", "big.txt", "--trace", "x.trace")
    assert refused.exit_code == 2
    assert "more than 20000 places" in refused.stderr
