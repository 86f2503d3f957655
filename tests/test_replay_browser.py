"""The replay page in a browser, opened from disk."""

from __future__ import annotations

import os
import re
import shutil
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from charts import row, torus
from cogmap.agent import Agent, Settings
from cogmap.views import Recorder, replay_html, show
from recordings import eventful_walk, tolman_walk
from walks import GRID

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")

playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed; pip install playwright")
pytestmark = [
    pytest.mark.skipif(
        CHROMIUM is None and not os.environ.get("CI"), reason="no Chromium on the PATH; install the package chromium"
    ),
]

PHONE, DESK = {"width": 360, "height": 740}, {"width": 1280, "height": 900}


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with playwright.sync_playwright() as driver:
        found = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"], headless=True)
        yield found
        found.close()


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with pages to open."""
    folder = tmp_path_factory.mktemp("pages")
    (folder / "tolman.html").write_text(replay_html(tolman_walk()), encoding="utf-8")
    (folder / "eventful.html").write_text(replay_html(eventful_walk()), encoding="utf-8")
    return folder


@pytest.fixture
def open_page(browser: Any) -> Iterator[Any]:
    """Opens a file in a fresh context; nothing may go wrong in it, nothing may be fetched."""
    wrong: list[str] = []
    contexts: list[Any] = []

    def opened(path: Path, *, viewport: dict[str, int] = DESK, **options: Any) -> Any:
        context = browser.new_context(viewport=viewport, **options)
        contexts.append(context)
        page = context.new_page()
        page.on("console", lambda message: wrong.append(message.text))
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("request", lambda request: request.url.startswith("file:") or wrong.append(request.url))
        page.goto(path.as_uri())
        return page

    yield opened
    for context in contexts:
        context.close()
    assert wrong == []


def state(page: Any, name: str) -> str:
    return page.evaluate("name => document.documentElement.dataset[name]", name)


def until(fine: Callable[[], bool], seconds: float = 120.0) -> None:
    """Wait (the policy of the page keeps Playwright from waiting inside it)."""
    end = time.monotonic() + seconds
    while not fine():
        assert time.monotonic() < end
        time.sleep(0.02)


def room(page: Any) -> str:
    return page.locator("#agent").get_attribute("data-room")


def test_the_first_picture_is_light(open_page: Any, pages: Path) -> None:
    page = open_page(pages / "tolman.html")
    page.wait_for_selector("#agent")
    assert page.locator("#window-svg [data-variable]").count() > 0
    assert page.evaluate("document.querySelectorAll('*').length") < 2000


def test_it_runs_in_the_frame_of_a_notebook_whose_lines_are_joined(open_page: Any, tmp_path: Path) -> None:
    shown = " ".join(show(tolman_walk())._repr_html_().splitlines())
    (tmp_path / "notebook.html").write_text(f"<!DOCTYPE html><body>{shown}</body>", encoding="utf-8")
    frame = open_page(tmp_path / "notebook.html").frame_locator("iframe")
    frame.locator("#agent").wait_for()
    assert frame.locator("#count").text_content() == "1 / 300"


def test_the_slider_moves_the_agent(open_page: Any, pages: Path) -> None:
    page = open_page(pages / "tolman.html")
    assert (state(page, "step"), page.locator("#count").text_content()) == ("0", "1 / 300")
    start, slider = room(page), page.locator("#slider")
    slider.fill("5")
    assert state(page, "step") == "5"
    assert room(page) != start
    assert "Step 5" in page.locator("#words").text_content()
    slider.fill("299")
    assert state(page, "step") == "299"
    assert slider.get_attribute("aria-valuetext") == "step 299, 300 of 300"


def test_keys_step(open_page: Any, pages: Path) -> None:
    page = open_page(pages / "eventful.html")
    seen: list[str] = []
    for key in ("ArrowRight", "ArrowRight", "ArrowLeft", "End", "ArrowRight", "Home", "ArrowLeft"):
        page.keyboard.press(key)
        seen.append(state(page, "step"))
    assert seen == ["1", "2", "1", "89", "89", "0", "0"]
    page.locator("#slider").focus()
    page.keyboard.press("ArrowRight")
    assert state(page, "step") == "1"
    page.locator("#forth").click()
    page.keyboard.press("ArrowRight")
    assert state(page, "step") == "3"


def test_it_plays_and_pauses(open_page: Any, pages: Path) -> None:
    page = open_page(pages / "eventful.html")
    page.locator("#speed").select_option("16")
    page.locator("h1").click()
    page.keyboard.press(" ")
    assert state(page, "playing") == "true"
    assert page.locator("#words").get_attribute("aria-live") == "off"
    until(lambda: int(state(page, "index")) > 3)
    page.locator("#play").click()
    assert state(page, "playing") == "false"
    assert page.locator("#words").get_attribute("aria-live") == "polite"
    page.locator("#slider").fill("87")
    page.keyboard.press(" ")
    until(lambda: state(page, "playing") == "false")
    assert state(page, "index") == "89"


def test_every_step_looks_the_same_from_both_sides(open_page: Any, pages: Path) -> None:
    page = open_page(pages / "eventful.html")
    different, wrong = page.evaluate("""() => {
        const slider = document.getElementById("slider"), parts = ["map", "maze", "belief", "policies", "window"];
        const drawn = (index) => {
          slider.value = index;
          slider.dispatchEvent(new Event("input"));
          return parts.map((id) => document.getElementById(id).innerHTML).join();
        };
        const all = [...Array(90).keys()], forth = all.map(drawn);
        const odd = [89, 61, 60, 59, 26, 25, 24, 3, 88, 0, 77].filter((index) => drawn(index) !== forth[index]);
        return [new Set(forth).size, odd];
    }""")
    assert different == 90
    assert wrong == []


def test_the_map_on_the_page_is_the_one_recorded(open_page: Any, pages: Path) -> None:
    page, kept = open_page(pages / "eventful.html"), eventful_walk()
    for index, picture in enumerate(kept.maps()):
        if index % 15 == 14:
            page.locator("#slider").fill(str(index))
            visited = sum(place[1] for place in picture.places)
            words = f"{len(picture.places)} places, {visited} visited."
            assert words in page.locator("#map-legend").text_content()
            drawn = sum(place[1] and place[0] is not None for place in picture.places)  # or nobody knows where it is
            assert page.locator("#map-svg .place:not(.hollow)").count() == drawn
            assert page.locator("#map-svg .hollow").count() == len(picture.places) - visited


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("name", ["tolman", "eventful"])
def test_it_fits_a_phone(open_page: Any, pages: Path, name: str, scheme: str) -> None:
    page = open_page(pages / f"{name}.html", viewport=PHONE, color_scheme=scheme)
    assert state(page, "theme") == scheme
    page.locator("summary").click()
    for index in (0, 12, 41, 80):
        page.locator("#slider").fill(str(index))
        assert page.evaluate("document.documentElement.scrollWidth") <= 360
    for box in [found.bounding_box() for found in page.locator("main svg, button, select, input").all()]:
        assert box is None or (box["x"] >= 0 and box["x"] + box["width"] <= 360.5)


def luminance(colour: str) -> float:
    parts = [int(x) / 255 for x in re.findall(r"\d+", colour)[:3]]
    red, green, blue = (x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4 for x in parts)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


TEXTS = """() => [...document.querySelectorAll("body *")].filter((node) =>
    [...node.childNodes].some((child) => child.nodeType === 3 && child.data.trim())
    && !node.closest("script, style, noscript, title, desc, option, svg")
    && node.getClientRects().length).map((node) => {
      let under = node;
      while (under && getComputedStyle(under).backgroundColor === "rgba(0, 0, 0, 0)") under = under.parentElement;
      const paper = getComputedStyle(under || document.body).backgroundColor;
      return [node.textContent.slice(0, 40), getComputedStyle(node).color, paper];
    })"""


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_texts_can_be_read(open_page: Any, pages: Path, scheme: str) -> None:
    page = open_page(pages / "eventful.html", color_scheme=scheme)
    page.locator("#slider").fill("41")
    page.locator("summary").click()
    for text, ink, paper in page.evaluate(TEXTS):
        darker, lighter = sorted((luminance(ink), luminance(paper)))
        assert (lighter + 0.05) / (darker + 0.05) >= 4.5, (text, ink, paper)


def test_the_theme_can_be_turned(open_page: Any, pages: Path) -> None:
    page = open_page(pages / "eventful.html", color_scheme="light")
    ground = "getComputedStyle(document.body).backgroundColor"
    light = page.evaluate(ground)
    page.locator("#theme").click()
    assert state(page, "theme") == "dark"
    assert page.locator("#theme").get_attribute("aria-pressed") == "true"
    assert page.evaluate(ground) != light


def test_pictures_and_controls_have_names(open_page: Any, pages: Path) -> None:
    page = open_page(pages / "eventful.html")
    page.locator("#slider").fill("30")
    for name in ("maze", "map", "times", "window"):
        svg = page.locator(f"#{name}-svg")
        assert svg.get_attribute("role") == "img"
        assert len(page.locator(f"#{name}-title").text_content()) > 5
        assert len(page.locator(f"#{name}-desc").text_content()) > 15
    for found in page.locator("button, select, input").all():
        named = (
            found.get_attribute("aria-label")
            or found.text_content()
            or found.evaluate("node => node.labels[0].textContent")
        )
        assert named.strip()
    assert page.locator("svg:not([role=img]):not([aria-hidden=true])").count() == 0


def test_tab_reaches_every_control_and_shows_it(open_page: Any, pages: Path) -> None:
    page = open_page(pages / "eventful.html")
    reached: set[str] = set()
    for _ in range(12):
        page.keyboard.press("Tab")
        outline = page.evaluate("getComputedStyle(document.activeElement).outlineStyle")
        reached.add(page.evaluate("document.activeElement.id || document.activeElement.tagName"))
        assert outline == "solid" or page.evaluate("document.activeElement === document.body")
    assert {"theme", "first", "back", "play", "forth", "last", "slider", "speed", "SUMMARY"} <= reached


def test_less_motion_is_respected(open_page: Any, pages: Path) -> None:
    moving = "document.getAnimations().length"
    page = open_page(pages / "tolman.html", reduced_motion="reduce")
    page.keyboard.press("ArrowRight")
    assert page.evaluate(moving) == 0
    page = open_page(pages / "tolman.html", reduced_motion="no-preference")
    page.keyboard.press("ArrowRight")
    assert page.evaluate(moving) > 0


def test_hostile_labels_do_nothing(open_page: Any, tmp_path: Path) -> None:
    labels = ["</script><script>alert(1)</script>", "<img src=x onerror=alert(1)>", "'\"`${1}", "a" * 300]
    agent = Agent(GRID, settings=Settings(look_ahead=2), seed=0)
    recorder = Recorder(row(*labels), title=labels[1], goals=labels)
    for i, label in enumerate(labels):
        agent.step({"sight": label, "open": [False, False, False, True, True]})
        recorder.add(agent, place=(0, i))
    path = tmp_path / "hostile.html"
    path.write_text(replay_html(recorder.recording()), encoding="utf-8")
    page = open_page(path, viewport=PHONE)
    for _ in labels:
        page.keyboard.press("ArrowRight")
        assert page.evaluate("document.documentElement.scrollWidth") <= 360
    assert state(page, "step") == "3"
    assert page.locator("img").count() == 0
    assert page.locator("h1").text_content() == labels[1]


def test_walks_without_truth_or_in_one_dimension(open_page: Any, tmp_path: Path) -> None:
    agent = Agent({"left": (-1,), "right": (1,), "stay": (0,)}, settings=Settings(look_ahead=2), seed=0)
    recorder = Recorder()
    agent.step({"sight": 0, "open": [False, True, True]})
    recorder.add(agent)
    path = tmp_path / "line.html"
    path.write_text(replay_html(recorder.recording()), encoding="utf-8")
    page = open_page(path)
    assert page.locator("#maze").count() == 0
    assert page.locator("#map-svg .place").count() == 2
    assert state(page, "step") == "0"


def test_a_walk_on_a_graph(open_page: Any, tmp_path: Path) -> None:
    chart, recorder = torus(4), Recorder(torus(4), goals=[5])
    agent, place = Agent(GRID, settings=Settings(look_ahead=2), seed=0), (0, 0)
    for _ in range(12):
        action = agent.step({"sight": chart.sights[place], "open": [True] * 5})
        recorder.add(agent, place=place, closed_rooms=[(2, 2)], closed_doors=[((1, 0), (1, 3))])
        place = {**chart.successors(place), "stay": place}[list(GRID)[action]]
    path = tmp_path / "torus.html"
    path.write_text(replay_html(recorder.recording()), encoding="utf-8")
    page = open_page(path, viewport=PHONE)
    assert page.locator("#maze-panel h2").text_content() == "The world, as it is"
    assert page.locator("#maze-svg .place").count() == 16
    assert page.locator("#maze-svg .world-way").count() == 32
    page.keyboard.press("End")
    assert room(page) != "(0, 0)"
    assert page.locator("#maze-svg .trail").count() >= 11
    assert page.evaluate("document.documentElement.scrollWidth") <= 360


def test_labels_of_any_script_fit_their_places(open_page: Any, tmp_path: Path) -> None:
    labels = ["日本語の部屋", "قاعة الاستقبال", "WWWWWW", "ⵣⴰⵡⴰⵢⵜ", "🏠🏡🏘🏚🛖⛺", "x" * 300]
    agent, recorder = Agent(GRID, settings=Settings(look_ahead=1), seed=0), Recorder(row(*labels))
    for i, label in enumerate(labels):
        agent.step({"sight": label, "open": [False, False, i > 0, i < len(labels) - 1, True]})
        recorder.add(agent, place=(0, i))
    path = tmp_path / "scripts.html"
    path.write_text(replay_html(recorder.recording()), encoding="utf-8")
    page = open_page(path)
    page.keyboard.press("End")
    for texts, shapes in (("#window .variable", "circle, rect"), ("#map g:has(> .place:not(.hollow))", ".place")):
        for found in page.locator(texts).all():
            outer = found.locator(shapes).first.bounding_box()
            for text in found.locator("text:not(.tag):not(.variable-odds)").all():
                inner = text.bounding_box()
                assert inner["width"] <= outer["width"], text.text_content()
