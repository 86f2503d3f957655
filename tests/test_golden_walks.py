"""Agents walk as they did before the library was rebuilt: some of the golden walks, and all of them with `--study`."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from golden.adapters import Facts
from golden.comparing import first_difference
from golden.record import main as record
from golden.recordings import read_recordings, write_recordings
from golden.walking import Walk, walked
from golden.walks import FEW, GROUPS, RELOADED, WALKS

NAME, STEP = "moved early, donut, seed 1", 12
"""A short walk, and the step of it that teaches most: it takes back what it had learned."""


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    every = metafunc.config.getoption("--study")
    if "golden" in metafunc.fixturenames:
        metafunc.parametrize("golden", list(WALKS) if every else FEW)
    if "reloaded" in metafunc.fixturenames:
        metafunc.parametrize("reloaded", list(RELOADED) if every else list(RELOADED)[:3])


def saved_on_the_way(name: str) -> Walk:
    """The walk, its agent saved and loaded here and there."""
    walk = WALKS[name]
    return replace(walk, events=[*walk.events, *((step, "reload") for step in RELOADED[name])])


def steps_of(name: str) -> list[Facts]:
    """The recorded steps of a walk."""
    return read_recordings()[name][:-1]


def test_golden_walk(golden: str) -> None:
    difference = first_difference(golden, read_recordings()[golden], walked(WALKS[golden]))
    assert difference is None, difference


def test_golden_walk_of_an_agent_that_is_saved_and_loaded(reloaded: str) -> None:
    facts = list(walked(saved_on_the_way(reloaded)))
    assert facts == list(walked(WALKS[reloaded]))
    assert first_difference(reloaded, read_recordings()[reloaded], facts) is None


def test_every_walk_is_recorded_once() -> None:
    assert list(read_recordings()) == list(WALKS)
    assert len(WALKS) == sum(map(len, GROUPS)) >= 64
    assert {name: len(steps_of(name)) for name in WALKS} == {name: walk.steps for name, walk in WALKS.items()}
    assert {*FEW, *RELOADED} <= set(WALKS)


def test_the_recordings_hold_what_matters() -> None:
    walks = {name: steps_of(name) for name in WALKS}
    every = [facts for steps in walks.values() for facts in steps]
    assert sum(any(facts["revised"] for facts in steps) for steps in walks.values()) >= 12
    grown = {kind for facts in every for kind, _ in facts["grown"]}
    assert grown == {"time", "sight", "position", "place", "bind", "retract"}
    assert {change.split()[0] for facts in every for change in facts["learned"]} == {"A_o", "A_p", "B_s"}
    for fact, least, times in [("moved", 0.9, 40), ("doubt", 0.001, 400), ("left_out", 0.01, 1), ("cut", 1, 20)]:
        assert sum(facts[fact] >= least for facts in every) >= times, fact
    assert sum(facts["certainty"] < 0.7 for facts in every) >= 20
    for term in ("state_information", "sight_information", "transition_information", "utility", "collision"):
        assert sum(abs(facts["G"].get(term, 0.0)) > 1e-3 for facts in every) >= 100, term


def first(facts: Any) -> Any:
    return next(iter(facts))


PERTURBED: dict[str, Callable[[Facts], Any]] = {
    "action": lambda facts: facts.update(action=(facts["action"] + 1) % 5),
    "room[0]": lambda facts: facts["room"].__setitem__(0, 99),
    "belief[": lambda facts: facts["belief"].update({first(facts["belief"]): 0.5}),
    "belief[77]": lambda facts: facts["belief"].update({"77": 1e-8}),
    "certainty": lambda facts: facts.update(certainty=facts["certainty"] - 1e-8),
    "doubt": lambda facts: facts.update(doubt=facts["doubt"] + 1e-8),
    "evidence": lambda facts: facts.update(evidence=facts["evidence"] + 1e-7),
    "moved": lambda facts: facts.update(moved=facts["moved"] + 1e-8),
    "dropped": lambda facts: facts.update(dropped=facts["dropped"] + 1e-8),
    "policy": lambda facts: facts["policy"].pop(),
    "policies": lambda facts: facts.update(policies=facts["policies"] + 1),
    "cut": lambda facts: facts.update(cut=facts["cut"] + 1),
    "left_out": lambda facts: facts.update(left_out=None),
    "probability": lambda facts: facts.update(probability=facts["probability"] + 1e-8),
    "G[way_back]": lambda facts: facts["G"].update(way_back=facts["G"]["way_back"] + 1e-8),
    "G[way_there]": lambda facts: facts["G"].pop("way_there"),
    "learned[B_s ": lambda facts: facts["learned"].pop(first(c for c in facts["learned"] if c.startswith("B_s"))),
    "learned[A_o 3 1 -1]": lambda facts: facts["learned"].update({"A_o 3 1 -1": 1e-8}),
    "grown[0][1]": lambda facts: facts["grown"][0].__setitem__(1, 1000),
    "grown ": lambda facts: facts["grown"].append(["place", 5]),
    "revised": lambda facts: facts.update(revised=not facts["revised"]),
}


@pytest.mark.parametrize("field", PERTURBED)
def test_what_differs_is_reported_with_walk_step_and_field(field: str) -> None:
    recorded = deepcopy(read_recordings()[NAME])
    PERTURBED[field](recorded[STEP])
    difference = first_difference(NAME, recorded, read_recordings()[NAME])
    assert difference is not None
    assert difference.startswith(f"golden walk '{NAME}', step {STEP}: {field}")
    assert difference.count(" was ") == 1


@pytest.mark.parametrize("table", ["A_o", "A_p", "B_s"])
def test_a_map_that_differs_is_reported(table: str) -> None:
    recorded = deepcopy(read_recordings()[NAME])
    recorded[-1][table][3] += 1e-7
    difference = first_difference(NAME, recorded, walked(WALKS[NAME]))
    assert difference is not None
    assert difference.startswith(f"golden walk '{NAME}', map at the end: {table}[3] was ")


def test_rounding_is_not_reported() -> None:
    recorded = deepcopy(read_recordings()[NAME])
    for facts in recorded[:-1]:
        facts["evidence"] += 1e-10
        facts["belief"]["77"] = 1e-11
    assert first_difference(NAME, recorded, read_recordings()[NAME]) is None


def test_an_agent_that_walks_otherwise_is_reported() -> None:
    walk = replace(WALKS[NAME], settings={"precision": 16.001})
    difference = first_difference(NAME, read_recordings()[NAME], walked(walk))
    assert difference is not None
    assert ": probability was " in difference or ": G[" in difference


def test_a_walk_of_another_length_is_reported() -> None:
    facts = read_recordings()[NAME]
    shorter, longer = (first_difference(NAME, facts, facts[:5]), first_difference(NAME, facts, [*facts, {}]))
    assert shorter is not None
    assert "step 5: everything was" in shorter
    assert longer == f"golden walk {NAME!r}: goes on after {len(facts) - 1} steps"


def test_recordings_are_not_overwritten_unasked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "walks.json.gz"
    path.write_bytes(b"mine")
    with pytest.raises(SystemExit, match="1"):
        record([], path=path)
    assert path.read_bytes() == b"mine"
    assert "--overwrite" in capsys.readouterr().err


def test_recordings_are_read_as_they_were_written(tmp_path: Path) -> None:
    facts = [{"action": 1, "learned": {"B_s 1 0 2": 7.0}, "retracted": None, "evidence": -1.25}] * 2
    paths = tmp_path / "one.gz", tmp_path / "two.gz"
    for path in paths:
        write_recordings({"walk": [*facts, {"places": 2}]}, path)
    assert read_recordings(paths[0]) == {"walk": [*facts, {"places": 2}]}
    assert paths[0].read_bytes() == paths[1].read_bytes()
