"""The study `goals`: with a map and without, beside the shortest path."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from cogmap.agent import Settings
from cogmap.experiments import NavigateRun, navigate, workers
from cogmap.experiments.studies import run_study, study_named
from cogmap.worlds import MAZES

STUDY = study_named("goals")


ALIASED = {"3x3_alias", "4x4_alias", "t_maze_alias", "donut", "tolman"}


@cache
def rows() -> list[Any]:
    return STUDY.rows(1, seed=5)


def failing() -> list[Any]:
    row = type(rows()[0])
    return [
        row("3x3", False, 8, True, NavigateRun(0, (0, 0), True, 6, 4, (0, 1), 9, None, 4)),
        row("3x3", False, 8, True, NavigateRun(1, (0, 0), False, None, 2, (0, 1), 9)),
        row("3x3", False, 8, True, NavigateRun(2, None, False, None, None, (0, 1))),
        row("3x3", False, 8, False, NavigateRun(0, (0, 0), False, None, 4, None, None, 7, 5)),
    ]


def test_every_maze_with_a_map_and_without() -> None:
    assert [(row.world, row.known, row.run.seed) for row in rows()] == [
        (world, known, 5) for world in MAZES for known in (True, False)
    ]
    assert {row.world for row in rows() if row.aliased} == ALIASED
    for row in rows():
        assert row.run.reached
        assert row.run.steps >= row.run.steps_to_stand >= row.run.shortest
        assert (row.run.steps_to_stand == 0) == (row.run.shortest == 0)
        assert (row.run.frontier_steps is None) is row.known
        assert (row.run.explored_from is None) is not row.known


def test_a_run_is_that_of_navigate() -> None:
    row = next(row for row in rows() if row.world == "donut" and not row.known)
    assert row.run == navigate(MAZES["donut"], 5, goal=row.goal, known=False)


def test_the_same_on_two_processes() -> None:
    done: list[None] = []
    with workers(jobs=2) as executor:
        two = STUDY.rows(1, seed=5, executor=executor, on_done=lambda: done.append(None))
    assert len(done) == 16
    assert two == rows()


def test_settings_reach_the_agents() -> None:
    short = STUDY.rows(1, seed=5, settings=Settings(look_ahead=1))
    assert [row.run.steps for row in short] != [row.run.steps for row in rows()]


def test_failures_are_counted_and_shown() -> None:
    found = STUDY.summarise(failing())
    part = next(part for part in found.json["summary"] if part["world"] == "3x3" and part["known"])
    assert (part["runs"], part["failed"]) == (3, 2)
    assert (part["steps"].value, part["steps"].count, part["ratio"].value) == (6.0, 1, 1.5)
    assert any(line.split()[:2] == ["3x3", "1/3"] for line in found.lines)
    assert found.lines[-3:] == [
        "failed: 3x3, with a map, goal 8, seed 1",
        "failed: 3x3, with a map, goal 8, seed 2",
        "failed: 3x3, unknown, goal 8, seed 0",
    ]
    assert found.failed[-1] == "3x3, without a map, goal 8, seed 0: not reached"
    for draw in found.figures.values():
        texts = {text.get_text() for ax in draw().axes for text in ax.texts}
        assert texts & {"2 of 3 failed", "1 of 1 failed"}


def test_what_is_left(tmp_path: Path) -> None:
    lines = run_study(STUDY, tmp_path, runs=1, seed=5).lines
    words = [line.split()[0] for line in lines]
    assert all(words.count(world) == 2 for world in MAZES)
    assert "failed:" not in words
    report = json.loads((tmp_path / "goals.json").read_text())
    assert [row["seed"] for row in report["runs"]] == [5] * 16
    assert [row["runs"] for row in report["summary"]] == [1] * 16
    own = {name: report["settings"][name] for name in Settings().to_dict()}  # the others name the agent's parts
    assert (report["weight"], Settings.from_dict(own)) == (8.0, Settings())
    assert (report["settings"]["growth"], report["settings"]["policies"]) == ("predicted", "map_guided")


def test_bars_are_the_means() -> None:
    found = STUDY.summarise(rows())
    known, unknown = found.figures["goals_by_world"]().axes
    heights = [bar.get_height() for bar in known.containers[0]]
    assert heights == [part["steps"].value for part in found.json["summary"] if part["known"]]
    assert [label.get_text() for label in unknown.get_xticklabels()] == list(MAZES)


def test_every_distance_has_a_bar_that_is_seen() -> None:
    ax = STUDY.summarise(rows()).figures["goals_by_distance"]().axes[0]
    means: dict[tuple[int, bool], list[int]] = {}
    for row in rows():
        if row.known:
            means.setdefault((min(row.run.shortest, 7), row.aliased), []).append(row.run.steps)
    tops = sorted(bar.get_height() for bars in ax.containers for bar in getattr(bars, "patches", ()))
    both = {5: 5, 6: 5}  # shown together
    joined: dict[tuple[int, bool], list[int]] = {}
    for (length, aliased), steps in means.items():
        joined.setdefault((both.get(length, length), aliased), []).extend(steps)
    expected = sorted(sum(steps) / len(steps) for (length, _), steps in joined.items() if length)
    assert [top for top in tops if top] == pytest.approx(expected)
    assert ax.get_ylim()[1] > max(tops)
