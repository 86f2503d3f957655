from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from cogmap.experiments.studies.localisation import (
    FOOT,
    GOAL,
    MAZE,
    LocalisationResult,
    by_step,
    localisation_lines,
    localisation_study,
)
from cogmap.experiments.studies.localisation_figures import localisation_figures
from cogmap.experiments.studies.localisation_rows import CONDITIONS, LocalisationTrial
from cogmap.model import CogmapError

STEM = [(1, 2), (2, 2), FOOT]


@pytest.fixture(scope="module")
def result() -> LocalisationResult:
    return localisation_study(agents=3, seed=2)


def only(result: LocalisationResult, condition: str, agent: int) -> LocalisationTrial:
    return result.trials(condition)[agent]


@pytest.mark.parametrize("agent", range(3))
def test_told_and_by_sights_alone_it_is_split_over_the_rooms_that_look_alike(
    result: LocalisationResult, agent: int
) -> None:
    trial = only(result, "told_sights", agent)
    first = {room: q for _, room, q in trial.steps[0].posterior if q > 0.01}
    assert first == pytest.approx(dict.fromkeys(STEM, 1 / 3), abs=1e-3)
    entropies = [step.entropy for step in trial.steps[:3]]
    assert entropies == pytest.approx([np.log(3), np.log(2), 0.0], abs=5e-3)
    assert [step.candidates for step in trial.steps[:3]] == [3, 2, 1]
    assert (trial.first, trial.steps_to_localise, trial.reached) == ("split", 2, True)


@pytest.mark.parametrize("agent", range(3))
def test_told_and_with_doors_it_knows_the_foot_at_once(result: LocalisationResult, agent: int) -> None:
    trial = only(result, "told_doors", agent)
    assert (trial.first, trial.steps_to_localise, trial.steps_certain_but_wrong) == ("right", 0, 0)
    assert trial.map_intact


def test_not_told_it_depends_on_where_it_expected_to_be(result: LocalisationResult) -> None:
    lookalikes = [room for room in STEM if room != FOOT]
    assert {row.expected in lookalikes for row in result.rows} == {True, False}  # or choose other seeds
    for number, row in enumerate(result.rows):
        doors, sights = (only(result, condition, number) for condition in ("silent_doors", "silent_sights"))
        assert doors.steps_certain_but_wrong == 0
        if row.expected in lookalikes:  # nothing contradicts it yet
            assert sights.first == "wrong"
            assert sights.steps_certain_but_wrong > 0
            assert max(sights.steps[0].posterior, key=lambda part: part[2])[1] == row.expected
        elif row.expected != FOOT:
            assert (doors.first, sights.first) == ("right", "split")


def test_every_step_is_told_in_full(result: LocalisationResult) -> None:
    for row in result.rows:
        for trial in row.trials:
            assert trial.steps[0].room == FOOT
            assert MAZE.sights[trial.steps[-1].room] == GOAL
            for step in trial.steps:
                assert [room for _, room, _ in step.posterior] == list(MAZE.rooms)
                assert sum(q for _, _, q in step.posterior) == pytest.approx(1.0)
                assert sum(step.first_action.values()) == pytest.approx(1.0)
                assert sum(path.probability for path in step.paths) == pytest.approx(1.0, abs=0.05)


def test_as_json(result: LocalisationResult) -> None:
    saved = json.loads(json.dumps(result.to_dict(), allow_nan=False))
    assert set(saved["protocol"]["conditions"]) == {condition.name for condition in CONDITIONS}
    part = saved["summary"]["conditions"]["told_sights"]
    assert (part["trials"], part["split"], part["localised"], part["reached"]) == (3, 3, 3, 3)
    assert part["mean_steps_to_localise"] == 2.0
    assert part["entropy_by_step"][0]["value"] == pytest.approx(np.log(3), abs=5e-3)
    trial = saved["rows"][0]["trials"][0]
    assert trial["moves"] == len(trial["steps"]) - 1 == saved["summary"]["shortest"] == 5


def test_who_is_done_keeps_the_last_value(result: LocalisationResult) -> None:
    long = only(result, "told_sights", 0)
    short = replace(long, steps=long.steps[:1])
    means = [interval.value for interval in by_step([long, short], "candidates")]
    assert means == pytest.approx([3.0, 2.5, 2.0, 2.0, 2.0, 2.0])
    assert by_step([], "entropy") == []


def test_agents_are_repeated_by_their_seed(result: LocalisationResult) -> None:
    again = localisation_study(agents=1, seed=4)
    assert again.rows == result.rows[2:]


def test_lines(result: LocalisationResult) -> None:
    lines = localisation_lines(result)
    assert lines[0].startswith("3 of 3 agents explored t_maze_alias; moved to (3, 2)")
    paper = lines[lines.index("told, sights alone (the paper):") + 1 :]
    assert paper[0] == "  after the first sight 3 split, 0 right, 0 wrong; 3.0 rooms to choose from (mean)"
    assert paper[1].startswith("  certain of the right room after 2.0 ± 0.0 steps (3/3)")


def test_figures_show_all_and_clip_nothing(result: LocalisationResult) -> None:
    figures = localisation_figures(result)
    assert set(figures) == {"localisation_told_sights", "localisation_silent_doors", "localisation_by_step"}
    for figure in figures.values():
        figure.draw_without_rendering()
        box = figure.get_tightbbox()
        assert box.x0 >= 0.0
        assert box.y0 >= 0.0
        assert box.x1 <= figure.get_figwidth()
        assert box.y1 <= figure.get_figheight()


def test_who_has_not_explored_is_not_moved(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cogmap.experiments.session.default_steps", lambda maze: 1)
    result = localisation_study(agents=1)
    assert result.rows[0].trials == ()
    assert json.loads(json.dumps(result.to_dict(), allow_nan=False))["summary"]["explored"] == 0
    assert "0/0" in " ".join(localisation_lines(result))
    assert localisation_figures(result) == {}


@pytest.mark.parametrize(("given", "message"), [({"agents": 0}, "use 1 or more"), ({"seed": -1}, "seed is -1")])
def test_bad_input(given: dict[str, int], message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        localisation_study(**{"agents": 1, **given})
