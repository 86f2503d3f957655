"""Saved agents walk on exactly; files that are none say so in one line."""

from __future__ import annotations

import copy
import io
import json
import os
from collections.abc import Callable, Hashable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent, Settings
from cogmap.model import CogmapError, decode
from cogmap.worlds import MazeEnv, load_world
from parts import agent_with
from walks import GRID, assert_agent_is_sound, assert_same_belief, assert_same_map, walk, walked

from cogmap import UNSEEN

LABELS: dict[str, Callable[[int], Hashable]] = {
    "int": lambda sight: sight,
    "str": lambda sight: f"room \u00e9\u2603 {sight}\n",
    "tuple": lambda sight: ("room", (sight, None), 0.1 + sight, True),
    "unseen": lambda sight: UNSEEN if sight == 0 else sight,
    "float": lambda sight: sight / 3.0,
}


def relabelled(name: str) -> Callable[[dict[str, Any]], dict[str, Any]]:
    return lambda observation: {**observation, "sight": LABELS[name](int(observation["sight"]))}


def assert_walks_on_alike(
    world: MazeEnv, one: Agent, other: Agent, observe: Any, steps: int, *, taken: int = 0
) -> None:
    """Both get the same observations, silent moves included, and must do, believe and learn the same."""
    rng = np.random.default_rng(9)
    observation = world.observe()
    for k in range(steps):
        if k % 5 == 2:
            observation = world.displace(world.maze.rooms[int(rng.integers(len(world.maze.rooms)))])
        actions = [agent.step({**observe(observation), "taken": taken}) for agent in (one, other)]
        assert actions[0] == actions[1]
        assert one.trace[-1] == other.trace[-1]
        assert_same_belief(one, other)
        assert_same_map(one.map, other.map)
        np.testing.assert_array_equal(one.plan.probability, other.plan.probability)
        taken = actions[0]
        observation, *_ = world.step(taken)


CASES = [
    ("3x3_alias", {"certainty": 0.99}, "int"),
    ("4x4_alias", {"choice": "sampled", "engine": "gtsam", "certainty": 0.99}, "str"),
    ("t_maze_alias", {"forgetting": 0.01, "certainty": 0.99}, "tuple"),
    ("donut", {"policies": "self_avoiding", "window": 3}, "unseen"),
    ("3x3_alias", {"growth": "observed"}, "float"),
    ("3x3_alias", {"growth": "static", "places": 80}, "str"),
]


@pytest.mark.parametrize(("name", "options", "labels"), CASES)
def test_a_loaded_agent_walks_on_exactly(name: str, options: dict[str, Any], labels: str, tmp_path: Path) -> None:
    world, observe = load_world(name), relabelled(labels)
    agent = agent_with(world.motions, look_ahead=2, **options, seed=3)
    agent.prefer({observe({"sight": 3})["sight"]: 0.5, "never met": 0.1})
    saved, uncertain, file = 0, 0, tmp_path / "map.npz"
    steer = options.get("growth") is not None
    for k, action in enumerate(walk(world, agent, 30, seed=3, displace_every=4, steer=steer, observe=observe)):
        unsure = not agent.certain
        if k not in (0, 7, 20) and not (unsure and uncertain < 2):
            continue
        uncertain, saved = uncertain + unsure, saved + 1
        agent.save(file)
        here, original = copy.deepcopy(world), copy.deepcopy(agent)
        here.step(action)
        loaded = Agent.load(file)
        assert loaded.settings == agent.settings
        assert (loaded.steps, loaded.certain) == (agent.steps, agent.certain)
        assert repr(loaded) == repr(agent)
        assert_same_map(agent.map, loaded.map)
        assert_same_belief(agent, loaded)
        assert repr(loaded.graph) == repr(agent.graph)
        assert_walks_on_alike(here, original, loaded, observe, 8, taken=action)
    assert saved >= 3
    if "certainty" in options:
        assert uncertain, "the walk was meant to be uncertain at times"


def test_an_agent_that_saw_nothing_is_saved_too(tmp_path: Path) -> None:
    world = load_world("3x3")
    agent = Agent(world.motions, seed=5)
    agent.save(tmp_path / "new")  # no suffix is added
    loaded = Agent.load(tmp_path / "new")
    assert os.listdir(tmp_path) == ["new"]
    with pytest.raises(CogmapError, match="seen nothing yet"):
        _ = loaded.belief
    world.reset(seed=1)
    assert_walks_on_alike(world, agent, loaded, lambda observation: observation, 6)


def test_state_is_a_snapshot() -> None:
    world = load_world("3x3_alias")
    agent = walked(world, 10)
    header, arrays = agent.state()
    twin = Agent.from_state(header, arrays)
    before = json.dumps(header), {name: values.copy() for name, values in arrays.items()}
    for _ in walk(world, agent, 10):
        pass
    assert json.dumps(header) == before[0]
    for name, values in before[1].items():
        np.testing.assert_array_equal(arrays[name], values, err_msg=name)
    assert_same_map(twin.map, Agent.from_state(header, arrays).map)


def test_a_saved_agent_can_be_saved_again(tmp_path: Path) -> None:
    agent = walked(load_world("3x3"), 12)
    agent.save(str(tmp_path / "a.npz"))
    Agent.load(str(tmp_path / "a.npz")).save(tmp_path / "b.npz")
    assert_same_map(Agent.load(tmp_path / "b.npz").map, agent.map)
    assert (tmp_path / "a.npz").read_bytes()[:2] == b"PK"
    assert np.load(tmp_path / "a.npz", allow_pickle=False)["header"].dtype == np.uint8


def test_numpy_numbers_in_settings_and_goals_are_saved(tmp_path: Path) -> None:
    world = load_world("3x3")
    agent = Agent(world.motions, settings=Settings(look_ahead=np.int64(2)), seed=0)  # type: ignore[arg-type]
    agent.prefer({3: np.float32(0.5)})  # type: ignore[dict-item]
    agent.step(world.reset(seed=0)[0])
    agent.save(tmp_path / "map.npz")
    assert Agent.load(tmp_path / "map.npz").settings == agent.settings


# -- files that are no saved agents ----------------------------------------------------------------------------


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("saved") / "map.npz"
    agent = walked(load_world("3x3_alias"), 12, displace_every=11, window=2)
    agent.save(path)
    return path


def packed(arrays: dict[str, Any]) -> bytes:
    file = io.BytesIO()
    np.savez(file, **arrays)
    return file.getvalue()


def headed(header: Any) -> bytes:
    text = header if isinstance(header, str) else json.dumps(header)
    return packed({"header": np.frombuffer(text.encode(), dtype=np.uint8)})


def npy() -> bytes:
    file = io.BytesIO()
    np.save(file, np.arange(3))
    return file.getvalue()


NOT_SAVED: dict[str, tuple[bytes, str]] = {
    "empty": (b"", "no saved agent, or truncated"),
    "text": (b"0 1 2\n3 4 5\n", "no saved agent, or truncated"),
    "binary": (bytes(range(256)), "no saved agent, or truncated"),
    "pickle": (b"\x80\x04\x95", "no saved agent, or truncated"),
    "half a zip": (b"PK\x03\x04", "no saved agent, or truncated"),
    "one array": (npy(), "a single array"),
    "no header": (packed({"a": np.arange(3)}), "no header"),
    "no arrays": (packed({}), "no header"),
    "a header of objects": (packed({"header": np.array([{"a": 1}], dtype=object)}), "no array of numbers"),
    "a header of text": (headed("{"), "no header"),
    "a header of numbers": (headed([1, 2]), "no header"),
    "a header of None": (headed(None), "no header"),
    "an empty header": (headed({}), "no header"),
    "no schema": (headed({"format": "cogmap agent"}), "no header"),
    "a schema of words": (headed({"format": "cogmap agent", "schema": "new"}), "no header"),
    "an infinite schema": (headed('{"format": "cogmap agent", "schema": 1e999}'), "no header"),
    "a newer schema": (headed({"format": "cogmap agent", "schema": 5}), "schema 5, newer than 4; update cogmap"),
    "an older schema": (headed({"format": "cogmap agent", "schema": 1}), "schema 1, older than 2; explore"),
    "another format": (headed({"format": "other\nthing", "schema": 2}), "is a 'other.*thing', no saved agent"),
    "a header alone": (headed({"format": "cogmap agent", "schema": 2}), "is damaged"),
}


def refused_in_one_line(path: Path) -> bool:
    """Whether the file is refused; any other error than `CogmapError` escapes."""
    try:
        Agent.load(path)
    except CogmapError as error:
        return "\n" not in str(error) or pytest.fail(str(error))
    return False


def assert_refused(path: Path, message: str) -> None:
    with pytest.raises(CogmapError, match=message) as raised:
        Agent.load(path)
    assert str(raised.value).startswith(f"load: {path}")
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize("name", NOT_SAVED)
def test_what_is_no_saved_agent(name: str, tmp_path: Path) -> None:
    content, message = NOT_SAVED[name]
    path = tmp_path / "map.npz"
    path.write_bytes(content)
    assert_refused(path, message)


def test_no_file(tmp_path: Path) -> None:
    with pytest.raises(CogmapError, match=r"load: there is no file .*none\.npz; give a file that save wrote"):
        Agent.load(tmp_path / "none.npz")
    assert_refused(tmp_path, "no saved agent")


def test_truncated_at_any_length(saved: Path, tmp_path: Path) -> None:
    content, path = saved.read_bytes(), tmp_path / "short.npz"
    lengths = {1, 10, 100, *range(0, len(content), len(content) // 12), *range(len(content) - 40, len(content), 7)}
    for length in sorted(lengths):
        path.write_bytes(content[:length])
        assert_refused(path, "no saved agent, or truncated")


def test_flipped_bits_never_raise_anything_else(saved: Path, tmp_path: Path) -> None:
    content, path, rng = saved.read_bytes(), tmp_path / "flipped.npz", np.random.default_rng(0)
    refused = 0
    for at in rng.integers(len(content), size=120).tolist():
        damaged = bytearray(content)
        damaged[at] ^= 1 << int(rng.integers(8))
        path.write_bytes(damaged)
        refused += refused_in_one_line(path)
    assert refused > 60


ARRAY_DAMAGE: dict[str, Callable[[np.ndarray], np.ndarray | None]] = {
    "gone": lambda array: None,
    "half": lambda array: array[: len(array) // 2],
    "deeper": lambda array: array[None],
    "a number": lambda array: np.array(1),
    "words": lambda array: np.array(["a"]),
    "NaN": lambda array: array * np.nan,
    "below": lambda array: np.full_like(array, -7) if array.dtype.kind != "b" else array[:0],
}
MAY_PASS = {  # what could have been so
    ("half", "visits.order"),
    ("below", "state.belief.log_likelihood"),
}


@pytest.mark.parametrize("damage", ARRAY_DAMAGE)
def test_damaged_arrays_are_refused(damage: str, saved: Path, tmp_path: Path) -> None:
    with np.load(saved) as file:
        arrays = {name: file[name] for name in file.files}
    path = tmp_path / "damaged.npz"
    for name, array in arrays.items():
        if name == "header":
            continue
        if name.startswith("state.window.0.tables") and damage in ("half", "deeper", "a number"):
            continue  # the oldest slice gives its joint only
        damaged = ARRAY_DAMAGE[damage](array)
        rest = {other: values for other, values in arrays.items() if other != name}
        path.write_bytes(packed(rest if damaged is None else {**rest, name: damaged}))
        if np.array_equal(damaged, array):  # type: ignore[arg-type]
            assert Agent.load(path).steps == 12
        elif not refused_in_one_line(path):
            assert (damage, name) in MAY_PASS, name


def test_belief_and_window_must_be_about_the_map(saved: Path, tmp_path: Path) -> None:
    with np.load(saved) as file:
        arrays = {name: file[name] for name in file.files}
    path = tmp_path / "damaged.npz"
    last = max(int(name.split(".")[2]) for name in arrays if name.startswith("state.window."))
    for name in ("state.belief.message.places", "state.belief.message.positions", f"state.window.{last}.places"):
        path.write_bytes(packed({**arrays, name: arrays[name] + 1000}))
        assert_refused(path, "is damaged")


@pytest.mark.parametrize("wrong", [None, "x", -1, [], {}, [1, 2], {"a": 1}, "DELETE"], ids=str)
def test_damaged_headers_never_raise_anything_else(wrong: Any, saved: Path, tmp_path: Path) -> None:
    with np.load(saved) as file:
        arrays = {name: file[name] for name in file.files}
    header = json.loads(arrays["header"].tobytes())
    path, refused = tmp_path / "damaged.npz", 0
    for name in header:
        damaged = {key: value for key, value in header.items() if key != name or wrong != "DELETE"}
        if wrong != "DELETE":
            damaged[name] = wrong
        path.write_bytes(packed({**arrays, "header": np.frombuffer(json.dumps(damaged).encode(), dtype=np.uint8)}))
        refused += refused_in_one_line(path)
    assert refused >= 5


# -- saving ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("label", [frozenset({1}), b"bytes", 1j, ("a", frozenset()), float("inf")])
def test_labels_that_cannot_be_written(label: Hashable, tmp_path: Path) -> None:
    agent = Agent(GRID, seed=0)
    agent.step({"sight": label, "open": [True] * 5})
    with pytest.raises(CogmapError, match=r"save: cannot write label .*; label with") as raised:
        agent.save(tmp_path / "map.npz")
    assert "\n" not in str(raised.value)
    assert not os.listdir(tmp_path)


def test_settings_that_cannot_be_written(tmp_path: Path) -> None:
    agent = Agent(GRID, seed=0)
    object.__setattr__(agent.settings, "precision", float("inf"))
    with pytest.raises(CogmapError, match=r"^save: .*plain finite values$"):
        agent.save(tmp_path / "map.npz")
    object.__setattr__(agent.settings, "precision", object())
    with pytest.raises(CogmapError, match=r"^save: cannot write <object"):
        agent.save(tmp_path / "map.npz")


def test_saving_into_no_folder(tmp_path: Path) -> None:
    agent = Agent(GRID, seed=0)
    (tmp_path / "file").write_text("x")
    for folder in ("missing", "file"):
        with pytest.raises(CogmapError, match=r"cannot write .*; choose another file") as raised:
            agent.save(tmp_path / folder / "map.npz")
        assert "\n" not in str(raised.value)
    (tmp_path / "folder").mkdir()
    with pytest.raises(CogmapError, match=r"cannot write .*; choose another file"):
        agent.save(tmp_path / "folder")
    assert sorted(os.listdir(tmp_path)) == ["file", "folder"]


@pytest.mark.skipif(
    os.name == "nt" or not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write anywhere"
)
def test_saving_into_a_folder_without_permission(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    try:
        with pytest.raises(CogmapError, match=r"cannot write"):
            Agent(GRID, seed=0).save(tmp_path / "map.npz")
    finally:
        tmp_path.chmod(0o700)


@pytest.mark.parametrize("failure", [OSError(28, "No space left on device"), MemoryError(), KeyboardInterrupt()])
def test_a_failure_in_the_middle_leaves_the_old_file(
    failure: BaseException, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = load_world("3x3")
    agent = walked(world, 5)
    path = tmp_path / "map.npz"
    agent.save(path)
    before = path.read_bytes()

    def fail(file: Any, **arrays: Any) -> None:
        file.write(b"half of it")
        raise failure

    for _ in walk(world, agent, 3):
        pass
    with monkeypatch.context() as patched:
        patched.setattr(np, "savez", fail)
        with pytest.raises(CogmapError if isinstance(failure, OSError) else type(failure)):
            agent.save(path)
    assert os.listdir(tmp_path) == ["map.npz"]
    assert path.read_bytes() == before
    agent.save(path)
    loaded = Agent.load(path)
    assert loaded.steps == 8
    loaded.step(world.observe())
    assert_agent_is_sound(loaded)


# -- files of before -------------------------------------------------------------------------------------------

OF_BEFORE = Path(__file__).parent / "saved"


@pytest.mark.parametrize("name", ["predicted", "static", "observed"])
def test_an_agent_saved_by_an_earlier_version_walks_on(name: str) -> None:
    agent = Agent.load(OF_BEFORE / f"schema2_{name}.npz")
    steps = json.loads((OF_BEFORE / f"schema2_{name}.json").read_text())
    taken: dict[str, int] = {}
    for sight, open_, action, evidence, moved, places, G, retracted, learned in steps:
        chosen = agent.step({"sight": decode(sight), "open": open_, **taken})
        record = agent.trace[-1]
        if retracted is not None or record.doubt > 1e-3:
            break  # from here on hypotheses about the map decide, which it did not have
        assert record.evidence == pytest.approx(evidence, abs=1e-9)
        assert record.moved == pytest.approx(moved, abs=1e-9)
        assert record.places == pytest.approx(dict(places), abs=1e-9)
        assert sum(update.amount for update in record.learned) == pytest.approx(learned, abs=1e-9)
        if name == "static":  # what is worth more, further off, is among its policies now; it is led as it went then
            taken = {"taken": action}
        else:
            assert chosen == action
            assert record.G["G"] == pytest.approx(G, abs=1e-9)
    assert_agent_is_sound(agent)
