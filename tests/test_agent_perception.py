"""What an agent refuses to see, and what it takes without complaint."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent
from cogmap.agent.perception import perceive
from cogmap.model import CogmapError, Motions
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
    found, _ = perceive({"sight": sight, "open": OPEN}, Motions.of(GRID))
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
    assert perceive({"sight": 1, "open": doors, "more": 3}, Motions.of(GRID)) == (1, tuple(OPEN))


def test_staying_is_always_open() -> None:
    assert perceive({"sight": 1, "open": [False] * 5}, Motions.of(GRID))[1] == (False, False, False, False, True)
