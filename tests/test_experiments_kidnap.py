from __future__ import annotations

import json
from types import SimpleNamespace
from typing import Any

import cogmap.experiments.kidnapping as module
import pytest
from cogmap.agent import Agent, Settings
from cogmap.experiments import KidnapRun, explore, kidnap, kidnap_many, kidnap_result, map_seeds
from cogmap.experiments.executors import workers
from cogmap.experiments.session import explored
from cogmap.model import CogmapError
from cogmap.worlds import MAZES, parse_maze

SMALL = MAZES["3x3"]


@pytest.mark.parametrize("name", ["3x3", "t_maze_alias"])
def test_an_agent_finds_itself_again(name: str) -> None:
    for run in kidnap_many(MAZES[name], runs=4):
        assert run.recovered
        assert run.steps_to_recover is not None
        assert run.steps_to_recover <= 6
        assert run.map_intact
        assert run.moved_to in MAZES[name].rooms


def test_different_sights_tell_at_once() -> None:
    runs = kidnap_many(SMALL, runs=6)
    assert {run.steps_to_recover for run in runs} == {0}
    assert len({run.moved_to for run in runs}) > 2


def test_exploring_is_that_of_explore() -> None:
    plain, run = explore(SMALL, seed=5), kidnap(SMALL, seed=5)
    assert (run.start, run.steps_to_explore) == (plain.start, plain.steps_to_complete)


def test_it_is_moved_to_another_room() -> None:
    two = parse_maze("0 1", name="two")
    for seed in range(6):
        session = explored("kidnap", two, settings=None, seed=seed, most=50)
        here = session.world.position
        assert session.steps is not None
        assert session.displace(elsewhere=True) == session.world.position != here


def test_the_true_place_follows_the_world() -> None:
    session = explored("kidnap", SMALL, settings=None, seed=1, most=100)
    places = set[int | None]()
    for room in SMALL.rooms:
        session.world.displace(room)
        place = session.true_place
        assert place is not None
        assert session.agent.map.positions[place] == (room[0] - session.start[0], room[1] - session.start[1])
        places.add(place)
    assert len(places) == len(SMALL.rooms)


def test_not_explored_is_counted_and_not_moved() -> None:
    runs = kidnap_many(SMALL, runs=2, max_steps=2)
    assert [run.moved_to for run in runs] == [None, None]
    result = kidnap_result(SMALL, runs, settings=Settings(), max_steps=2)
    assert (result["summary"]["runs"], result["summary"]["explored"], result["summary"]["recovered"]) == (2, 0, 0)
    assert result["summary"]["mean_steps_to_recover"] is None
    assert result["runs"][0]["steps_certain_but_wrong"] is None
    assert result["runs"][0]["recovered"] is False


class Lost:
    """A session that is certain of place `beliefs[step]`, and truly in place 1."""

    def __init__(self, beliefs: list[int], certain: list[bool]) -> None:
        self.beliefs, self.certainties, self.seen = beliefs, certain, 0
        self.agent: Any = self
        self.world = SimpleNamespace(observe=lambda: {}, step=lambda _: None)
        self.true_place = 1

    def step(self, _: object) -> int:
        self.seen += 1
        return 0

    @property
    def belief(self) -> Any:
        return SimpleNamespace(place=self.beliefs[min(self.seen, len(self.beliefs)) - 1])

    @property
    def certain(self) -> bool:
        return self.certainties[min(self.seen, len(self.certainties)) - 1]


@pytest.mark.parametrize(
    ("beliefs", "certain", "expected", "observations"),
    [
        ([1], [True], (0, 0), 21),
        ([2, 2, 1, 1], [True, False, False, True], (3, 1), 24),
        ([1, 2, 1], [True, True, True], (0, 1), 21),
        ([2], [True], (None, 9), 9),
        ([1], [False], (None, 0), 9),
        ([2] * 8 + [1], [False] * 8 + [True], (8, 0), 29),
    ],
)
def test_recovery_is_being_certain_and_right(
    beliefs: list[int], certain: list[bool], expected: tuple[int | None, int], observations: int
) -> None:
    lost: Any = Lost(beliefs, certain)
    assert module._recover(lost, 8) == expected
    assert lost.seen == observations


@pytest.mark.parametrize("harm", ["transition", "place"])
def test_a_harmed_map_is_seen(monkeypatch: pytest.MonkeyPatch, harm: str) -> None:
    def hurt(session: Any, most: int) -> tuple[int, int]:
        known = session.agent.map
        if harm == "transition":
            known.B_s.fade(slice(None), 0.0)
        else:
            known.new_place((50, 50), step=99)
        return 0, 0

    monkeypatch.setattr(module, "_recover", hurt)
    assert kidnap(SMALL).map_intact is False


def test_the_result_is_plain_json_and_the_same_on_two_processes() -> None:
    one = kidnap_many(SMALL, runs=3, seed=4)
    with workers(jobs=2) as executor:
        two = kidnap_many(SMALL, runs=3, seed=4, executor=executor)
    assert one == two
    result = json.loads(json.dumps(kidnap_result(SMALL, one, settings=Settings()), allow_nan=False))
    assert list(result) == ["world", "agent", "settings", "runs", "summary"]
    assert [run["seed"] for run in result["runs"]] == [4, 5, 6]
    assert set(result["runs"][0]) == set(KidnapRun.__dataclass_fields__)
    assert result["runs"][0]["start"] == list(one[0].start)
    assert Settings.from_dict(result["settings"]) == Settings()


def test_bad_input(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Agent, "step", lambda *_: pytest.fail("it walked"))
    for bad, message in (
        (lambda: kidnap(parse_maze("0", name="one")), "has one room"),
        (lambda: kidnap(SMALL, seed=-1), "kidnap: seed is -1"),
        (lambda: kidnap(SMALL, max_steps=0), "kidnap: max_steps is 0"),
        (lambda: kidnap_many(SMALL, runs=0), "runs is 0"),
        (lambda: map_seeds(abs, runs=0), "runs is 0"),
    ):
        with pytest.raises(CogmapError, match=message):
            bad()
