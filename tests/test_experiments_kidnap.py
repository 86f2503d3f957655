from __future__ import annotations

import json
from types import SimpleNamespace
from typing import Any

import pytest
from cogmap.agent import Agent, Settings
from cogmap.experiments import (
    KidnapRun,
    Parts,
    Truth,
    explore,
    explored,
    kidnap,
    kidnap_many,
    kidnap_result,
    map_seeds,
    workers,
)
from cogmap.model import ELSEWHERE, CogmapError
from cogmap.worlds import MAZES, parse_maze, torus

SMALL, TWO = MAZES["3x3"], parse_maze("0 1", name="two")


@pytest.mark.parametrize("name", ["3x3", "t_maze_alias"])
def test_an_agent_finds_itself_again(name: str) -> None:
    runs = kidnap_many(MAZES[name], runs=4)
    assert sum(run.map_intact for run in runs) >= len(runs) - (name == "t_maze_alias")  # a stem of equal cells may fold
    for run in runs:
        assert run.recovered
        assert run.steps_to_recover is not None
        assert run.steps_to_recover <= 6
        assert run.moved_to in MAZES[name].rooms


def test_different_sights_tell_at_once() -> None:
    runs = kidnap_many(SMALL, runs=6)
    assert {run.steps_to_recover for run in runs} == {0}
    assert len({run.moved_to for run in runs}) > 2


def test_exploring_is_that_of_explore() -> None:
    plain, run = explore(SMALL, seed=5), kidnap(SMALL, seed=5)
    assert (run.start, run.steps_to_explore) == (plain.start, plain.steps_to_complete)


def test_it_is_moved_to_another_room() -> None:
    for seed in range(6):
        session = explored("kidnap", TWO, seed)
        here = session.world.position
        assert session.steps is not None
        assert session.displace(elsewhere=True) == session.world.position != here


def test_the_true_place_follows_the_world() -> None:
    session = explored("kidnap", SMALL, 1)
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


class Lost(Agent):
    """In a maze of two rooms it says where it is as it is told to, once it was moved: after two observations."""

    def __init__(self, world: Any, script: list[tuple[bool, bool]], harm: str) -> None:
        super().__init__(world.motions, seed=0)
        self.world, self.script, self.harm = world, script, harm
        self.start: Any = None
        self.said: Any = None

    def step(self, observation: Any) -> int:
        self.said = None
        self.start = self.world.place if self.start is None else self.start
        action = super().step(observation)
        if self.steps > 2:
            right, certain = self.script[min(self.steps - 3, len(self.script) - 1)]
            here = self.map.place_at((0, self.world.place[1] - self.start[1]))
            self.said = SimpleNamespace(place=here if right else 1 - (here or 0), certain=certain, certainty=0.0)
            if self.harm == "transition":
                self.map.B_s.add(self.map.row(0, 0), ELSEWHERE, 100.0)
            if self.harm == "place":
                self.map.new_place((50, 50), step=99)
            self.harm = ""
        return action

    @property
    def belief(self) -> Any:
        return self.said or super().belief

    @property
    def certain(self) -> bool:
        return self.said.certain if self.said else super().certain


class Losing:
    """Makes such agents; each entry of the script says whether it is right, and whether it is certain."""

    agent = "lost"

    def __init__(self, script: list[tuple[bool, bool]], harm: str = "") -> None:
        self.script, self.harm = script, harm

    def make(self, world: Any, seed: object) -> Lost:
        self.made = Lost(world, self.script, self.harm)
        return self.made

    def to_dict(self, chart: object) -> dict[str, Any]:
        return {}


@pytest.mark.parametrize(
    ("right", "certain", "expected", "observations"),
    [
        ("y", "y", (0, 0), 21),
        ("nnyy", "ynny", (3, 1), 24),
        ("yny", "yyy", (0, 1), 21),
        ("n", "y", (None, 9), 9),
        ("y", "n", (None, 0), 9),
        ("nnnnnnnny", "nnnnnnnny", (8, 0), 29),
    ],
)
def test_recovery_is_being_certain_and_right(
    right: str, certain: str, expected: tuple[int | None, int], observations: int
) -> None:
    losing = Losing([(a == "y", b == "y") for a, b in zip(right, certain, strict=True)])
    run = kidnap(TWO, agent=losing, max_steps=8)
    assert run.steps_to_explore == 1
    assert (run.steps_to_recover, run.steps_certain_but_wrong) == expected
    assert run.recovered is (expected[0] is not None)
    assert losing.made.steps == 2 + observations


@pytest.mark.parametrize(("harm", "intact"), [("transition", False), ("place", False), ("", True)])
def test_a_harmed_map_is_seen(harm: str, intact: bool) -> None:
    assert kidnap(TWO, agent=Losing([(True, True)], harm)).map_intact is intact


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
    assert result["settings"] == json.loads(json.dumps(Parts().to_dict(SMALL)))


def test_bad_input(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Agent, "step", lambda *_: pytest.fail("it walked"))
    for bad, message in (
        (lambda: kidnap(parse_maze("0", name="one")), "has one room"),
        (lambda: kidnap(SMALL, seed=-1), "kidnap: seed is -1"),
        (lambda: kidnap(SMALL, max_steps=0), "kidnap: max_steps is 0"),
        (lambda: kidnap(SMALL, agent="frontier"), "kidnap: agent frontier believes nothing"),
        (lambda: kidnap_many(SMALL, runs=0), "runs is 0"),
        (lambda: map_seeds(abs, runs=0), "runs is 0"),
    ):
        with pytest.raises(CogmapError, match=message):
            bad()


def test_without_positions_a_place_is_the_room_in_which_it_was_visited_most() -> None:
    session = explored("kidnap", SMALL, 1)
    agent, trail = session.agent, session.trail
    elsewhere = next(room for room in SMALL.rooms if room != session.place)
    session.run(1, trail)
    for truth in (session.truth, Truth(torus(3, 3).chart, (0, 0))):  # of a torus no position says which place is which
        assert truth.right(agent, session.trail.rooms[-1], trail)
        assert not truth.right(agent, elsewhere, trail)
