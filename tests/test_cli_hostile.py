"""Names and labels of anybody: none commands a terminal, none leads to another file, none is obeyed."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from cogmap.agent import Agent
from cogmap.experiments.text import printable
from cogmap.model import CogmapError
from command_line import cogmap
from walks import GRID

pytestmark = pytest.mark.usefixtures("empty_folder")

TITLE = "\x1b]0;evil\x07"
"""What sets the title of a window."""

LABELS = [
    TITLE,
    "\x1b[2J",
    "$\\frac{",
    "<script>alert(1)</script>",
    "[bold]",
    "\u202eback",
    "a\nb\rc",
    "\x00",
    "\x9b31m",
]
MOTIONS = {TITLE: [-1, 0], "$\\frac{": [1, 0], "\u202eleft": [0, -1], "<b>": [0, 1], "stay": [0, 0]}
WORLD = f"w{TITLE}.json"
COMMANDS: list[list[Any]] = [
    ["explore", WORLD, "--max-steps", 12, "--save", "m.npz", "--trace", "t.json", "--out", "p.svg", "--json", "e.json"],
    ["explore", WORLD, "--max-steps", 4, "--runs", 1],
    ["navigate", WORLD, "--goal", TITLE, "--max-steps", 4],
    ["kidnap", WORLD, "--max-steps", 4],
    ["inspect", "m.npz"],
    ["inspect", "m.npz", "--places", "--transitions", "--growth", "--why", "--place", 0],
    ["inspect", "m.npz", "--graph", "svg"],
    ["inspect", "m.npz", "--graph", "dot", "--of", "window"],
    ["replay", "t.json"],
    ["explore", TITLE],
    ["explore", f"--{TITLE}"],
    ["inspect", "\udcff.npz"],
]


def written(path: str, *, name: str = TITLE) -> None:
    """Nine rooms whose names, labels and ways are as bad as can be."""
    edges = [
        {"source": LABELS[3 * row + column], "target": LABELS[3 * (row + down) + column + right], "way": way}
        for row in range(3)
        for column in range(3)
        for way, (down, right) in MOTIONS.items()
        if way != "stay" and 0 <= row + down < 3 and 0 <= column + right < 3
    ]
    nodes = [{"id": label, "sight": label, "position": [at % 3, at // 3]} for at, label in enumerate(LABELS)]
    graph = {"name": name, "motions": MOTIONS}
    Path(path).write_text(json.dumps({"directed": True, "graph": graph, "nodes": nodes, "edges": edges}))


def test_nothing_raw_reaches_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FORCE_COLOR", "1")
    written(WORLD)
    for command in COMMANDS:
        result = cogmap(*command)
        said = result.output + str(result.stderr)
        assert result.exit_code in (0, 1) or "cogmap: " in said
        assert not re.search("[\x00-\x09\x0b\x0c\x0e-\x1a\x1c-\x1f\x7f-\x9f\u202e]", said), command
        assert not re.search("\x1b(?!\\[[0-9;?]*[mAKhl])", said), command  # colours, and the lines of a bar
    ElementTree.parse("p.svg")
    ElementTree.parse("m.svg")
    assert "alert(1)</script>" not in Path("t.html").read_text()


def test_the_name_of_a_world_is_no_path() -> None:
    written(WORLD, name="/../evil")
    assert cogmap("explore", WORLD, "--max-steps", 3).exit_code in (0, 1)
    assert [path.name for path in Path().glob("*.png")] == ["_.._evil.png"]
    assert not list(Path("..").glob("*.png"))


@pytest.mark.parametrize("label", ["\ud800", ("a", "\udfff")])
def test_half_a_character_is_refused_where_it_would_be_written(label: Any) -> None:
    agent = Agent(GRID, seed=0)
    agent.step({"sight": label, "open": [True] * 5})
    with pytest.raises(CogmapError, match=r"has half of a character; label with whole text") as raised:
        agent.save("map.npz")
    assert str(raised.value).isprintable()


def test_what_cannot_be_printed_is_written_out() -> None:
    assert printable("plain é☃\nline") == "plain é☃\nline"
    assert printable("\x1b[2J\u202e\udcff\t") == r"\x1b[2J\u202e\udcff\t"
