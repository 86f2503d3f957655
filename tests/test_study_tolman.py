"""The study `tolman`: three routes, two blocks, one memory."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from cogmap.experiments import workers
from cogmap.experiments.studies import run_study, study_named
from cogmap.model import CogmapError
from cogmap.worlds import MAZES, Position, shortest_path

MAZE = MAZES["tolman"]
START, GOAL, FORK = (6, 2), (0, 2), (3, 2)
A, B = (4, 2), (2, 2)
BY_1 = shortest_path(MAZE, START, GOAL)
BY_2 = shortest_path(MAZE, START, GOAL, closed=[A])
BY_3 = shortest_path(MAZE, START, GOAL, closed=[B])
TO_FORK = shortest_path(MAZE, START, FORK)
BACK = TO_FORK[::-1][1:]
TO_FORK_BY_2 = shortest_path(MAZE, START, FORK, closed=[A])
BLOCKS = {"no obstacle": None, "A closed": A, "B closed": B}
STEPS = 20
STUDY: Any = study_named("tolman")
SMALL: Any = replace(STUDY, runs=2, knob=(1.0,))


@pytest.fixture(scope="module")
def rows() -> list[Any]:
    return SMALL.rows(2)


@pytest.fixture
def made(rows: list[Any]) -> Any:
    """Makes a run of a path, as if somebody had walked it."""
    kind = type(rows[0][1].blocks["no obstacle"][0])

    def make(path: Sequence[Position], *, closed: Position | None = None, knew: bool = True, wrong: int = 0) -> Any:
        path = [*path, *[path[-1]] * (STEPS - len(path))][:STEPS]
        return kind.of(path, path.index(GOAL) if path[-1] == GOAL else None, closed, knew, wrong)

    return make


def test_the_routes_have_the_lengths_of_the_paper(made: Any) -> None:
    assert [len(way) - 1 for way in (BY_1, BY_2, BY_3)] == [6, 10, 12]
    assert [(made(way).attempted, made(way).route) for way in (BY_1, BY_2, BY_3)] == [(1, 1), (2, 2), (3, 3)]


def test_the_route_that_counts_is_the_last(made: Any) -> None:
    back_from_the_fork = made([*TO_FORK, *BACK, *BY_3[1:]], closed=B)
    assert (back_from_the_fork.attempted, back_from_the_fork.route, back_from_the_fork.met_at) == (1, 3, 3)
    aside = made([START, (6, 3), START, *BY_1[1:]])
    assert (aside.attempted, aside.route, aside.missed) == (3, 1, None)


@pytest.mark.parametrize(
    ("path", "seen", "why"),
    [
        ([START, (6, 1), START, *TO_FORK[1:]], {"knew": False, "closed": B}, "searching"),
        (TO_FORK, {"wrong": STEPS, "closed": B}, "lost"),
        (TO_FORK_BY_2, {"closed": B}, "too late"),
        (TO_FORK, {"closed": B}, "exploring"),
        (TO_FORK, {}, "exploring"),
        ([*BY_1, (1, 2)], {}, "exploring"),  # passing through the goal is not reaching it
    ],
)
def test_why_a_run_missed_the_goal(made: Any, path: list[Position], seen: dict[str, Any], why: str) -> None:
    assert (made(path, **seen).route, made(path, **seen).missed) == (None, why)


def test_the_paper_counts_attempts_with_b_closed(rows: list[Any], made: Any) -> None:
    round_by_3 = made([*TO_FORK, *BACK, *BY_3[1:]], closed=B)
    blocks = {"no obstacle": (), "A closed": (), "B closed": (round_by_3, round_by_3, made(BY_3, closed=B))}
    row = replace(rows[0][1], blocks=blocks, after_block={"no obstacle": None, "A closed": None, "B closed": 3})
    found = SMALL.summarise([(2.0, row)])
    counts = found.json["summary"]["B closed"]
    assert [share.count for share in counts["attempted"].values()] == [2, 0, 1]
    assert [share.count for share in counts["reached"].values()] == [0, 0, 3]
    assert counts["agents_by_first_route_after_the_block"] == {1: 0, 2: 0, 3: 1}
    # route 3 is attempted in 1 of 3 runs, none of these in 2; the paper has 0, 36, 48 and 36 of 120; else nothing
    assert found.json["knob"]["settings"][0]["distance"] == pytest.approx((1.0 + 1.0 + (2 / 3 - 36 / 120)) / 3)


def test_every_run_is_counted_once(rows: list[Any]) -> None:
    own = [row for value, row in rows if value == 2.0]
    for block, counts in SMALL.summarise(rows).json["summary"].items():
        runs = [one for row in own for one in row.blocks[block]]
        assert counts["runs"] == len(runs) == 4
        assert sum(share.count for share in counts["reached"].values()) + sum(counts["missed"].values()) == 4
        assert {(one.path[0], len(one.path)) for one in runs} == {(START, STEPS)}
        for one in runs:
            assert all(to in (at, *MAZE.neighbours(at)) for at, to in pairwise(one.path))
            assert BLOCKS[block] not in one.path


def test_rows_do_not_depend_on_the_number_of_processes_nor_on_their_company(rows: list[Any]) -> None:
    done: list[None] = []
    with workers(jobs=2) as executor:
        again = SMALL.rows(1, seed=1, executor=executor, on_done=lambda: done.append(None))
    assert again[0] == rows[1]
    assert len(done) == 2


def test_the_knob_holds_the_study_and_the_other_values(rows: list[Any]) -> None:
    knob = SMALL.summarise(rows).json["knob"]
    assert [(one["value"], one["agents"]) for one in knob["settings"]] == [(1.0, 2), (2.0, 2)]
    nearest = min(knob["settings"], key=lambda one: one["distance"])
    assert knob["nearest_to_paper"] == nearest["value"]
    assert len(STUDY.tasks(range(10), STUDY.settings)) == 10 + 6 * 4


def test_what_is_left(tmp_path: Path) -> None:
    outcome = run_study(SMALL, tmp_path, runs=1)
    report = json.loads((tmp_path / "tolman.json").read_text())
    assert report["summary"]["A closed"]["runs"] == 2
    assert report["paper"]["no obstacle"]["1"]["count"] == 48
    assert outcome.lines[0].startswith("no obstacle: ")
    assert "48" in outcome.lines[3]
    pictures = {path.stem for path in tmp_path.glob("*.svg")}
    assert pictures == {"tolman_flow", "tolman_routes", "tolman_runs", "tolman_knob"}
    missed = sum(part["runs"] - part["goal_reached"]["count"] for part in report["summary"].values())
    assert bool(outcome.failed) == bool(missed)


def test_flow_is_drawn_through_the_doors_that_were_walked(rows: list[Any], made: Any) -> None:
    row = replace(rows[0][1], blocks=dict.fromkeys(BLOCKS, (made(BY_1), made(BY_3))))
    figure = SMALL.summarise([(2.0, row)]).figures["tolman_flow"]()
    lines = {tuple(zip(line.get_xdata(), line.get_ydata(), strict=True)) for line in figure.axes[0].lines}
    assert {line for line in lines if line} == {
        ((min(a, b)[1], min(a, b)[0]), (max(a, b)[1], max(a, b)[0])) for way in (BY_1, BY_3) for a, b in pairwise(way)
    }
    assert [ax.get_title().split(":")[0] for ax in figure.axes] == list(BLOCKS)


def test_bad_values_are_refused_in_one_line() -> None:
    with pytest.raises(CogmapError, match="tolman: runs is 0"):
        replace(STUDY, runs=0)
    with pytest.raises(CogmapError, match="information_weight"):
        replace(SMALL, knob=(-1.0,)).rows(1)


@pytest.mark.study
@pytest.mark.parametrize("seed", [0, 100, 1000])
def test_the_claims_of_the_paper(seed: int, study: bool) -> None:
    if not study and seed:
        pytest.skip("one seed in the small form")
    agents = 10 if study else 2
    with workers(jobs=2) as executor:
        rows = replace(STUDY, knob=()).rows(agents, seed=seed, executor=executor)
    blocks = STUDY.summarise(rows).json["summary"]
    reached = {name: [share.count for share in counts["reached"].values()] for name, counts in blocks.items()}
    free, a_closed, b_closed = reached.values()
    runs = 12 * agents
    for counts, least in ((free, 103), (a_closed, 115), (b_closed, 84)):
        assert sum(counts) >= least * runs / 120
    assert free[0] > max(free[1:])
    assert min(free[1:]) >= 0.08 * runs
    assert a_closed[0] == 0
    assert a_closed[1] > a_closed[2]
    assert b_closed[:2] == [0, 0]
    attempted = blocks["B closed"]["attempted"]
    assert attempted[3].count > attempted[2].count
    assert {row.places for _, row in rows} == {len(MAZE.rooms)}
