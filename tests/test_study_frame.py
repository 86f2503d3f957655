from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Settings
from cogmap.experiments import Session, explored
from cogmap.experiments.studies.frame import STUDIES, Study, study_named
from cogmap.experiments.studies.imagined import imagined_paths, room_of
from cogmap.experiments.studies.saving import check_folder, save_study, study_report
from cogmap.model import CogmapError
from cogmap.views import VERMILION, plot_belief, plot_policies
from cogmap.worlds import MAZES
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

PACKAGE = "cogmap.experiments.studies"


class Found:
    """A result of nothing."""

    def __init__(self, **given: Any) -> None:
        self.given = given

    def to_dict(self) -> dict[str, Any]:
        return {"rows": [{"seed": 7}], "summary": {"agents": 1}}


@pytest.fixture
def stub() -> Iterator[Study]:
    module, drawn = ModuleType(f"{PACKAGE}.stub"), ModuleType(f"{PACKAGE}.stub_figures")
    module.SETTINGS = Settings(look_ahead=9, goal_weight=2.0)  # type: ignore[attr-defined]
    module.stub_study = lambda **given: Found(**given)  # type: ignore[attr-defined]
    module.stub_lines = lambda result: ["a line"]  # type: ignore[attr-defined]
    drawn.stub_figures = lambda result: {"stub_one": Figure()}  # type: ignore[attr-defined]
    sys.modules |= {module.__name__: module, drawn.__name__: drawn}
    yield Study("stub", 3)
    del sys.modules[module.__name__], sys.modules[drawn.__name__]


def test_a_study_runs_with_its_own_settings_unless_told_otherwise(stub: Study) -> None:
    own: Any = stub.run(agents=2, seed=5)
    assert own.given == {"agents": 2, "seed": 5, "settings": None, "executor": None, "on_done": None}
    assert stub.parts(2) == 2
    kept: Any = replace(stub, keeps_cells=True).run(agents=1, ledger=None)
    assert set(kept.given) - set(own.given) == {"ledger"}
    other: Any = stub.run(agents=2, look_ahead=4)
    assert other.given["settings"] == Settings(look_ahead=4, goal_weight=2.0)
    assert stub.settings() == Settings(look_ahead=9, goal_weight=2.0)
    with pytest.raises(CogmapError, match="look_ahead is 0"):
        stub.run(agents=2, look_ahead=0)


def test_what_a_study_leaves_in_its_folder(stub: Study, tmp_path: Path) -> None:
    result = stub.run(agents=1)
    report = study_report(stub, result, agents=1, seed=7, settings=stub.settings())
    written = save_study(tmp_path / "a" / "b", stub, result, report)
    names = ["stub.json", "stub.csv", "stub_summary.csv", "stub_one.png", "stub_one.svg", "stub.md", "stub.html"]
    assert [path.name for path in written] == names
    assert all(path.stat().st_size for path in written)
    saved = json.loads(written[0].read_text())
    assert (saved["study"], saved["agents"], saved["seed"], saved["rows"]) == ("stub", 1, 7, [{"seed": 7}])
    assert saved["settings"]["look_ahead"] == 9
    assert set(saved["versions"]) >= {"cogmap", "python", "numpy", "platform"}
    assert set(saved["machine"]) >= {"processor", "cores", "system"}
    assert saved["command"] == "cogmap study stub --runs 1 --seed 7"
    other = study_report(stub, result, agents=1, seed=7, settings=stub.settings(4))
    assert other["command"].endswith(" --seed 7 --look-ahead 4")


def test_unknown_studies_are_refused() -> None:
    with pytest.raises(CogmapError, match=r"no study is called 'x'; choose one of exploration, rooms.*, or all"):
        study_named("x")
    assert study_named("donut") is STUDIES["donut"]


def test_folders_that_could_not_be_written_are_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    (tmp_path / "there" / "x.json").mkdir(parents=True)
    for folder in ("file", "file/below", "n" * 300):
        with pytest.raises(CogmapError, match="cannot make folder"):
            check_folder(tmp_path / folder, "x")
    with pytest.raises(CogmapError, match="it is a folder"):
        check_folder(tmp_path / "there", "x")
    check_folder(tmp_path / "new" / "deep", "x")
    check_folder(tmp_path, "x")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["file", "there"]


def test_a_folder_that_appears_as_a_file_meanwhile(stub: Study, tmp_path: Path) -> None:
    (tmp_path / "late").write_text("")
    with pytest.raises(CogmapError, match="cannot make folder"):
        save_study(tmp_path / "late", stub, stub.run(agents=1), {})


# -- imagined paths ----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def session() -> Session:
    session = explored("test", MAZES["3x3"], 1, settings=Settings(look_ahead=4), max_steps=100)
    session.agent.prefer({8: 3.0})
    session.agent.step(session.world.observe())
    return session


def walked(session: Session, policy: list[int]) -> tuple[tuple[int, int], ...]:
    """The rooms of a policy, walked in the world itself."""
    here = session.world.position
    rooms = [here]
    for action in policy:
        session.world.step(action)
        if session.world.position != rooms[-1]:
            rooms.append(session.world.position)
    session.world.displace(here)
    return tuple(rooms)


def test_imagined_paths_are_those_of_the_world(session: Session) -> None:
    plan = session.agent.plan
    expected: dict[tuple[tuple[int, int], ...], float] = {}
    for policy, p in zip(plan.policies.tolist(), plan.probability.tolist(), strict=True):
        rooms = walked(session, policy)
        expected[rooms] = expected.get(rooms, 0.0) + p
    found = {path.rooms: path.probability for path in imagined_paths(plan, session.agent.map, session.start)}
    assert found == pytest.approx({rooms: p for rooms, p in expected.items() if p >= 1e-3}, abs=1e-3)
    assert list(found.values()) == sorted(found.values(), reverse=True)


def test_a_divided_belief_has_paths_from_every_place(session: Session) -> None:
    plan = session.agent.plan
    inside = np.flatnonzero(plan.places >= 0)[:2]
    belief = np.zeros_like(plan.model.belief)
    belief[inside] = 0.25, 0.75
    divided = replace(plan, model=replace(plan.model, belief=belief))
    mass = {}
    for path in imagined_paths(divided, session.agent.map, session.start):
        mass[path.rooms[0]] = mass.get(path.rooms[0], 0.0) + path.probability
    rooms = [room_of(session.agent.map, int(place), session.start) for place in plan.places[inside]]
    assert mass == pytest.approx(dict(zip(rooms, (0.25, 0.75), strict=True)), abs=0.02)
    assert room_of(session.agent.map, -1, session.start) is None


# -- plots -------------------------------------------------------------------------------------------------


def test_bars_are_as_high_as_places_are_probable() -> None:
    ax = plot_belief({"a": 0.25, "b": 0.75}, true="b", threshold=0.7, title="here")
    assert [bar.get_height() for bar in ax.patches] == [0.25, 0.75]  # type: ignore[attr-defined]
    assert [bar.get_facecolor() == to_rgba(VERMILION) for bar in ax.patches] == [False, True]
    assert [label.get_text() for label in ax.get_xticklabels()] == ["a", "▲ b"]
    assert ax.lines[0].get_ydata()[0] == 0.7  # type: ignore[index]


def test_ways_are_as_dark_as_they_are_probable() -> None:
    paths = {((0, 0), (0, 1), (0, 0)): 0.25, ((0, 0), (0, 1), (0, 2)): 0.75, ((0, 0),): 0.001}
    ax = plot_policies(paths, title="here")
    shaded = [part for part in ax.collections if isinstance(part, LineCollection)][-1]
    lines = [tuple(map(tuple, segment)) for segment in shaded.get_segments()]
    assert lines == [((1.0, 0.0), (2.0, 0.0)), ((0.0, 0.0), (1.0, 0.0))]  # x, y; there and back counts once
    greys = [colour[0] for colour in np.asarray(shaded.get_color())]
    assert greys == pytest.approx([0.85 * 0.25, 0.0])
    assert plot_policies(paths, ax=ax) is ax


@pytest.mark.parametrize(
    ("draw", "message"),
    [
        (lambda: plot_belief({}), "one or more places"),
        (lambda: plot_belief({"a": 1.5}), "from 0 to 1"),
        (lambda: plot_belief({"a": float("nan")}), "from 0 to 1"),
        (lambda: plot_policies({(): 1.0}), "no cells"),
        (lambda: plot_policies({((0, 0, 0),): 1.0}), "3 dimensions"),
    ],
)
def test_plots_refuse_what_they_cannot_draw(draw: Callable[[], object], message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        draw()
