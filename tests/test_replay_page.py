"""The replay page: one file that needs nothing else, and in which a label is only ever text."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from charts import row, torus
from cogmap.agent import Agent, Settings
from cogmap.model import CogmapError
from cogmap.views import Recorder, Recording, replay_html, sight_colour
from cogmap.worlds import load_world
from command_line import cogmap
from recordings import eventful, eventful_walk, recorded, tolman_walk
from walks import GRID

HOSTILE = [
    "</script><script>alert(1)</script>",
    "<!--<script>",
    "]]>",
    "&lt;img src=x onerror=alert(1)&gt;",
    "@@script@@",
    "\u2028'\"\\",
    "\x00",
]


class Page(HTMLParser):
    """Elements with their attributes, and the text of scripts, styles and the title."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.texts: list[tuple[str, str]] = []
        self._open = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        self._open = tag
        if tag in ("script", "style", "title"):
            self.texts.append((tag, ""))

    def handle_data(self, data: str) -> None:
        if self.texts and self._open == self.texts[-1][0]:
            tag, text = self.texts[-1]
            self.texts[-1] = tag, text + data

    def handle_endtag(self, tag: str) -> None:
        self._open = ""

    def text(self, tag: str, number: int = 0) -> str:
        return [text for found, text in self.texts if found == tag][number]


@pytest.fixture(scope="module")
def recording() -> Recording:
    return eventful_walk()


def test_it_needs_nothing_else(recording: Recording) -> None:
    text = replay_html(recording)
    assert set(re.findall(r"\w+://[^\s\"')]*", text)) == {"http://www.w3.org/2000/svg"}
    page = Page(text)
    assert not [
        name for _, attributes in page.elements for name in attributes if name in ("src", "href", "srcset", "style")
    ]
    assert not re.search(r"@import|url\(|fetch\(|XMLHttpRequest|import\(|innerHTML|document\.write|eval\(", text)
    assert "@@" not in text


def test_only_its_own_script_and_style_may_run(recording: Recording) -> None:
    page = Page(replay_html(recording))
    policy = next(a["content"] for tag, a in page.elements if tag == "meta" and a.get("http-equiv")) or ""
    for directive, text in (("script-src", page.text("script", 1)), ("style-src", page.text("style"))):
        digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
        assert f"{directive} 'sha256-{digest}'" in policy
    assert policy.startswith("default-src 'none'")


def test_labels_and_titles_are_only_text() -> None:
    agent = Agent(GRID, settings=Settings(look_ahead=2), seed=0)
    recorder = Recorder(row(*HOSTILE), title=HOSTILE[0] + "&", goals=HOSTILE)
    for label in HOSTILE:
        agent.step({"sight": label, "open": [False, False, False, True, True]})
        recorder.add(agent)
    page, plain = Page(replay_html(recorder.recording())), Page(replay_html(eventful(steps=2)))
    assert [tag for tag, _ in page.elements] == [tag for tag, _ in plain.elements]
    assert page.text("script", 1) == plain.text("script", 1)
    data = json.loads(page.text("script", 0))
    assert [look[0] for look in data["looks"]] == HOSTILE
    assert page.text("title") == HOSTILE[0] + "& – cogmap replay"


def test_sights_have_the_colours_of_the_plots() -> None:
    data = json.loads(Page(replay_html(recorded(load_world("3x3"), 3))).text("script", 0))
    for text, colour, ink in data["looks"]:
        red, green, blue = (int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5))
        assert (red, green, blue) == pytest.approx(sight_colour(int(text)), abs=1 / 500)
        assert ink in ("#000", "#fff")


def test_three_hundred_steps_are_light() -> None:
    text = replay_html(tolman_walk())
    assert len(text.encode()) < 2_000_000


def test_a_walk_without_a_maze_and_in_one_dimension() -> None:
    agent = Agent({"left": (-1,), "right": (1,), "stay": (0,)}, settings=Settings(look_ahead=2), seed=0)
    recorder = Recorder()
    for sight in (0, 1):
        agent.step({"sight": sight, "open": [False, True, True]})
        recorder.add(agent)
    assert json.loads(Page(replay_html(recorder.recording())).text("script", 0))["world"] is None


def test_a_walk_on_a_graph() -> None:
    chart, recorder = torus(3), Recorder(torus(3), title="torus")
    agent, place = Agent(GRID, settings=Settings(look_ahead=2), seed=0), (0, 0)
    for step in range(5):
        action = agent.step({"sight": chart.sights[place], "open": [True] * 5})
        recorder.add(agent, place=place, closed_rooms=[(1, 1)] if step else (), closed_doors=[((0, 0), (0, 2))])
        place = {**chart.successors(place), "stay": place}[list(GRID)[action]]
    kept = recorder.recording()
    assert kept.places[kept.frames[0]["at"]] == (0, 0)
    assert kept.frames[1]["closed_rooms"] == [kept.places.index((1, 1))]
    world = json.loads(Page(replay_html(kept)).text("script", 0))["world"]
    assert (world["rooms"], len(world["places"]), len(world["ways"])) == (False, 9, 18)
    agent.step({"sight": 0, "open": [True] * 5})
    with pytest.raises(CogmapError, match=r"\(7, 7\) is no place of 'test'"):
        recorder.add(agent, place=(7, 7))


def test_three_dimensions_cannot_be_drawn() -> None:
    agent = Agent({"in": (0, 0, 1), "out": (0, 0, -1), "stay": (0, 0, 0)}, settings=Settings(look_ahead=2), seed=0)
    agent.step({"sight": 0, "open": [True, True, True]})
    recorder = Recorder()
    recorder.add(agent)
    with pytest.raises(CogmapError, match="3 dimensions"):
        replay_html(recorder.recording())


@pytest.mark.usefixtures("empty_folder")
@pytest.mark.parametrize(("name", "page"), [("walk.json", "walk.html"), ("walk.trace.json.gz", "walk.trace.html")])
def test_the_command_makes_the_page(name: str, page: str) -> None:
    kept = recorded(load_world("3x3"), 5)
    kept.save(name)
    result = cogmap("replay", name)
    assert result.exit_code == 0
    assert page in result.output
    assert Path(page).read_text(encoding="utf-8") == replay_html(kept)
    assert cogmap("replay", name, "--out", "other.html").exit_code == 0
    assert Path("other.html").read_bytes() == Path(page).read_bytes()


@pytest.mark.usefixtures("empty_folder")
@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (["none.json"], "there is no file"),
        (["text.json"], "no recording, or truncated"),
        (["walk.json", "--out", "walk.json"], "the file that is read"),
        (["walk.json", "--out", "missing/page.html"], "cannot write"),
        ([], "Missing argument"),
    ],
)
def test_the_command_refuses_in_one_line(arguments: list[str], why: str) -> None:
    recorded(load_world("3x3"), 2).save("walk.json")
    before = Path("walk.json").read_bytes()
    Path("text.json").write_text("no JSON")
    result: Any = cogmap("replay", *arguments)
    assert result.exit_code == 2
    assert why in result.stderr
    assert len(result.stderr.strip().splitlines()) == 1
    assert sorted(path.name for path in Path().iterdir()) == ["text.json", "walk.json"]
    assert Path("walk.json").read_bytes() == before
