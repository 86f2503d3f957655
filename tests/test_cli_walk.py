"""`cogmap walk`: by keys from a pipe, and by those of a terminal."""

from __future__ import annotations

import json
import os
import pty
import sys
from pathlib import Path
from typing import Any

import pytest
from cogmap.agent import Agent
from cogmap.experiments.cli import app
from cogmap.experiments.cli.walk import keys, keys_of
from command_line import cogmap
from typer.testing import CliRunner


def walked(given: str, *args: object) -> Any:
    result: Any = CliRunner().invoke(app, ["walk", *map(str, args)], input=given)
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result


def test_keys_of_a_pipe_walk_and_the_map_grows(tmp_path: Path) -> None:
    saved, trace = tmp_path / "map.npz", tmp_path / "walk.json"
    done = walked("u\nR\x1b[D q u", "3x3", "--seed", 0, "--save", saved, "--trace", trace)
    assert done.exit_code == 0
    assert [line.split(":")[0] for line in done.stdout.splitlines() if line.startswith("step")] == [
        "step 0",
        "step 1, up",
        "step 2, right",
        "step 3, left",
    ]
    assert "step 3, left: sight 4; open: up, down, left, right, stay" in done.stdout
    assert "3 steps through 3x3, truly at (1, 1) in the end" in done.stdout
    assert ">4<──" in done.stdout
    agent = Agent.load(saved)
    assert (agent.steps, int(agent.map.visited.sum())) == (4, 3)
    assert len(json.loads(trace.read_text())["frames"]) == 4


def test_it_goes_where_the_agent_would() -> None:
    done = walked("?" * 9, "3x3")
    assert "9 places, 9 visited" in done.stdout.splitlines()[-1]


def test_without_positions_places_are_listed() -> None:
    lines = walked("ul", "3x3", "--pose", "none").stdout.splitlines()
    listed = [line for line in lines if " shows " in line]
    assert [line[:1] for line in listed] == [" ", " ", ">"]
    assert "up to " in listed[0]


@pytest.mark.parametrize(
    ("given", "args", "words"),
    [
        ("ux", ["3x3"], "'x' is no key; arrows, u up, d down, l left, r right, s stay, ? what it would do, q end"),
        ("\x1b[H", ["3x3"], "'Esc' is no key"),
        ("u", ["nowhere"], "nowhere"),
        ("u", ["3x3", "--pose", "round"], "pose"),
        ("u", ["3x3", "--save", "no/such/folder/map.npz"], "folder"),
        ("u", ["3x3", "--noise", "wind=1"], "wind"),
        ("u", ["MiniGrid-Empty-5x5-v0"], "MiniGrid"),
    ],
)
def test_bad_input_is_one_line(given: str, args: list[str], words: str) -> None:
    refused = walked(given, *args)
    assert refused.exit_code == 2
    assert len(refused.stderr.splitlines()) == 1
    assert words in refused.stderr


def test_nothing_to_read_ends_it() -> None:
    assert "0 steps through donut" in walked("", "donut").stdout
    assert "arrow keys" in cogmap("walk", "--help").stdout


def test_keys_of_a_terminal_come_one_by_one(monkeypatch: pytest.MonkeyPatch) -> None:
    ours, its = pty.openpty()
    with os.fdopen(its, "r") as stdin:
        monkeypatch.setattr(sys, "stdin", stdin)
        with keys() as key:
            os.write(ours, b"\x1b[A\x1bOCd\x04")
            assert [key() for _ in range(4)] == ["arrow up", "arrow right", "d", "\x04"]
    os.close(ours)


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (("up", "stay"), {"arrow up": "up", "u": "up", "s": "stay"}),
        (("stay", "way 1", "way 2"), {"s": "stay", "1": "way 1", "2": "way 2"}),
        (("quit", "north", "nap"), {"1": "quit", "2": "north", "3": "nap"}),
    ],
)
def test_every_action_has_a_key(names: tuple[str, ...], expected: dict[str, str]) -> None:
    assert keys_of(names) == expected
