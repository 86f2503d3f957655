"""The study `cost`: seconds, measured one run after the other in this process."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from cogmap.agent import Settings
from cogmap.experiments import CSCG
from cogmap.experiments.studies import study_named

STUDY: Any = study_named("cost")
MODELS = ("cogmap", *CSCG, "random")


@pytest.fixture(scope="module")
def rows() -> list[Any]:
    return replace(STUDY, steps=7).rows(2, seed=5)


def timed(rows: list[Any], *seconds: float) -> list[Any]:
    """The rows as if each agent had taken so long."""
    return [replace(row, seconds=seconds[row.seed - 5]) for row in rows]


def test_runs_are_timed_in_turn_and_never_beside_each_other(rows: list[Any]) -> None:
    assert [(row.agent, row.seed) for row in rows] == [(agent, seed) for seed in (5, 6) for agent in MODELS]
    assert all(row.seconds > 0.0 for row in rows)
    assert STUDY.alone
    assert len(STUDY.tasks(range(2), Settings())) == len(rows)


def test_the_table_stands_beside_the_published(rows: list[Any]) -> None:
    found = STUDY.summarise(timed(rows, 1.0, 9.0))
    runs, table = found.tables
    by_model = {row[0]: tuple(row[1:]) for row in table.rows}
    assert by_model["cogmap"] == (5.0, 1.0, 9.0, 14.95, 31.3)
    assert by_model["CSCG"] == (5.0, 1.0, 9.0, 48.35, 1.9)
    assert by_model["random"] == (5.0, 1.0, 9.0, None, None)
    assert " ".join(found.lines[1].split()) == "cogmap 5 (1 to 9) paper 14.95, authors' code 31.3"
    assert [tuple(row[:2]) for row in runs.rows][:3] == [("cogmap", 5), ("cogmap", 6), ("cscg", 5)]
    assert found.json["summary"][0] == {
        "agent": "cogmap",
        "median": 5.0,
        "fastest": 1.0,
        "slowest": 9.0,
        "seconds": [1.0, 9.0],
        "paper": 14.95,
        "authors": 31.3,
    }
    assert not found.failed


def test_the_figure_has_a_bar_for_each(rows: list[Any]) -> None:
    ax = STUDY.summarise(timed(rows, 0.1, 0.2)).figures["cost_seconds"]().axes[0]
    assert [bar.get_width() for bar in ax.patches] == pytest.approx([0.15] * len(MODELS))
    assert ax.get_xscale() == "log"
    assert ax.get_xlim()[1] > 48.35
