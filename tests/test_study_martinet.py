"""The study `martinet`: forced, free, A closed, B closed."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from cogmap.experiments import workers
from cogmap.experiments.studies import martinet, run_study, study_named
from cogmap.model import CogmapError

STUDY: Any = study_named("martinet")
SMALL: Any = replace(STUDY, days=2)


@pytest.fixture(scope="module")
def rows() -> list[Any]:
    return SMALL.rows(2)


def made(rows: list[Any], *routes: int | None, condition: str = "A closed", day: int = 2) -> Any:
    row, one = rows[0], rows[0].runs[0]
    return type(row).of(0, [replace(one, day=day, condition=condition, route=route, steps=12) for route in routes])


def test_the_protocol_day_by_day(rows: list[Any]) -> None:
    conditions = [[run.condition for run in rows[0].runs if run.day == day] for day in (1, 2, 3)]
    assert conditions[0] == ["forced"] * 3 + ["free"] * 9
    assert sorted(conditions[1]) == ["A closed"] * 10 + ["free"] * 2
    assert conditions[2] == ["B closed"] * 7


def test_forced_runs_take_the_only_route_open_and_a_closed_room_is_never_passed(rows: list[Any]) -> None:
    assert [run.route for run in rows[0].runs if run.condition == "forced"] in ([1, 2, 3], [None, 2, 3])
    assert {run.route for run in rows[0].runs if "closed" in run.condition} <= {2, 3, None}


def test_the_two_free_runs_of_a_day_are_apart(rows: list[Any]) -> None:
    for row in rows:
        free = [number for number, run in enumerate(run for run in row.runs if run.day == 2) if run.condition == "free"]
        assert free[1] - free[0] > 1


def test_only_the_first_day_counts_as_free(rows: list[Any]) -> None:
    first, second = made(rows, 1, 1, 3, condition="free", day=1), made(rows, 2, 2, condition="free")
    row = type(first).of(0, [*first.runs, *second.runs])
    assert row.counts["free"] == {1: 2, 2: 0, 3: 1}


def test_shares_and_preferences(rows: list[Any]) -> None:
    found = SMALL.summarise([made(rows, 2, 2, 2, 3), made(rows, 2, 2, 3, None)])
    summary = found.json["summary"]
    share = summary["shares"]["A closed"][2]
    assert share.value == pytest.approx(5 / 7)
    assert share.low == pytest.approx(2 / 3)
    assert summary["shares"]["B closed"][3] is None
    preferred = {(part["condition"], part["more"]): part for part in summary["preferences"]}
    assert preferred["A closed", 2]["difference"].value == pytest.approx(3 / 7)
    assert preferred["A closed", 2]["p_value"] == pytest.approx(0.25)  # both of two agents
    assert preferred["B closed", 3]["p_value"] == 1.0
    assert SMALL.summarise([made(rows, 2)]).json["summary"]["preferences"][2]["p_value"] is None
    texts = {text.get_text() for ax in found.figures["martinet_routes"]().axes for text in ax.texts}
    assert {"71%", "29%", "2 > 3, p < 1"} <= texts


def test_steps_are_spent_where_the_runs_led(rows: list[Any]) -> None:
    shares = martinet.occupancy(rows, "B closed")
    assert sum(shares.values()) == pytest.approx(1.0)
    assert set(shares) == {room for row in rows for run in row.runs if run.condition == "B closed" for room in run.path}
    assert martinet.maze.B not in shares
    figure = SMALL.summarise(rows).figures["martinet_occupancy"]()
    texts = {text.get_text() for text in figure.axes[2].texts}
    assert f"{max(shares.values()):.0%}" in texts
    assert martinet.occupancy([], "free") == {}


def test_what_is_left(tmp_path: Path) -> None:
    outcome = run_study(replace(STUDY, days=1), tmp_path, runs=1)
    report = json.loads((tmp_path / "martinet.json").read_text())
    assert (report["summary"]["runs"], report["protocol"]["days"]) == (12 + 7, 1)
    assert len(outcome.lines) == 9
    reached = report["summary"]["reached"]
    assert outcome.failed == ([f"goal reached in {reached} of 19 runs"] if reached < 19 else [])


def test_no_day_is_refused() -> None:
    with pytest.raises(CogmapError, match="martinet: days is 0"):
        replace(STUDY, days=0)


@pytest.mark.study
def test_the_order_of_the_routes(study: bool, rows: list[Any]) -> None:
    if study:
        with workers(jobs=2) as executor:
            rows = replace(STUDY, days=7).rows(40, executor=executor)
    for part in STUDY.summarise(rows).json["summary"]["preferences"]:
        assert part["difference"].low > 0.0
        assert part["p_value"] < (1e-4 if study else 0.3)  # of two agents it cannot be below 1/4
