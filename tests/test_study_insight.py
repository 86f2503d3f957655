"""The study `insight`, and its control that learns by reward."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from cogmap.baselines import HabitAgent
from cogmap.experiments import workers
from cogmap.experiments.studies import run_study, study_named
from cogmap.worlds import GRID, MAZES, Maze, MazeEnv, Position, WorldError, shortest_path

UP, DOWN, LEFT, RIGHT, STAY = range(5)
MAZE = MAZES["tolman"]
START, FORK, A, B = (6, 2), (3, 2), (4, 2), (2, 2)
TO_FORK = shortest_path(MAZE, START, FORK)
BACK = TO_FORK[::-1][1:]
TO_FORK_BY_2 = shortest_path(MAZE, START, FORK, closed=[A])
BY_3 = shortest_path(MAZE, START, (0, 2), closed=[B])
STUDY = study_named("insight")


@pytest.fixture(scope="module")
def rows() -> list[Any]:
    return STUDY.rows(1)


@pytest.fixture
def made(rows: list[Any]) -> Any:
    """Makes a row of paths with B closed, as if somebody had walked them."""
    row = rows[0][0]

    def make(*paths: Sequence[Position]) -> Any:
        runs = [type(row.probe[0]).of(path, None, B) for path in paths]
        return type(row).of(0, runs, runs)

    return make


def test_agents_and_controls_are_trained_in_the_open_and_tested_with_b_closed(rows: list[Any]) -> None:
    for one in rows[0]:
        assert len(one.training) == 12
        assert any(B in run.path for run in one.training)
        assert all(B not in run.path for run in one.probe)
        assert 1 <= len(one.probe) <= 60


def test_the_control_reaches_the_goal_by_habit_but_does_not_know_the_way_round(rows: list[Any]) -> None:
    agent, control = rows[0]
    assert sum(run.route == 1 for run in control.training) >= 9
    assert control.choice.route == 2
    assert agent.steps_to_goal is not None
    assert control.steps_to_goal is None or control.steps_to_goal > 3 * agent.steps_to_goal


def test_what_is_tried_after_the_block(made: Any) -> None:
    round_by_3 = made([*TO_FORK, *BACK, *BY_3[1:]]).choice
    assert (round_by_3.met_by, round_by_3.route, round_by_3.at_fork, round_by_3.again) == (1, 3, False, 0)
    assert round_by_3.steps == len(BACK) + 1
    left = made([*TO_FORK, (3, 1)]).choice
    assert (left.route, left.at_fork, left.steps) == (2, True, 1)
    assert made(BY_3).choice is None  # never met
    assert made(TO_FORK).choice is None  # nothing tried


def test_going_back_the_way_it_came_is_not_trying_it_again(made: Any) -> None:
    choice = made([*TO_FORK_BY_2, (3, 1)], TO_FORK, BY_3).choice
    assert (choice.met_by, choice.route, choice.again) == (2, 3, 1)


def test_who_meets_nothing_counts_against(made: Any) -> None:
    round_by_3, left, never = made([*TO_FORK, *BACK, (6, 3)]), made([*TO_FORK, (3, 1)]), made([START, START])
    found = STUDY.summarise([(round_by_3, left), (left, left), (never, left)])
    share = found.json["summary"]["agents"]["route_3_first"]
    assert (share.count, share.of) == (1, 3)
    assert "1 of 3 agents never met the block (seeds 0)" in found.failed
    both = STUDY.summarise([(round_by_3, left)] * 9)
    assert both.json["summary"]["p_value"] == pytest.approx(1 / 48620)  # one table of C(18, 9)
    assert STUDY.summarise([(left, left)]).json["summary"]["p_value"] == pytest.approx(1.0)
    assert STUDY.summarise([(never, never)]).figures["insight_choice"]()


def test_what_is_left(tmp_path: Path) -> None:
    outcome = run_study(STUDY, tmp_path, runs=1)
    report = json.loads((tmp_path / "insight.json").read_text())
    assert report["summary"]["rats"]["route_3_first"]["count"] == 9
    assert len(report["rows"]) == len(report["controls"]) == 1
    assert len(outcome.lines) == 6
    assert (tmp_path / "insight_choice.png").is_file()


@pytest.mark.study
@pytest.mark.parametrize("seed", [0, 100])
def test_nine_of_ten_try_route_3_first_and_habit_does_not(seed: int, study: bool) -> None:
    if not study and seed:
        pytest.skip("one seed in the small form")
    with workers(jobs=2) as executor:
        rows = STUDY.rows(40 if study else 2, seed=seed, executor=executor)
    summary = STUDY.summarise(rows).json["summary"]
    assert summary["agents"]["route_3_first"].share >= 0.9
    assert summary["controls"]["route_3_first"].share <= 0.1
    assert all(sum(run.reached_at is not None for run in control.training) >= 9 for _, control in rows)


# -- habit alone -------------------------------------------------------------------------------------------


def corridor() -> MazeEnv:
    world = MazeEnv(Maze("corridor", {(0, 0): 1, (0, 1): 2, (0, 2): 3, (0, 3): 0}))
    world.reset(options={"start": (0, 0)})
    return world


def seen(sight: int, *open_: int) -> dict[str, Any]:
    return {"sight": sight, "open": [action in open_ or action == STAY for action in range(5)]}


def test_habit_learns_what_each_place_pays() -> None:
    world, habit = corridor(), HabitAgent(GRID, goal=0, explore=1.0, seed=0)
    for _ in range(4000):
        world.step(habit.step(world.observe()))
    for column in range(3):
        assert habit.value((0, column), RIGHT) == pytest.approx(0.9 ** (3 - column), rel=1e-3)
    assert habit.value((0, 3), STAY) == pytest.approx(1.0)
    assert habit.value((0, 3), LEFT) == pytest.approx(0.9**2, rel=1e-3)
    habit.explore = 0.0
    habit.restart()
    world.displace((0, 0))
    path = []
    for _ in range(5):
        path.append(world.position)
        world.step(habit.step(world.observe()))
    assert path == [(0, 0), (0, 1), (0, 2), (0, 3), (0, 3)]


def test_habit_learns_one_error_at_a_time() -> None:
    habit = HabitAgent(GRID, goal=0, rate=0.5, explore=0.0, seed=0)
    habit.step(seen(0))  # nothing but staying is open
    assert habit.value((0, 0), STAY) == 0.0
    habit.step(seen(0))
    assert habit.value((0, 0), STAY) == 0.5
    habit.step(seen(0))
    assert habit.value((0, 0), STAY) == 0.75


def test_habit_does_not_learn_from_being_put_back() -> None:
    habit = HabitAgent(GRID, goal=0, explore=0.0, seed=0)
    habit.step(seen(0))
    habit.restart()
    habit.step(seen(7))
    assert habit.value((0, 0), STAY) == 0.0


def test_habit_tries_no_shut_door_and_repeats_with_its_seed() -> None:
    first, second = (HabitAgent(GRID, goal=0, explore=1.0, seed=3) for _ in range(2))
    walks = [[habit.step(seen(5, UP, DOWN)) for _ in range(50)] for habit in (first, second)]
    assert walks[0] == walks[1]
    assert set(walks[0]) == {UP, DOWN, STAY}


@pytest.mark.parametrize("observation", [{}, {"sight": 1, "open": [True]}])
def test_habit_refuses_what_is_no_observation(observation: dict[str, Any]) -> None:
    with pytest.raises(WorldError):
        HabitAgent(GRID, goal=0).step(observation)
