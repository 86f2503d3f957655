"""The study `identity`, small."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from cogmap.agent import Settings
from cogmap.experiments.studies import run_study
from cogmap.experiments.studies.identity import CASES, Identity, IdentityRow
from cogmap.model import CogmapError
from cogmap.worlds import distinguishable

SMALL = Identity(cases=("moved once, 3x3", "slip 0.1, 4x4", "torus 3x3"), beside=("cscg", "cscg_along"), most=12)


@pytest.fixture(scope="module")
def rows() -> list[IdentityRow]:
    return SMALL.rows(2)


def test_every_case_makes_a_world_in_which_places_can_be_told_apart() -> None:
    for name, case in CASES.items():
        world = case.made(1)
        assert distinguishable(world.unwrapped.chart, doors=not case.blind) or case.blind, name
        observation, _ = world.reset(seed=0)
        assert ("open" in observation) != case.blind


def test_rows_say_what_came_of_each_walk(rows: list[IdentityRow]) -> None:
    assert [row.key for row in rows] == SMALL.tasks(range(2), Settings())
    assert [row.agent for row in rows] == ["cogmap"] * 6 + ["cscg"] * 2 + ["cscg_along"] * 2
    for row in rows:
        assert IdentityRow.from_dict(json.loads(json.dumps(row.to_dict()))) == row
        assert row.exact == (row.from_step is not None)
        assert (row.places is None) == (row.agent != "cogmap")
        assert len(row.sizes) == len(row.certainty) == len(row.hypotheses)
    moved = rows[0]
    assert moved.rooms == 9
    assert len(moved.sizes) >= 13
    assert sum(moved.held) <= len(moved.sizes)


def test_what_is_kept_is_not_made_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    small = replace(SMALL, cases=("moved once, 3x3",))
    first = run_study(small, tmp_path, runs=1)
    monkeypatch.setattr(Identity, "run", lambda *_, **__: pytest.fail("made again"))
    assert run_study(small, tmp_path, runs=1).lines == first.lines
    with pytest.raises(CogmapError, match="most"):
        run_study(replace(small, most=11), tmp_path, runs=1)


def test_its_tables_and_pictures(tmp_path: Path, rows: list[IdentityRow]) -> None:
    found = SMALL.summarise(rows)
    assert found.tables is not None
    table = {(line[0], line[1]): line for line in found.tables[1].rows}
    assert table["torus 3x3", "CSCG, our walks"][2] == "0/2 [0%, 66%]"  # twelve steps are too few
    exact = sum(row.exact for row in rows[4:6])
    assert (f"torus 3x3: {2 - exact} of 2 maps are not exact" in found.failed) == (exact < 2)
    assert {"identity_exact", "identity_certainty", "identity_moved", "identity_torus"} <= set(found.figures)
    for draw in found.figures.values():
        draw().savefig(tmp_path / "x.svg")
    json.dumps(found.json["rows"])


def test_the_map_says_what_the_hypothesis_says_after_a_move() -> None:
    """A way that was walked from one side only is no way back, or the map would have two rooms behind one door."""
    case = "moved once, 4x4_alias"
    assert Identity(cases=(case,), beside=()).run((case, "cogmap", 2), Settings()).exact
