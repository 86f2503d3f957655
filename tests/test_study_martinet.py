from __future__ import annotations

import json

import numpy as np
import pytest
from cogmap.experiments import workers
from cogmap.experiments.studies.martinet import _apart, martinet_lines, martinet_study  # pyright: ignore[reportPrivateUsage]
from cogmap.experiments.studies.martinet_figures import martinet_figures
from cogmap.experiments.studies.martinet_rows import BLOCKED, FREE, PROBES, MartinetResult, MartinetRow, MartinetRun
from cogmap.model import CogmapError


@pytest.fixture(scope="module")
def result() -> MartinetResult:
    return martinet_study(agents=1, days=2)


def made(*routes: int | None, condition: str = "A closed", day: int = 2) -> MartinetRow:
    return MartinetRow(0, tuple(MartinetRun(day, condition, route, 12) for route in routes))


def test_the_protocol_day_by_day(result: MartinetResult) -> None:
    (row,) = result.rows
    conditions = [[run.condition for run in row.runs if run.day == day] for day in (1, 2, 3)]
    assert conditions[0] == ["forced"] * 3 + ["free"] * FREE
    assert sorted(conditions[1]) == ["A closed"] * BLOCKED + ["free"] * 2
    assert conditions[2] == ["B closed"] * PROBES


def test_forced_runs_take_the_only_route_open_and_a_closed_room_is_never_passed(result: MartinetResult) -> None:
    (row,) = result.rows
    assert [run.route for run in row.runs if run.condition == "forced"] in ([1, 2, 3], [None, 2, 3])
    assert {run.route for run in row.runs if "closed" in run.condition} <= {2, 3, None}


def test_the_two_free_runs_of_a_day_are_apart() -> None:
    rng = np.random.default_rng(0)
    pairs = [_apart(rng) for _ in range(200)]
    assert all(second - first > 1 for first, second in pairs)
    assert {run for pair in pairs for run in pair} == set(range(BLOCKED + 2))


def test_only_the_first_day_counts_as_free() -> None:
    row = MartinetRow(0, made(1, 1, 3, condition="free", day=1).runs + made(2, 2, condition="free").runs)
    assert row.counts("free") == {1: 2, 2: 0, 3: 1}


def test_shares_and_preferences() -> None:
    result = MartinetResult((made(2, 2, 2, 3), made(2, 2, 3, None)), 2)
    share = result.share("A closed", 2)
    assert share is not None
    assert share.value == pytest.approx(5 / 7)
    assert share.low == pytest.approx(2 / 3)
    assert result.share("B closed", 3) is None
    by_condition = {(part.condition, part.more): part for part in result.preferences()}
    preferred = by_condition["A closed", 2]
    assert preferred.difference is not None
    assert preferred.difference.value == pytest.approx(3 / 7)
    assert preferred.p_value == pytest.approx(0.25)  # both of two agents
    assert by_condition["B closed", 3].p_value == 1.0
    assert MartinetResult((made(2),), 2).preferences()[2].p_value is None


def test_json_lines_and_figure(result: MartinetResult) -> None:
    report = result.to_dict()
    assert json.loads(json.dumps(report, allow_nan=False)) == report
    assert report["summary"]["runs"] == 12 + 12 + 7
    assert len(martinet_lines(result)) == 9
    assert set(martinet_figures(result)) == {"martinet_routes"}


@pytest.mark.parametrize("wrong", [{"agents": 0}, {"agents": 1, "days": 0}, {"agents": 1, "seed": -1}])
def test_bad_numbers_are_refused_in_one_line(wrong: dict[str, int]) -> None:
    with pytest.raises(CogmapError) as error:
        martinet_study(**wrong)
    assert "\n" not in str(error.value)


@pytest.mark.study
def test_the_order_of_the_routes(study: bool) -> None:
    with workers(jobs=2) as executor:
        result = martinet_study(agents=40 if study else 2, days=7 if study else 2, executor=executor)
    for part in result.preferences():
        assert part.difference is not None
        assert part.p_value is not None
        assert part.difference.low > 0.0
        assert part.p_value < (1e-4 if study else 0.3)  # of two agents it cannot be below 1/4
