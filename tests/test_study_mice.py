"""The study `mice`, on simulated individuals; with the recordings where they are at hand."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Settings
from cogmap.behaviour import MODELS, Ground, Route
from cogmap.experiments.studies import run_study, study_named
from cogmap.experiments.studies.mice import Mice
from cogmap.experiments.studies.mice_facts import (
    agent_trip,
    ends_of,
    explored,
    labyrinth,
    recorded,
    trips_of,
)
from shared import shared

LOOK = Settings(look_ahead=3)
TO_116 = [127, 0, 2, 6, 13, 28, 57, 116]  # (node - 1) // 2 lies above each


@pytest.fixture(scope="module")
def ground() -> Ground:
    return labyrinth()


def walk(ground: Ground, *nodes: int) -> Any:
    places = [ground.find(node, "here") for node in nodes]
    return Route("a", np.array(places), np.zeros(len(places), dtype=np.int64))


def test_the_labyrinth_has_64_ends_and_a_home(ground: Ground) -> None:
    assert len(ground.places) == 128
    ends = [ground.places[i] for i, ways in enumerate(ground.ways) if len(ways) == 1]
    assert sorted(ends) == list(range(63, 128))
    assert ground.distances(ground.home or 0)[ground.find(116, "here")] == 7


def test_the_agent_finds_every_end_once(ground: Ground, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COGMAP_RECORDINGS", "/nowhere")
    recorded.cache_clear()
    found = ends_of(explored(0, LOOK, most=400), ground)
    assert (found.half, found.efficiency) == (32, 1.0)
    assert found.steps_to_all is not None
    recorded.cache_clear()


def test_ends_are_counted_as_they_are_visited(ground: Ground) -> None:
    found = ends_of(walk(ground, 127, 0, 1, 3, 7, 15, 31, 63, 31, 63, 31, 64).places.tolist(), ground)
    assert found.new == (1, 1, 2)
    assert (found.half, found.efficiency, found.steps_to_all) == (None, None, None)


def test_trips_are_direct_where_they_are(ground: Ground) -> None:
    there, back = TO_116, TO_116[-2::-1]
    detour = [127, 0, 1, 0, *TO_116[2:]]
    route = walk(ground, *there, *back, *there[1:], *back, *detour[1:], *back, 0, 127)
    trips = trips_of(route, ground)
    assert trips is not None
    assert (trips.to_port, trips.home) == ((2, 1), (2, 2))
    assert agent_trip(route, ground, LOOK) == (7, 7)
    assert trips_of(walk(ground, 127, 0), ground) is None


def test_without_recordings_it_says_so_and_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COGMAP_RECORDINGS", "/nowhere")
    recorded.cache_clear()
    study = Mice(walker_steps=60, recovery_steps=60)
    for module in ("mice", "mice_recovery"):
        monkeypatch.setattr(f"cogmap.experiments.studies.{module}.MODELS", dict(list(MODELS.items())[:2]))
    done = run_study(study, tmp_path, runs=1, look_ahead=1)
    assert "simulated individuals alone" in done.lines[0]
    assert "parameters within two standard errors" in done.lines[-1]
    assert {"mice.json", "mice.md", "mice_exploration.png", "mice_recovery.csv"} <= {path.name for path in done.written}
    recorded.cache_clear()


def test_recorded_animals_are_counted(monkeypatch: pytest.MonkeyPatch, ground: Ground) -> None:
    monkeypatch.setenv("COGMAP_RECORDINGS", str(shared("worlds")))
    recorded.cache_clear()
    found = recorded()
    assert found is not None
    assert (len(found.routes), sum(found.thirsty)) == (12, 7)
    for i, ways in enumerate(found.ground.ways):
        assert {way.target for way in ways} == {way.target for way in ground.ways[i]}
    efficiencies = [ends_of(route.places.tolist(), found.ground).efficiency for route in found.routes]
    assert np.mean([e for e in efficiencies if e is not None]) == pytest.approx(0.325, abs=1e-3)
    assert "fit" in {task[0] for task in study_named("mice").tasks(range(1), LOOK)}
    recorded.cache_clear()
