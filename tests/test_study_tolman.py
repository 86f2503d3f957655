from __future__ import annotations

import json
import math

import pytest
from cogmap.experiments import workers
from cogmap.experiments.studies.shares import total_variation, wilson
from cogmap.experiments.studies.tolman import KNOB_VALUES, TolmanResult, tolman_lines, tolman_study
from cogmap.experiments.studies.tolman_figures import tolman_figures
from cogmap.experiments.studies.tolman_flow import flow
from cogmap.experiments.studies.tolman_maze import (
    FORK,
    GOAL,
    MAZE,
    SETTINGS,
    START,
    STEPS,
    A,
    B,
    TolmanRun,
    choice_after,
    new_world,
    set_closed,
)
from cogmap.experiments.studies.tolman_rows import BLOCKS, PAPER, TolmanRow, compared, paper_counts
from cogmap.model import CogmapError
from cogmap.worlds import Position, shortest_path
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import binomtest

BY_1 = shortest_path(MAZE, START, GOAL)
BY_2 = shortest_path(MAZE, START, GOAL, closed=[A])
BY_3 = shortest_path(MAZE, START, GOAL, closed=[B])
TO_FORK = shortest_path(MAZE, START, FORK)
BACK = TO_FORK[::-1][1:]
TO_FORK_BY_2 = shortest_path(MAZE, START, FORK, closed=[A])


def run(path: list[Position], *, closed: Position | None = None, knew: bool = True, wrong: int = 0) -> TolmanRun:
    path = path + [path[-1]] * (STEPS - len(path))
    reached = path.index(GOAL) if path[-1] == GOAL else None
    return TolmanRun(closed, tuple(path[:STEPS]), reached, knew, wrong)


@pytest.fixture(scope="module")
def result() -> TolmanResult:
    return tolman_study(agents=2, runs=2, knob=(1.0,))


def test_the_routes_have_the_lengths_of_the_paper() -> None:
    assert [len(way) - 1 for way in (BY_1, BY_2, BY_3)] == [6, 10, 12]
    assert [run(way).route for way in (BY_1, BY_2, BY_3)] == [1, 2, 3]
    assert [run(way).attempted for way in (BY_1, BY_2, BY_3)] == [1, 2, 3]


def test_the_route_that_counts_is_the_last() -> None:
    back_from_the_fork = run([*TO_FORK, *BACK, *BY_3[1:]], closed=B)
    assert (back_from_the_fork.attempted, back_from_the_fork.route, back_from_the_fork.met_at) == (1, 3, 3)
    aside = run([START, (6, 3), START, *BY_1[1:]])
    assert (aside.attempted, aside.route, aside.missed) == (3, 1, None)


def test_passing_through_the_goal_is_not_reaching_it() -> None:
    through = TolmanRun(None, (*BY_1, (1, 2), (1, 2)), None)
    assert (through.route, through.missed) == (None, "exploring")


@pytest.mark.parametrize(
    ("missed", "why"),
    [
        (run([START, (6, 1), START, *TO_FORK[1:]], knew=False, closed=B), "searching"),
        (run(TO_FORK, wrong=STEPS, closed=B), "lost"),
        (run(TO_FORK_BY_2, closed=B), "too late"),
        (run(TO_FORK, closed=B), "exploring"),
        (run(TO_FORK), "exploring"),
    ],
)
def test_why_a_run_missed_the_goal(missed: TolmanRun, why: str) -> None:
    assert missed.missed == why


def test_what_is_tried_after_the_block() -> None:
    round_by_3 = choice_after([run([*TO_FORK, *BACK, *BY_3[1:]], closed=B)])
    assert round_by_3 is not None
    assert (round_by_3.met_by, round_by_3.route, round_by_3.at_fork, round_by_3.again) == (1, 3, False, 0)
    assert round_by_3.steps == len(BACK) + 1
    left = choice_after([run([*TO_FORK, (3, 1)], closed=B)])
    assert left is not None
    assert (left.route, left.at_fork, left.steps) == (2, True, 1)


def test_going_back_the_way_it_came_is_not_trying_it_again() -> None:
    runs = [run([*TO_FORK_BY_2, (3, 1)], closed=B), run(TO_FORK, closed=B), run(BY_3, closed=B)]
    choice = choice_after(runs)
    assert choice is not None
    assert (choice.met_by, choice.route, choice.again) == (2, 3, 1)


def test_no_block_met_nothing_chosen() -> None:
    assert choice_after([run(BY_3, closed=B)]) is None
    assert choice_after([run(TO_FORK, closed=B)]) is None
    assert choice_after([run(BY_1)]) is None
    assert choice_after([]) is None


def test_flow_counts_moves_both_ways_and_no_stays() -> None:
    counts = flow([[START, (6, 3), START, START], [START, (6, 3)]])
    assert counts == {(START, (6, 3)): 3}


def test_only_what_is_named_is_closed() -> None:
    world = new_world(closed=A)
    set_closed(world, room=B, doors=[(START, (6, 3))])
    assert (world.closed_rooms, world.closed_doors) == ({B}, {(START, (6, 3))})
    set_closed(world)
    assert (world.closed_rooms, world.closed_doors) == (frozenset(), frozenset())


@settings(deadline=None, max_examples=60)
@given(of=st.integers(1, 300), data=st.data())
def test_wilson_is_that_of_scipy(of: int, data: st.DataObject) -> None:
    count = data.draw(st.integers(0, of))
    share, expected = wilson(count, of), binomtest(count, of).proportion_ci(method="wilson")
    assert (share.low, share.high) == pytest.approx((expected.low, expected.high), abs=1e-12)
    assert 0.0 <= share.low <= share.share <= share.high <= 1.0


def test_nothing_is_known_of_no_runs() -> None:
    assert (wilson(0, 0).low, wilson(0, 0).high, wilson(0, 0).share) == (0.0, 1.0, 0.0)


def test_total_variation() -> None:
    assert total_variation((1, 1), (50, 50)) == 0.0
    assert total_variation((3, 0), (0, 8)) == 1.0
    assert math.isclose(total_variation((1, 1, 2), (1, 0, 0)), 0.75)
    assert total_variation((0, 0), (1, 1)) == 1.0


def test_the_paper_counts_attempts_with_b_closed(result: TolmanResult) -> None:
    round_by_3 = run([*TO_FORK, *BACK, *BY_3[1:]], closed=B)
    runs = (round_by_3, round_by_3, run(BY_3, closed=B))
    row = TolmanRow(0, ((), (), runs), 23)
    counts = TolmanResult((row,), SETTINGS, ()).counts[2]
    assert (counts.attempted, counts.reached, counts.after) == ((2, 0, 1), (0, 0, 3), (0, 0, 1))
    assert compared(counts, "B closed") == (0, 0, 1, 2)
    assert [paper_counts(name)[-1] for name in BLOCKS] == [17, 1, 36]
    assert all(sum(paper_counts(name)) == 120 for name in PAPER)


def test_every_run_is_counted_once(result: TolmanResult) -> None:
    for block, counts in enumerate(result.counts):
        runs = [run for row in result.rows for run in row.blocks[block]]
        assert counts.runs == len(runs) == 4
        assert sum(counts.reached) + sum(counts.missed.values()) == 4
        assert {run.closed for run in runs} == {list(BLOCKS.values())[block]}
        assert {(run.path[0], len(run.path)) for run in runs} == {(START, STEPS)}
        for one in runs:
            assert all(to in (at, *MAZE.neighbours(at)) for at, to in zip(one.path, one.path[1:], strict=False))
            assert one.closed not in one.path


def test_it_is_not_told_and_nothing_is_reset(result: TolmanResult) -> None:
    knew = [run.knew for run in result.rows[0].blocks[0] + result.rows[0].blocks[1]]
    assert not knew[0]
    assert knew == sorted(knew)


def test_rows_do_not_depend_on_the_number_of_processes_nor_on_their_company(result: TolmanResult) -> None:
    calls: list[None] = []
    with workers(jobs=2) as executor:
        again = tolman_study(
            agents=1, seed=1, runs=2, knob=(1.0,), executor=executor, on_done=lambda: calls.append(None)
        )
    assert again.rows[0].to_dict() == result.rows[1].to_dict()
    assert len(calls) == 1


def test_the_knob_holds_the_study_and_the_other_values(result: TolmanResult) -> None:
    assert [(setting.value, setting.agents) for setting in result.knob] == [(1.0, 2), (SETTINGS.information_weight, 2)]
    assert result.nearest.distance == min(setting.distance for setting in result.knob)
    assert SETTINGS.information_weight in KNOB_VALUES


def test_json_lines_and_figures(result: TolmanResult) -> None:
    report = result.to_dict()
    assert json.loads(json.dumps(report, allow_nan=False)) == report
    assert report["summary"]["A closed"]["runs"] == 4
    lines = tolman_lines(result)
    assert any(line.startswith("no obstacle: ") for line in lines)
    assert "48" in lines[3]
    figures = tolman_figures(result)
    assert set(figures) == {"tolman_flow", "tolman_routes", "tolman_runs", "tolman_knob"}
    assert [ax.get_title().split(":")[0] for ax in figures["tolman_flow"].axes] == list(BLOCKS)


@pytest.mark.parametrize("wrong", [{"agents": 0}, {"agents": 1, "runs": 0}, {"agents": 1, "seed": -1}])
def test_bad_numbers_are_refused_in_one_line(wrong: dict[str, int]) -> None:
    with pytest.raises(CogmapError) as error:
        tolman_study(**wrong, knob=())
    assert "\n" not in str(error.value)


def test_a_bad_value_of_the_knob_is_refused() -> None:
    with pytest.raises(CogmapError, match="information_weight"):
        tolman_study(agents=1, knob=(-1.0,))


@pytest.mark.study
@pytest.mark.parametrize("seed", [0, 100, 1000])
def test_the_claims_of_the_paper(seed: int, study: bool) -> None:
    if not study and seed:
        pytest.skip("one seed in the small form")
    agents = 10 if study else 2
    with workers(jobs=2) as executor:
        result = tolman_study(agents=agents, seed=seed, knob=(), executor=executor)
    free, a_closed, b_closed = result.counts
    runs = 12 * agents
    for counts, least in ((free, 103), (a_closed, 115), (b_closed, 84)):
        assert sum(counts.reached) >= least * runs / 120
    assert free.reached[0] > max(free.reached[1:])
    assert min(free.reached[1:]) >= 0.08 * runs
    assert a_closed.reached[0] == 0
    assert a_closed.reached[1] > a_closed.reached[2]
    assert b_closed.reached[:2] == (0, 0)
    assert b_closed.attempted[2] > b_closed.attempted[1]
    assert {row.places for row in result.rows} == {len(MAZE.rooms)}
