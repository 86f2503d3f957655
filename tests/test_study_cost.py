"""The study `cost`: seconds, measured one run after the other in this process."""

from __future__ import annotations

from concurrent.futures import Executor
from pathlib import Path
from typing import Any

import pytest
from cogmap.experiments.studies import cost
from cogmap.experiments.studies.cost import (
    AGENTS,
    SETTINGS,
    WARM,
    CostResult,
    Time,
    cost_lines,
    cost_study,
    cost_tables,
)
from cogmap.experiments.studies.cost_figures import cost_figures
from cogmap.experiments.studies.frame import STUDIES
from cogmap.experiments.studies.saving import save_study, study_report
from cogmap.model import CogmapError


class Refusing(Executor):
    def submit(self, *args: Any, **kwargs: Any) -> Any:
        pytest.fail("it ran beside something else")


def test_runs_are_timed_in_turn_and_never_beside_each_other(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[str, int, int]] = []

    def timed(agent: str, settings: object, seed: int, steps: int) -> float:
        assert settings == SETTINGS
        asked.append((agent, seed, steps))
        return float(len(asked))

    monkeypatch.setattr(cost, "forced_seconds", timed)
    calls: list[None] = []
    found = cost_study(agents=2, seed=5, executor=Refusing(), on_done=lambda: calls.append(None))
    warm, rest = asked[: len(AGENTS)], asked[len(AGENTS) :]
    assert warm == [(agent, 5, WARM) for agent in AGENTS]
    assert rest == [(agent, seed, 100) for seed in (5, 6) for agent in AGENTS]
    assert len(calls) == cost.cost_tasks(2) == len(rest)
    assert found.times[0].seconds == (7.0, 13.0)


def test_every_agent_takes_time() -> None:
    found = cost_study(agents=1, steps=7)
    assert [time.agent for time in found.times] == ["cogmap", *AGENTS[1:]]
    assert all(0.0 < time.median < 60.0 for time in found.times)
    assert found.failed() == ()


def test_the_table_stands_beside_the_published(tmp_path: Path) -> None:
    found = CostResult(tuple(Time(agent, (1.0, 2.0, 9.0)) for agent in AGENTS), 100, 0)
    table = {row[0]: row[1:] for row in cost_tables(found)[1].rows}
    assert table["cogmap"] == (2.0, 1.0, 9.0, 14.95, 31.3)
    assert table["CSCG"] == (2.0, 1.0, 9.0, 48.35, 1.9)
    assert table["random"] == (2.0, 1.0, 9.0, None, None)
    assert " ".join(cost_lines(found)[1].split()) == "cogmap 2 (1 to 9) paper 14.95, authors' code 31.3"
    assert len(cost_tables(found)[0].rows) == 3 * len(AGENTS)
    study = STUDIES["cost"]
    report = study_report(study, found, agents=3, seed=0, settings=study.settings())
    names = {path.name for path in save_study(tmp_path, study, found, report)}
    assert names == {f"cost.{end}" for end in ("json", "csv", "md", "html")} | {
        "cost_table.csv",
        "cost_seconds.png",
        "cost_seconds.svg",
    }
    markdown = (tmp_path / "cost.md").read_text()
    assert "| CSCG pose | 2 | 1 | 9 | – | – |" in markdown
    assert "one after the other" in markdown


def test_the_figure_has_a_bar_for_each() -> None:
    found = CostResult(tuple(Time(agent, (0.1, 0.2)) for agent in AGENTS), 100, 0)
    ax = cost_figures(found)["cost_seconds"].axes[0]
    assert [bar.get_width() for bar in ax.patches] == pytest.approx([0.15] * len(AGENTS))  # type: ignore[attr-defined]
    assert ax.get_xscale() == "log"
    assert ax.get_xlim()[1] > 48.35


@pytest.mark.parametrize(
    ("numbers", "message"), [({"agents": 0}, "agents is 0"), ({"steps": 0}, "steps is 0"), ({"seed": -1}, "seed is -1")]
)
def test_bad_numbers_are_refused(numbers: dict[str, int], message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        cost_study(**{"agents": 1, **numbers})
