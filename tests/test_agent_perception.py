"""What an agent refuses to see, and what it takes without complaint."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent
from cogmap.model import CogmapError
from walks import GRID

OPEN = [True, False, True, False, True]
NAN = float("nan")

BAD: dict[str, tuple[Any, str]] = {
    "nothing": (None, "is a NoneType; give a mapping"),
    "a list": ([1, OPEN], "is a list; give a mapping"),
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
    "words for doors": ({"sight": 1, "open": ["open"] * 5}, "give truth values"),
    "NaN doors": ({"sight": 1, "open": [NAN] * 5}, "holds float64; give truth values"),
    "doors ajar": ({"sight": 1, "open": [0.5] * 5}, "holds float64; give truth values"),
    "doors of 2": ({"sight": 1, "open": [0, 1, 2, 0, 1]}, "give truth values"),
    "doors of None": ({"sight": 1, "open": [None] * 5}, "holds object; give truth values"),
    "ragged doors": ({"sight": 1, "open": [[True], [True, False], 1, 1, 1]}, "different lengths"),
    "a list to see": ({"sight": [1], "open": OPEN}, "sight is a list, not hashable"),
    "a mapping to see": ({"sight": {"a": 1}, "open": OPEN}, "sight is a dict, not hashable"),
    "an array to see": ({"sight": np.zeros(2), "open": OPEN}, "sight is a ndarray, not hashable"),
    "a list in a tuple": ({"sight": (1, [2]), "open": OPEN}, "sight is a tuple, not hashable"),
    "NaN to see": ({"sight": NAN, "open": OPEN}, "sight is NaN"),
    "numpy's NaN": ({"sight": np.float32("nan"), "open": OPEN}, "sight is NaN"),
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
    assert agent.step({"sight": 1, "open": OPEN}) in range(5)


@pytest.mark.parametrize(
    ("sight", "label"),
    [
        (np.int64(3), 3),
        (np.array(3), 3),
        (np.float64(0.5), 0.5),
        (np.str_("hall"), "hall"),
        (np.bool_(True), True),
        (None, None),
        ("", ""),
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
    ],
)
def test_doors_are_taken_in_any_form(doors: Any) -> None:
    agent = Agent(GRID, seed=0)
    agent.step({"sight": 1, "open": doors, "more": 3})
    assert agent.trace[0].open == tuple(OPEN)


def test_staying_is_always_open() -> None:
    agent = Agent(GRID, seed=0)
    agent.step({"sight": 1, "open": [False] * 5})
    assert agent.trace[0].open == (False, False, False, False, True)


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
