"""The study `localisation`: told or not, with doors or without."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cogmap.experiments.studies import run_study, study_named
from cogmap.worlds import MAZES

MAZE = MAZES["t_maze_alias"]
FOOT = (3, 2)
STEM = [(1, 2), (2, 2), FOOT]
STUDY = study_named("localisation")


@pytest.fixture(scope="module")
def rows() -> list[Any]:
    return STUDY.rows(3, seed=2)


def trial(rows: list[Any], condition: str, agent: int) -> Any:
    return next(one for one in rows[agent].trials if one.condition == condition)


@pytest.mark.parametrize("agent", range(3))
def test_told_and_by_sights_alone_it_is_split_over_the_rooms_that_look_alike(rows: list[Any], agent: int) -> None:
    found = trial(rows, "told_sights", agent)
    first = {held.room: held.probability for held in found.steps[0].posterior if held.probability > 0.01}
    assert first == pytest.approx(dict.fromkeys(STEM, 1 / 3), abs=1e-3)
    entropies = [step.entropy for step in found.steps[:3]]
    assert entropies == pytest.approx([np.log(3), np.log(2), 0.0], abs=5e-3)
    assert [step.candidates for step in found.steps[:3]] == [3, 2, 1]
    assert (found.first, found.steps_to_localise, found.reached, found.moves) == ("split", 2, True, 5)


@pytest.mark.parametrize("agent", range(3))
def test_told_and_with_doors_it_knows_the_foot_at_once(rows: list[Any], agent: int) -> None:
    found = trial(rows, "told_doors", agent)
    assert (found.first, found.steps_to_localise, found.steps_certain_but_wrong) == ("right", 0, 0)
    assert found.map_intact


def test_not_told_it_depends_on_where_it_expected_to_be(rows: list[Any]) -> None:
    lookalikes = [room for room in STEM if room != FOOT]
    assert {row.expected in lookalikes for row in rows} == {True, False}  # or choose other seeds
    for number, row in enumerate(rows):
        doors, sights = (trial(rows, condition, number) for condition in ("silent_doors", "silent_sights"))
        assert doors.steps_certain_but_wrong == 0
        if row.expected in lookalikes:  # nothing contradicts it yet
            assert sights.first == "wrong"
            assert sights.steps_certain_but_wrong > 0
            assert max(sights.steps[0].posterior, key=lambda held: held.probability).room == row.expected
        elif row.expected != FOOT:
            assert (doors.first, sights.first) == ("right", "split")


def test_every_step_is_told_in_full(rows: list[Any]) -> None:
    for row in rows:
        assert len(row.trials) == 4
        for one in row.trials:
            assert one.steps[0].room == FOOT
            assert MAZE.sights[one.steps[-1].room] == 0
            for step in one.steps:
                assert [held.room for held in step.posterior] == list(MAZE.rooms)
                assert sum(held.probability for held in step.posterior) == pytest.approx(1.0)
                assert sum(step.first_action.values()) == pytest.approx(1.0)
                begun: dict[Any, float] = dict.fromkeys(MAZE.rooms, 0.0)
                for path in step.paths:
                    begun[path.rooms[0]] += path.probability
                assert begun == pytest.approx({held.room: held.probability for held in step.posterior}, abs=0.05)


def test_agents_are_repeated_by_their_seed(rows: list[Any]) -> None:
    assert STUDY.rows(1, seed=4) == rows[2:]


def test_who_is_done_keeps_the_last_value(rows: list[Any]) -> None:
    long = trial(rows, "told_sights", 0)
    short = replace(long, steps=long.steps[:1])
    found = STUDY.summarise([replace(rows[0], trials=(long,)), replace(rows[1], trials=(short,))])
    means = [mean.value for mean in found.json["summary"]["conditions"]["told_sights"]["candidates_by_step"]]
    assert means == pytest.approx([3.0, 2.5, 2.0, 2.0, 2.0, 2.0])


def test_what_is_left(tmp_path: Path) -> None:
    outcome = run_study(STUDY, tmp_path, runs=1, seed=2)
    assert outcome.lines[0].startswith("1 of 1 agents explored t_maze_alias; moved to (3, 2)")
    paper = outcome.lines[outcome.lines.index("told, sights alone (the paper):") + 1 :]
    assert paper[0] == "  after the first sight 1 split, 0 right, 0 wrong; 3.0 rooms to choose from (mean)"
    assert paper[1].startswith("  certain of the right room after 2.0 ± 0.0 steps (1/1)")
    report = json.loads((tmp_path / "localisation.json").read_text())
    part = report["summary"]["conditions"]["told_sights"]
    assert (part["trials"], part["split"], part["localised"], part["reached"]) == (1, 1, 1, 1)
    assert part["entropy_by_step"][0]["value"] == pytest.approx(np.log(3), abs=5e-3)
    assert set(report["protocol"]["conditions"]) == set(report["summary"]["conditions"])
    assert {path.stem for path in tmp_path.glob("*.png")} == {
        "localisation_told_sights",
        "localisation_silent_doors",
        "localisation_by_step",
    }


def test_failures_are_named_and_who_has_not_explored_is_not_moved(rows: list[Any]) -> None:
    lost = replace(rows[0], steps_to_explore=None, trials=())
    found = STUDY.summarise([lost])
    assert found.failed == ["1 of 1 did not explore the maze (seeds 2)"]
    assert "0/0" in " ".join(found.lines)
    assert found.figures == {}
    bad = replace(trial(rows, "told_doors", 0), reached=False, map_intact=False)
    assert STUDY.summarise([replace(rows[0], trials=(bad,))]).failed == [
        "told_doors: reached 0 of 1",
        "told_doors: map intact 0 of 1",
    ]


def test_figures_show_all_and_clip_nothing(rows: list[Any]) -> None:
    for draw in STUDY.summarise(rows).figures.values():
        figure = draw()
        figure.draw_without_rendering()
        box = figure.get_tightbbox()
        assert min(box.x0, box.y0) >= 0.0
        assert box.x1 <= figure.get_figwidth()
        assert box.y1 <= figure.get_figheight()
