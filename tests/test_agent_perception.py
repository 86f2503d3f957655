"""What an agent refuses to see, and what it takes without complaint."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent
from cogmap.model import CogmapError, Sight, Ways
from walks import GRID

from cogmap import UNSEEN

OPEN = [True, False, True, False, True]
NAN = float("nan")

BAD: dict[str, tuple[Any, str]] = {
    "nothing": (None, "is a NoneType; give a mapping"),
    "a list": ([1, OPEN], "is a list; give a mapping"),
    "what reset returns": (({"sight": 1, "open": OPEN}, {}), "is a tuple; give a mapping with keys .* the first alone"),
    "a string": ("sight open", "is a str; give a mapping"),
    "empty": ({}, "key 'sight' is missing"),
    "no sight": ({"open": OPEN}, "key 'sight' is missing"),
    "no doors": ({"sight": 1}, "key 'open' is missing"),
    "four doors": ({"sight": 1, "open": OPEN[:4]}, r"shape \(4,\); give one truth value an action: up, down"),
    "six doors": ({"sight": 1, "open": [*OPEN, True]}, r"shape \(6,\)"),
    "a column of doors": ({"sight": 1, "open": np.ones((5, 1), dtype=bool)}, r"shape \(5, 1\)"),
    "one door": ({"sight": 1, "open": True}, r"shape \(\)"),
    "None for doors": ({"sight": 1, "open": None}, r"shape \(\)"),
    "a set of doors": ({"sight": 1, "open": {True, False}}, r"shape \(\)"),
    "words for doors": ({"sight": 1, "open": ["open"] * 5}, "'open' holds 'open'; give truth values"),
    "NaN doors": ({"sight": 1, "open": [NAN] * 5}, "holds nan; give truth values"),
    "doors of 2": ({"sight": 1, "open": [0, 1, 2, 0, 1]}, "holds 2; give truth values"),
    "doors of -0.1": ({"sight": 1, "open": np.array([0, 1, -0.1, 0, 1])}, r"holds -0\.1; give truth values, P\(open\)"),
    "a mask for doors": ({"sight": 1, "open": np.ma.masked}, r"shape \(\)"),
    "a door without a name": ({"sight": 1, "open": {"up": True, "north": True}}, "no way 'north'; known are up, down"),
    "two words for doors": ({"sight": 1, "open": OPEN, "ways": OPEN}, "two words for one thing"),
    "ragged doors": ({"sight": 1, "open": [[True], [True, False], 1, 1, 1]}, "different lengths"),
    "a list to see": ({"sight": [1], "open": OPEN}, "sight is a list, not hashable"),
    "no likelihoods": ({"sight": {}, "open": OPEN}, "sight has no likelihood above 0; .* or UNSEEN"),
    "likelihoods of 0": ({"sight": {"a": 0, "b": 0.0}, "open": OPEN}, "sight has no likelihood above 0"),
    "a negative likelihood": ({"sight": {"a": 1, "b": -0.1}, "open": OPEN}, r"likelihood -0\.1 of 'b'; give finite"),
    "an infinite likelihood": ({"sight": {"a": 1, "b": np.inf}, "open": OPEN}, "likelihood inf of 'b'; give finite"),
    "a NaN for a likelihood": ({"sight": {"a": 1, "b": NAN}, "open": OPEN}, "likelihood nan of 'b'; give finite"),
    "a masked likelihood": ({"sight": {"a": 1, "b": np.ma.masked}, "open": OPEN}, "likelihood masked of 'b'"),
    "a word for a likelihood": ({"sight": {"a": "high"}, "open": OPEN}, "likelihood 'high' of 'a'; give finite"),
    "a truth value for a likelihood": ({"sight": {"a": True}, "open": OPEN}, "likelihood True of 'a'; give finite"),
    "likelihood of None": ({"sight": {"a": 1, None: 1}, "open": OPEN}, "sight is None; give UNSEEN"),
    "likelihood of UNSEEN": ({"sight": {"a": 1, UNSEEN: 1}, "open": OPEN}, "sight is masked; give UNSEEN"),
    "an array to see": ({"sight": np.zeros(2), "open": OPEN}, "sight is a ndarray, not hashable"),
    "a list in a tuple": ({"sight": (1, [2]), "open": OPEN}, "sight is a tuple, not hashable"),
    "NaN to see": ({"sight": NAN, "open": OPEN}, "sight is NaN.*; give UNSEEN where nothing was seen"),
    "numpy's NaN": ({"sight": np.float32("nan"), "open": OPEN}, "sight is NaN"),
    "NaN in a tuple": ({"sight": (1, (NAN,)), "open": OPEN}, "sight is NaN"),
    "no time": ({"sight": np.datetime64("NaT"), "open": OPEN}, "sight is NaN"),
    "no time in an array": ({"sight": np.array(np.datetime64("NaT")), "open": OPEN}, "sight is None"),
    "NaN in a set": ({"sight": frozenset({NAN}), "open": OPEN}, "sight is NaN"),
    "None in an array": ({"sight": np.array(None), "open": OPEN}, "sight is None"),
    "a mask to see": ({"sight": np.ma.masked, "open": OPEN}, "sight is masked; give UNSEEN where nothing was seen"),
    "None to see": ({"sight": None, "open": OPEN}, r"sight is None; give UNSEEN .*labels=\[None\]"),
    "an unknown key": (
        {"sight": 1, "open": OPEN, "smell": 3},
        "unknown key 'smell'; known are 'sight' and 'open', and",
    ),
    "no action": ({"sight": 1, "open": OPEN, "taken": "north"}, "'taken' is 'north'; give an action by name or index"),
    "an outcome": ({"sight": 1, "open": OPEN, "outcome": "late"}, "'outcome' is 'late'; give one of 'arrived', 'bl"),
    "no outcome": ({"sight": 1, "open": OPEN, "outcome": None}, "'outcome' is None; give one of"),
    "a displacement": ({"sight": 1, "open": OPEN, "displacement": 3}, "'displacement' is 3; give 2 finite numbers"),
    "three axes": ({"sight": 1, "open": OPEN, "displacement": np.zeros(3)}, "give 2 finite numbers"),
    "metres in bytes": ({"sight": 1, "open": OPEN, "displacement": b"ab"}, "give 2 finite numbers"),
    "metres in a set": ({"sight": 1, "open": OPEN, "displacement": {1, 2}}, "give 2 finite numbers"),
    "metres by axis": ({"sight": 1, "open": OPEN, "displacement": {0: 1, 1: 2}}, "give 2 finite numbers"),
    "NaN metres": ({"sight": 1, "open": OPEN, "displacement": [NAN, 0]}, "give 2 finite numbers"),
    "a turn": ({"sight": 1, "open": OPEN, "turn": "left"}, "'turn' is 'left'; give a finite number"),
    "a NaN turn": ({"sight": 1, "open": OPEN, "turn": NAN}, "'turn' is nan; give a finite number"),
    "a cost below 0": ({"sight": 1, "open": OPEN, "cost": -1}, "'cost' is -1; give a finite number of 0 or more"),
    "a word for moved": ({"sight": 1, "open": OPEN, "moved": "no"}, "'moved' is 'no'; give true where"),
    "a number for moved": ({"sight": 1, "open": OPEN, "moved": 1}, "'moved' is 1; give true where"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_observation_is_refused_and_changes_nothing(name: str) -> None:
    observation, message = BAD[name]
    agent = Agent(GRID, seed=0)
    grown = list(agent.map.growth)
    with pytest.raises(CogmapError, match=message) as raised:
        agent.step(observation)
    assert "\n" not in str(raised.value)
    assert str(raised.value).startswith("observation: ")
    assert agent.steps == 0
    assert agent.map.growth == grown
    assert len(agent.map.sights) == 0
    assert agent.step({"sight": 1, "open": OPEN}) in range(5)


@pytest.mark.parametrize(
    ("sight", "label"),
    [
        (np.int64(3), 3),
        (np.array(3), 3),
        (np.float64(0.5), 0.5),
        (np.str_("hall"), "hall"),
        (np.bool_(True), True),
        ("", ""),
        ((np.int64(1), (np.str_("a"), np.bool_(True))), (1, ("a", True))),
        ((1, "a"), (1, "a")),
        (frozenset({1}), frozenset({1})),
    ],
)
def test_sights_are_taken_as_plain_values(sight: Any, label: Any) -> None:
    agent = Agent(GRID, seed=0)
    agent.step({"sight": sight, "open": OPEN})
    found = agent.trace[0].sight
    assert found == label
    assert not isinstance(found, np.generic | np.ndarray)


@pytest.mark.parametrize(
    "doors",
    [
        OPEN,
        tuple(OPEN),
        np.array(OPEN),
        np.array(OPEN, dtype=np.int8),
        np.uint8([1, 0, 1, 0, 1]),
        [1.0, 0.0, 1.0, 0.0, 1.0],
        dict(zip(GRID, OPEN, strict=True)),
        np.ma.array(OPEN),
    ],
)
def test_doors_are_taken_in_any_form(doors: Any) -> None:
    agent = Agent(GRID, seed=0)
    agent.step({"sight": 1, "open": doors})
    assert agent.trace[0].open == tuple(OPEN)
    other = Agent(GRID, seed=0)
    other.step({"sight": 1, "ways": doors})
    assert other.trace == agent.trace


@pytest.mark.parametrize(
    "doors",
    [
        [True, None, 0.25, False, True],
        [True, UNSEEN, 0.25, False, None],
        np.array([1, None, 0.25, 0, 1], dtype=object),
        np.ma.array([1.0, 0.5, 0.25, 0.0, 1.0], mask=[0, 1, 0, 0, 1]),
        {"up": True, "left": 0.25, "right": np.bool_(False)},
    ],
)
def test_a_way_may_not_have_been_looked_at_or_be_probably_open(doors: Any) -> None:
    agent = Agent(GRID, seed=0)
    agent.step({"sight": 1, "open": doors})
    assert agent.trace[0].open == (True, None, 0.25, False, True)
    blocked = agent.map.blocked(np.array([0]))[0]
    before = 1.0 - (1.0 + 1.25) / (2.0 + 3.0)  # how often ways are blocked, by Beta(1, 1) and what is read here
    left = 0.75 * before / (0.75 * before + 0.25 * (1.0 - before))
    np.testing.assert_allclose(blocked, [1e-6, 0.5, left, 1 - 1e-6, 0.0], atol=0.02)  # a look may be wrong


@pytest.mark.parametrize("doors", [UNSEEN, [None] * 5, np.ma.array([0, 1, 0, 1, 0], mask=True), {}, {"stay": True}])
def test_no_way_may_have_been_looked_at(doors: Any) -> None:
    agent = Agent(GRID, seed=0)
    agent.step({"sight": 1, "open": doors})
    assert agent.trace[0].open == ()
    assert (agent.map.blocked(np.array([0]))[0, :4] == 0.5).all()


def test_looks_that_are_not_sure_add_up() -> None:
    agent = Agent(GRID, seed=0)
    for looks in range(1, 5):
        agent.step({"sight": 1, "open": [0.8, 0.2, True, 0.5, True], "taken": "stay"})
        odds = 4.0**looks
        blocked = agent.map.blocked(np.array([0]))[0]
        np.testing.assert_allclose(
            blocked[[0, 1, 3]], [1 / (1 + odds), odds / (1 + odds), 0.5], atol=0.16
        )  # a look may be wrong, and ways are open mostly


def test_staying_is_always_open() -> None:
    agent = Agent(GRID, seed=0)
    agent.step({"sight": 1, "open": [False] * 5})
    assert agent.trace[0].open == (False, False, False, False, True)


# -- what was not seen, or not for sure ------------------------------------------------------------------------


def walls(*open_: str) -> list[bool]:
    return [name in (*open_, "stay") for name in GRID]


def test_what_was_not_seen_teaches_nothing() -> None:
    agent = Agent(GRID, sensors=[Sight(), Sight("smell"), Ways()], seed=0)
    agent.step({"sight": UNSEEN, "smell": "tea", "open": walls("right")})
    assert agent.trace[0].sensed == {"smell": "tea"}
    assert agent.trace[0].sight is None
    assert (len(agent.map.sights), agent.map.A_o.total(np.array([0])).item()) == (0, 0.0)
    assert [variable.name for variable in agent.graph.variables if variable.observed] == []
    agent.step({"sight": "hall", "smell": UNSEEN, "open": walls("left"), "taken": "right"})
    assert [variable.name for variable in agent.graph.variables if variable.observed] == ["o1", "c1"]
    assert agent.map.position(agent.belief.place) == (0, 1)


def test_none_is_a_label_where_it_is_declared() -> None:
    agent = Agent(GRID, sensors=[Sight(labels=[None, "red"]), Ways()], seed=0)
    assert list(agent.map.sights) == [None, "red"]
    agent.step({"sight": None, "open": OPEN})
    agent.step({"sight": {None: 2.0, "blue": 1.0}, "open": OPEN})
    assert agent.trace[0].sensed == {"sight": None}
    assert agent.trace[1].sight == ((None, 1.0), ("blue", 0.5))


def test_declared_labels_are_kept_in_files(tmp_path: Path) -> None:
    agent = Agent(GRID, sensors=[Sight(labels=[None, (1, 2)]), Ways()], seed=0)
    agent.step({"sight": {"red": 0.5, None: 0.5}, "open": [0.9, None, False, True, True]})
    agent.save(tmp_path / "agent.npz")
    again = Agent.load(tmp_path / "agent.npz")
    assert list(again.map.sights) == [None, (1, 2), "red"]
    seen = {"sight": None, "open": UNSEEN}
    assert again.step(seen) == agent.step(seen)
    assert again.belief.places == agent.belief.places


@pytest.mark.parametrize(
    ("labels", "message"), [("red", "labels are 'red'; give a list"), (3, "are 3; give"), ([[1]], "not hashable")]
)
def test_what_is_no_list_of_labels_cannot_be_declared(labels: Any, message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        Sight(labels=labels)


def test_one_likelihood_alone_is_the_label() -> None:
    sure, likely = Agent(GRID, seed=0), Agent(GRID, seed=0)
    sure.step({"sight": "hall", "open": OPEN})
    likely.step({"sight": {"hall": 0.3, "room": 0}, "open": OPEN})
    assert likely.trace == sure.trace
    assert list(likely.map.sights) == ["hall"]


def test_only_ratios_of_likelihoods_count() -> None:
    one, other = Agent(GRID, seed=0), Agent(GRID, seed=0)
    one.step({"sight": {"hall": 0.5, "room": 0.125}, "open": OPEN})
    other.step({"sight": {"hall": np.float32(4e30), "room": 10**30}, "open": OPEN})
    assert other.trace[0].sight == (("hall", pytest.approx(1.0)), ("room", pytest.approx(0.25)))
    np.testing.assert_allclose(one.map.A_o.dense(2), other.map.A_o.dense(2), rtol=1e-6)


def test_likelihoods_teach_by_posteriors() -> None:
    agent = Agent(GRID, seed=0)
    agent.step({"sight": {"hall": 0.75, "room": 0.25}, "open": OPEN})
    np.testing.assert_allclose(agent.map.A_o.dense(2)[:2, 0], [0.75, 0.25], atol=1e-6)
    agent.step({"sight": {"hall": 0.75, "room": 0.25}, "open": OPEN, "taken": "stay"})
    np.testing.assert_allclose(agent.map.A_o.dense(2)[:2, 0], [(0.75 + 0.9) / 2, (0.25 + 0.1) / 2], atol=1e-6)


# -- what was really done --------------------------------------------------------------------------------------


@pytest.mark.parametrize("said", [3, "right", np.int64(3)])
def test_an_agent_that_was_led_elsewhere_knows_where_it_is(said: Any) -> None:
    agent = Agent(GRID, seed=0)
    agent.step({"sight": "hall", "open": [False, False, False, True, True]})
    agent.step({"sight": "room", "open": [False, False, True, False, True], "taken": said})
    assert agent.map.position(agent.belief.place) == (0, 1)
    assert agent.belief.moved < 0.01


@pytest.mark.parametrize("said", [5, -1, "north", None, True, 1.0, [3]])
def test_what_is_no_action_cannot_have_been_taken(said: Any) -> None:
    agent = Agent(GRID, seed=0)
    agent.step({"sight": 1, "open": OPEN})
    with pytest.raises(CogmapError, match=r"observation: 'taken' is .*; give an action by name or index: up, down"):
        agent.step({"sight": 1, "open": OPEN, "taken": said})
    assert agent.steps == 1


def test_one_perceives_plans_and_acts_in_turn() -> None:
    whole, parts = Agent(GRID, seed=3), Agent(GRID, seed=3)
    for sight in (1, 2, 1):
        seen = {"sight": sight, "open": OPEN}
        action = whole.step(seen)
        assert parts.perceive(seen) is parts.belief
        assert parts.plan.action == parts.act() == action
        assert whole.trace == parts.trace
    with pytest.raises(CogmapError, match=r"perceived nothing since its last action; call perceive\(observation\)"):
        parts.act()
    parts.perceive(seen)
    with pytest.raises(CogmapError, match=r"not acted on the last observation; call act\(\), or say what was 'taken'"):
        parts.perceive(seen)
    parts.perceive({**seen, "taken": "stay"})
    assert parts.steps == 5


def test_what_the_body_says_of_a_move_is_believed() -> None:
    for outcome, there in (("arrived", (0, 1)), ("blocked", (0, 0)), ("unsure", (0, 1))):
        agent = Agent(GRID, seed=0)
        agent.step({"sight": "hall", "open": walls("right", "left")})
        agent.step({"sight": UNSEEN, "open": UNSEEN, "taken": "right", "outcome": outcome})
        assert agent.map.position(agent.belief.place) == there


def test_an_agent_that_is_told_that_it_was_moved_believes_it() -> None:
    agent, told = Agent(GRID, seed=0), Agent(GRID, seed=0)
    for each in (agent, told):
        each.step({"sight": "hall", "open": walls("right")})
        each.step({"sight": "room", "open": walls("left"), "taken": "right"})
    agent.step({"sight": UNSEEN, "open": UNSEEN, "taken": "stay"})
    told.step({"sight": UNSEEN, "open": UNSEEN, "taken": "stay", "moved": np.bool_(True)})
    assert agent.belief.moved < 0.01
    assert told.belief.moved == pytest.approx(1.0)
    assert told.belief.certainty <= 0.5  # into the other room, or one never seen
    told.step({"sight": "hall", "open": walls("right"), "taken": "stay"})
    assert told.map.position(told.belief.place) == (0, 0)


def test_an_agent_follows_a_walk_that_was_recorded() -> None:
    walk = [
        {"sight": "hall", "open": walls("right")},
        {"sight": "room", "open": [None, False, True, True, True], "taken": "right"},
        {"sight": "hall", "open": [False, 0.1, 0.2, 0.9, True], "taken": "left"},
    ]
    agent = Agent(GRID, seed=0)
    steps = list(agent.follow(walk))
    assert [step.step for step in steps] == [0, 1, 2]
    assert [step.ways for step in steps] == [(3,), (0, 2, 3), (3,)]
    assert [step.probability.sum() for step in steps] == pytest.approx([1.0] * 3)
    assert steps[-1].belief is agent.belief
    assert agent.map.position(agent.belief.place) == (0, 0)
    with pytest.raises(CogmapError, match="not acted on the last observation"):
        list(agent.follow([{"sight": "hall", "open": UNSEEN}]))
