from __future__ import annotations

import json
from functools import cache

import numpy as np
import pytest
from cogmap.agent import Settings
from cogmap.experiments import NavigateRun, navigate, workers
from cogmap.experiments.studies.goals import (
    GoalRun,
    GoalsResult,
    draw_goal,
    goals_lines,
    goals_study,
    goals_tasks,
)
from cogmap.experiments.studies.goals_figures import DISTANCES, goals_figures
from cogmap.experiments.studies.goals_summary import summarise_goals
from cogmap.experiments.studies.intervals import bootstrap
from cogmap.model import CogmapError
from cogmap.worlds import MAZES

ALIASED = {"3x3_alias", "4x4_alias", "t_maze_alias", "donut", "tolman"}


@cache
def result(agents: int = 2, seed: int = 5) -> GoalsResult:
    return goals_study(agents=agents, seed=seed)


def failing() -> GoalsResult:
    runs = (
        GoalRun("3x3", False, 8, True, NavigateRun(0, (0, 0), True, 6, 4, (0, 1), 9, None, 4)),
        GoalRun("3x3", False, 8, True, NavigateRun(1, (0, 0), False, None, 2, (0, 1), 9)),
        GoalRun("3x3", False, 8, True, NavigateRun(2, None, False, None, None, (0, 1))),
        GoalRun("3x3", False, 8, False, NavigateRun(0, (0, 0), False, None, 4, None, None, 7, 5)),
    )
    return GoalsResult(3, 0, 3.0, Settings(), runs)


def test_every_maze_with_a_map_and_without() -> None:
    rows = result().runs
    assert len(rows) == goals_tasks(2) == 32
    assert [(row.world, row.known, row.run.seed) for row in rows] == [
        (world, known, seed) for world in MAZES for known in (True, False) for seed in (5, 6)
    ]
    assert {row.world for row in rows if row.aliased} == ALIASED
    for row in rows:
        assert row.run.reached
        assert row.goal == draw_goal(MAZES[row.world], row.run.seed)
        assert row.run.steps is not None
        assert row.run.steps_to_stand is not None
        assert row.run.shortest is not None
        assert row.run.steps >= row.run.steps_to_stand >= row.run.shortest
        assert (row.run.frontier_steps is None) is row.known
        assert (row.run.explored_from is None) is not row.known


def test_a_run_is_that_of_navigate() -> None:
    row = next(row for row in result().runs if row.world == "donut" and not row.known)
    assert row.run == navigate(MAZES["donut"], goal=row.goal, known=False, seed=5)


def test_goals_are_drawn_from_all_labels() -> None:
    for maze in MAZES.values():
        goals = {draw_goal(maze, seed) for seed in range(200)}
        assert goals == set(maze.sights.values())


def test_the_step_of_standing_there_first() -> None:
    passed = [row.run for row in goals_study(agents=3, seed=0).runs if not row.known]
    assert any(run.steps_to_stand == 0 for run in passed if run.shortest == 0)
    assert all((run.steps_to_stand == 0) == (run.shortest == 0) for run in passed)


def test_the_study_is_plain_json_and_the_same_on_two_processes() -> None:
    done: list[None] = []
    with workers(jobs=2) as executor:
        two = goals_study(agents=1, seed=5, executor=executor, on_done=lambda: done.append(None))
    assert len(done) == goals_tasks(1)
    assert two.runs == tuple(row for row in result().runs if row.run.seed == 5)
    plain = json.loads(json.dumps(two.to_dict(), allow_nan=False))
    assert [row["seed"] for row in plain["runs"]] == [5] * 16
    assert [row["runs"] for row in plain["summary"]] == [1] * 16
    assert Settings.from_dict(plain["settings"]) == Settings()


def test_settings_reach_the_agents() -> None:
    short = goals_study(agents=1, seed=5, settings=Settings(look_ahead=1))
    assert short.settings.look_ahead == 1
    assert [row.run.steps for row in short.runs] != [row.run.steps for row in result().runs if row.run.seed == 5]


def test_failures_are_counted_and_shown() -> None:
    summary = failing().select(known=True)
    assert (summary.runs, summary.failed) == (3, 2)
    assert summary.steps is not None
    assert summary.ratio is not None
    assert (summary.steps.value, summary.steps.count, summary.ratio.value) == (6.0, 1, 1.5)
    near = failing().select(known=True, between=(2, 2))
    assert (near.runs, near.failed, near.steps) == (1, 1, None)
    lines = goals_lines(failing())
    assert any(line.split()[:2] == ["3x3", "1/3"] for line in lines)
    assert lines[-3:] == [
        "failed: 3x3, with a map, goal 8, seed 1",
        "failed: 3x3, with a map, goal 8, seed 2",
        "failed: 3x3, unknown, goal 8, seed 0",
    ]
    for figure in goals_figures(failing()).values():
        texts = {text.get_text() for ax in figure.axes for text in ax.texts}
        assert texts & {"2 of 3 failed", "1 of 1 failed"}


def test_lines_name_every_maze_twice() -> None:
    words = [line.split()[0] for line in goals_lines(result())]
    assert all(words.count(world) == 2 for world in MAZES)
    assert not any(line.startswith("failed") for line in goals_lines(result()))


def test_bars_are_the_means() -> None:
    figures = goals_figures(result())
    assert list(figures) == ["goals_by_distance", "goals_by_world"]
    known, unknown = figures["goals_by_world"].axes
    heights = [bar.get_height() for bar in known.containers[0]]  # pyright: ignore[reportAttributeAccessIssue]
    means = [result().select(known=True, world=world).steps for world in MAZES]
    assert heights == [mean.value for mean in means if mean is not None]
    assert [label.get_text() for label in unknown.get_xticklabels()] == list(MAZES)


def test_every_distance_is_in_one_bin() -> None:
    for distance in range(100):
        assert sum(least <= distance <= most for least, most in DISTANCES) == 1
    for known in (True, False):
        parts = [result().select(known=known, between=between).runs for between in DISTANCES]
        assert sum(parts) == result().select(known=known).runs == 16


def test_bootstrap_intervals() -> None:
    rng = np.random.default_rng(0)
    values = rng.normal(3.0, 1.0, 400)
    mean = bootstrap(values.tolist())
    assert mean is not None
    assert mean.value == pytest.approx(values.mean())
    assert mean.high - mean.low == pytest.approx(2 * 1.96 * values.std() / 20, rel=0.1)  # normal approximation
    assert mean.low < mean.value < mean.high
    same = bootstrap([2, 4, 6], [1, 2, 3])
    assert same is not None
    assert (same.value, same.low, same.high, same.count) == (2.0, 2.0, 2.0, 3)
    assert bootstrap([]) is None
    assert bootstrap([1, 2], [0, 0]) is None
    some = bootstrap([0, 2], [0, 1])  # a resample of the first alone has no ratio
    assert some is not None
    assert (some.value, some.low, some.high) == (2.0, 2.0, 2.0)
    assert summarise_goals([]).steps is None


def test_bad_input() -> None:
    for bad, message in (
        (lambda: goals_study(agents=0), "goals: agents is 0"),
        (lambda: goals_study(agents=1, seed=-1), "goals: seed is -1"),
    ):
        with pytest.raises(CogmapError, match=message):
            bad()
