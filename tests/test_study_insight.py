from __future__ import annotations

import json
from typing import Any

import pytest
from cogmap.baselines.habit import HabitAgent
from cogmap.experiments import workers
from cogmap.experiments.studies.insight import MOST, insight_lines, insight_study
from cogmap.experiments.studies.insight_figures import insight_figures
from cogmap.experiments.studies.insight_rows import RATS, InsightResult, InsightRow, route_3_first
from cogmap.experiments.studies.tolman_maze import FORK, MAZE, RUNS, START, B, TolmanRun
from cogmap.model import CogmapError
from cogmap.worlds import GRID, Maze, MazeEnv, WorldError, shortest_path

UP, DOWN, LEFT, RIGHT, STAY = range(5)
TO_FORK = shortest_path(MAZE, START, FORK)


@pytest.fixture(scope="module")
def result() -> InsightResult:
    return insight_study(agents=1)


def row(*paths: list[tuple[int, int]]) -> InsightRow:
    runs = tuple(TolmanRun(B, tuple(path), None) for path in paths)
    return InsightRow(0, runs, runs)


def test_agents_and_controls_are_trained_in_the_open_and_tested_with_b_closed(result: InsightResult) -> None:
    for one in (*result.agents, *result.controls):
        assert [run.closed for run in one.training] == [None] * RUNS
        assert {run.closed for run in one.probe} == {B}
        assert 1 <= len(one.probe) <= MOST


def test_the_control_reaches_the_goal_by_habit_but_does_not_know_the_way_round(result: InsightResult) -> None:
    (control,) = result.controls
    assert sum(run.route == 1 for run in control.training) >= 9
    assert control.choice is not None
    assert control.choice.route == 2
    agent = result.agents[0]
    assert agent.steps_to_goal is not None
    assert control.steps_to_goal is None or control.steps_to_goal > 3 * agent.steps_to_goal


def test_who_meets_nothing_counts_against(result: InsightResult) -> None:
    round_by_3 = row([*TO_FORK, *TO_FORK[::-1][1:], (6, 3)])
    left = row([*TO_FORK, (3, 1)])
    never = row([START, START])
    share = route_3_first([round_by_3, left, never])
    assert (share.count, share.of) == (1, 3)
    both = InsightResult((round_by_3,) * 9, (left,) * 9)
    assert both.p_value == pytest.approx(1 / 48620)  # one table of C(18, 9)
    assert InsightResult((left,), (left,)).p_value == pytest.approx(1.0)
    assert insight_figures(InsightResult((never,), (never,)))


def test_json_lines_and_figures(result: InsightResult) -> None:
    report = result.to_dict()
    assert json.loads(json.dumps(report, allow_nan=False)) == report
    assert report["summary"]["rats"]["route_3_first"]["count"] == RATS.count == 9
    assert len(insight_lines(result)) == 6
    assert set(insight_figures(result)) == {"insight_choice"}


@pytest.mark.parametrize("wrong", [{"agents": 0}, {"agents": 1, "runs": 0}, {"agents": 1, "seed": -1}])
def test_bad_numbers_are_refused_in_one_line(wrong: dict[str, int]) -> None:
    with pytest.raises(CogmapError) as error:
        insight_study(**wrong)
    assert "\n" not in str(error.value)


@pytest.mark.study
@pytest.mark.parametrize("seed", [0, 100])
def test_nine_of_ten_try_route_3_first_and_habit_does_not(seed: int, study: bool) -> None:
    if not study and seed:
        pytest.skip("one seed in the small form")
    with workers(jobs=2) as executor:
        result = insight_study(agents=40 if study else 2, seed=seed, executor=executor)
    assert route_3_first(result.agents).share >= 0.9
    assert route_3_first(result.controls).share <= 0.1
    assert all(sum(run.reached_at is not None for run in one.training) >= 9 for one in result.controls)


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
