"""Vectors of features: known again by a likelihood, and the prototypes that grow."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent
from cogmap.model import CogmapError, Features, Ways
from cogmap.model.savepoint import go_back, savepoint
from cogmap.worlds import load_world
from walks import GRID

from cogmap import UNSEEN

SIZE, KINDS = 16, 6
OPEN = [True, False, True, False, True]


def agent_with_features(size: int = SIZE, **options: Any) -> tuple[Agent, Features]:
    features = Features("view", size=size, **options)
    return Agent(GRID, sensors=[features, Ways()], seed=0), features


def seen(seed: int, *, noise: float, steps: int = 120, scale: float = 1.0) -> tuple[list[int], list[Any], Features]:
    """What was shown, how it was read, and by which sensor."""
    rng = np.random.default_rng(seed)
    kinds = rng.normal(size=(KINDS, SIZE))
    shown = [*range(KINDS), *rng.integers(KINDS, size=steps).tolist()]
    _, features = agent_with_features()
    vectors = [scale * (kinds[kind] + noise * rng.normal(size=SIZE)) for kind in shown]
    return shown, [features.read(features.check(vector), step=0) for vector in vectors], features


def likeliest(reading: Any) -> int:
    return max(reading, key=reading.get) if isinstance(reading, dict) else reading


@pytest.mark.parametrize("scale", [1.0, 1e-6, 1e6])
@pytest.mark.parametrize("noise", [0.01, 0.1, 0.3, 0.5])
def test_vectors_are_known_again(noise: float, scale: float) -> None:
    for seed in range(5):
        shown, readings, features = seen(seed, noise=noise, scale=scale)
        assert len(features.prototypes) == KINDS
        late = [likeliest(reading) for reading in readings[40:]]
        assert len(set(zip(late, shown[40:], strict=True))) == KINDS
        assert features.spread == pytest.approx(noise * scale, rel=0.1, abs=0.01 * scale)


def test_what_lies_between_two_prototypes_may_be_either() -> None:
    _, features = agent_with_features(size=3)
    rng = np.random.default_rng(0)
    for _ in range(60):
        for centre in ([0.0, 10.0, 0.0], [10.0, 0.0, 0.0], [0.0, 0.0, 10.0]):
            features.read(features.check(centre + 1.5 * rng.normal(size=3)), step=0)
    assert len(features.prototypes) == 3
    told = features.read(np.array([5.2, 4.8, 0.0]), step=0)
    squares = {number: ((mean - [5.2, 4.8, 0.0]) ** 2).sum() for number, mean in features.prototypes.items()}
    least = min(squares.values())
    assert max(told.values()) == 1.0
    for number, square in squares.items():
        expected = np.exp(-0.5 * (square - least) / features.spread**2)
        assert told.get(number, 0.0) == pytest.approx(expected, abs=0.05)
    assert features.label(told)[0][1] == 1.0  # type: ignore[index]


@pytest.mark.parametrize("seed", range(3))
def test_an_agent_maps_rooms_that_it_sees_as_vectors(seed: int) -> None:
    rng, world = np.random.default_rng(seed), load_world("4x4")
    kinds = rng.normal(size=(KINDS, SIZE))
    rooms = sorted(world.unwrapped.maze.rooms)
    shows = dict(zip(rooms, rng.permutation([*range(KINDS), *rng.integers(KINDS, size=10)]).tolist(), strict=True))
    agent, features = agent_with_features()
    observation, info = world.reset(seed=seed)
    start = np.array(info["position"])
    for _ in range(60):
        view = kinds[shows[info["position"]]] + 0.3 * rng.normal(size=SIZE)
        observation, *_, info = world.step(agent.step({"view": view, "open": observation["open"]}))
    assert len(features.prototypes) == KINDS
    assert len(agent.map.places) == 16
    table = agent.map.A_o.dense(len(features.labels))[:-1]
    looks = {
        (shows[room], int(table[:, agent.map.place_at(tuple((np.array(room) - start).tolist()))].argmax()))  # type: ignore[arg-type]
        for room in rooms
    }
    assert len(looks) == KINDS


def test_prototypes_are_kept_in_files(tmp_path: Path) -> None:
    agent, _ = agent_with_features(noise=0.2)
    rng = np.random.default_rng(0)
    views = rng.normal(size=(3, SIZE))
    for at in range(6):
        agent.step({"view": UNSEEN if at == 2 else views[at % 3] + 0.2 * rng.normal(size=SIZE), "open": OPEN})
    agent.save(tmp_path / "agent.npz")
    again = Agent.load(tmp_path / "agent.npz")
    found = again.map.sensors["view"]
    assert isinstance(found, Features)
    assert found.options == {"name": "view", "size": SIZE, "noise": 0.2, "prior": None}
    for at in range(6):
        observation = {"view": views[at % 3] + 0.2 * rng.normal(size=SIZE), "open": OPEN}
        assert again.step(observation) == agent.step(observation)
        assert again.belief.places == agent.belief.places
    kept = agent.map.sensors["view"].prototypes  # type: ignore[attr-defined]
    assert {number: mean.tolist() for number, mean in found.prototypes.items()} == {
        number: mean.tolist() for number, mean in kept.items()
    }


def test_a_step_that_is_broken_off_leaves_prototypes_as_they_were() -> None:
    agent, features = agent_with_features()
    rng = np.random.default_rng(0)
    for _ in range(3):
        agent.step({"view": rng.normal(size=SIZE), "open": OPEN})
    point, before = savepoint(agent.map), features.memory.state()
    for _ in range(8):
        features.read(rng.normal(size=SIZE), step=3)
    assert features.memory.count > len(before["counts"])
    go_back(agent.map, point)
    for name, part in features.memory.state().items():
        np.testing.assert_array_equal(part, before[name])
    assert len(features.labels) == len(before["counts"])
    assert features.table.outcomes == len(features.labels) + 1


def test_prototypes_that_were_tampered_with_are_refused() -> None:
    agent, _ = agent_with_features()
    agent.step({"view": np.arange(SIZE), "open": OPEN})
    header, arrays = agent.state()
    for part, bad in (
        ("counts", np.array([np.nan])),
        ("counts", np.array([-1.0])),
        ("sums", np.zeros((1, 3))),
        ("stray", np.zeros(3)),
        ("first", np.array([0.0, np.inf])),
    ):
        with pytest.raises(CogmapError, match=r"map: view.prototypes .*; save it again"):
            Agent.from_state(header, {**arrays, f"view.prototypes.{part}": bad})


@pytest.mark.parametrize(
    ("view", "message"),
    [
        (None, "view is a NoneType; give 16 numbers, or UNSEEN"),
        ("hall", "view is a str; give 16 numbers"),
        ({"a": 1}, "view is a dict; give 16 numbers"),
        (np.zeros(15), r"shape \(15,\); give 16 numbers"),
        (np.zeros((4, 4)), r"shape \(4, 4\); give 16 numbers"),
        (3.0, r"shape \(\); give 16"),
        (np.full(16, np.nan), "not finite.*; give UNSEEN"),
        ([*range(15), np.inf], "not finite"),
        (np.full(16, 1e200), "above 1e100"),
        (np.ma.masked, "view is masked; give UNSEEN"),
        (np.ma.array(np.zeros(16), mask=[True] + [False] * 15), "view is masked; give UNSEEN"),
        (np.ones(16, dtype=complex) * 1j, "give 16 numbers"),
    ],
)
def test_what_is_no_vector_is_refused_and_changes_nothing(view: Any, message: str) -> None:
    agent, features = agent_with_features()
    with pytest.raises(CogmapError, match=message) as raised:
        agent.step({"view": view, "open": OPEN})
    assert "\n" not in str(raised.value)
    assert (agent.steps, features.memory.count) == (0, 0)
    agent.step({"view": np.arange(16), "open": OPEN})


@pytest.mark.parametrize("options", [{"size": 0}, {"size": 2.0}, {"size": True}, {"size": 2, "noise": 0}, {"size": -1}])
def test_sensors_of_features_that_make_no_sense(options: Any) -> None:
    with pytest.raises(CogmapError, match=r"view: (size|noise) is .*; (give|use)"):
        Features("view", **options)
