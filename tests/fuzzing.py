"""Damage of every kind for files of every kind: bits, ends, and changes whose checksums are right.

`python benchmarks/damage.py` runs the large form, each damaged file within limits of time and memory.
"""

from __future__ import annotations

import gzip
import io
import json
import random
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import networkx as nx
import numpy as np
from cogmap.agent import Agent, Settings
from cogmap.experiments import Ledger
from cogmap.inference import TrackerOptions
from cogmap.inference.hypotheses.storing import _checksum
from cogmap.model import (
    Bearings,
    CogmapError,
    Features,
    NoPose,
    Plane,
    Sight,
    Ways,
    load_graph,
    save_graph,
)
from cogmap.views import Recording, replay_html
from cogmap.worlds import GRID, GraphWorld, ListedWays, MazeEnv, NoisyWorld, WorldError, hall, labyrinth, load_world
from recordings import recorded
from walks import assert_map_is_sound, walked

from cogmap import UNSEEN

WORDS = ["-1", "nan", "inf", "1e999", "10" * 20, "{", "}", '"', "", "x", "(", ";", "|", "\x1b[31m", "9" * 9]
WEIRD: list[Any] = [
    None, True, False, 0, -1, 1, 2, 7, 99, 10**9, -(10**9), 2**62, 2**63, -(2**63), 10**30, 0.5, -0.5, 5.0, -4.0,
    1e-300, 1e300, -1e300, "", "x", "\x1b[31m", "\ud800", "é", [], {}, [1], [[]], {"tuple": []}, {"tuple": [1, 2]},
    {"array": "x"},    {"record": "State"}, {"list": []}, {"pairs": []}, {"pairs": [[1, 2]]},
]  # fmt: skip
NUMBERS = [0.0, -1.0, 1.0, 0.5, 5.0, -4.0, 99.0, 1e9, -1e9, 2.0**31, 2.0**62, 1e300, -1e300, np.inf, -np.inf, np.nan]

Damage = Callable[[bytes, random.Random], bytes]


def flipped(content: bytes, rng: random.Random) -> bytes:
    """One bit is another, or a few are."""
    damaged = bytearray(content)
    for _ in range(rng.choice([1, 1, 1, 2, 8])):
        damaged[rng.randrange(len(damaged))] ^= 1 << rng.randrange(8)
    return bytes(damaged)


def truncated(content: bytes, rng: random.Random) -> bytes:
    """The end is missing."""
    return content[: rng.randrange(len(content))]


def changed_text(content: bytes, rng: random.Random) -> bytes:
    """A word is another, gone, or there again; lines are out of order."""
    words = content.decode("latin1").split(" ")
    at, other = rng.randrange(len(words)), rng.randrange(len(words))
    what = rng.randrange(5)
    if what == 0:
        words[at] = rng.choice(
            ["-1", "nan", "inf", "1e999", "10" * 20, "{", "}", '"', "", "x", "(", ";", "|", "\x1b[31m"]
        )
    elif what == 1:
        del words[at]
    elif what == 2:
        words.insert(at, words[other])
    elif what == 3:
        words[at], words[other] = words[other], words[at]
    else:
        words[at] += words[other]
    return " ".join(words).encode("latin1")


def changed_json(content: bytes, rng: random.Random) -> bytes:
    """One value anywhere is another, or gone."""
    value = json.loads(content)
    spoil(value, rng)
    return json.dumps(value).encode()


def changed_gzip(content: bytes, rng: random.Random) -> bytes:
    """The same within gzip."""
    return gzip.compress(changed_json(gzip.decompress(content), rng))


def changed_lines(content: bytes, rng: random.Random) -> bytes:
    """The same in one line of JSON."""
    lines = content.splitlines(keepends=True)
    at = rng.randrange(len(lines))
    lines[at] = changed_json(lines[at], rng) + b"\n"
    return b"".join(lines)


def changed_agent(content: bytes, rng: random.Random) -> bytes:
    """An array or the header of a saved agent is another, with the right checksum."""
    with np.load(io.BytesIO(content)) as file:
        arrays = {name: file[name] for name in file.files}
    header = json.loads(arrays["header"].tobytes())
    what, name = rng.random(), rng.choice([name for name in arrays if name != "header"])
    if what < 0.3:
        spoil(header, rng)
    elif what < 0.6 and "tracker.whole" in arrays:  # the hypotheses, of which there are two arrays alone
        name = rng.choice(["tracker.whole", "tracker.real"])
        arrays |= {name: _nudged(arrays[name], rng)}
    else:
        arrays |= {name: _spoiled(arrays[name], rng)}
    _seal(header, arrays)
    arrays["header"] = np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)
    file = io.BytesIO()
    (np.savez_compressed if rng.random() < 0.1 else np.savez)(file, **arrays)
    return file.getvalue()


def _seal(header: dict[str, Any], arrays: dict[str, np.ndarray]) -> None:
    """Give the hypotheses the checksum of what they are now."""
    try:
        tracker = header["recognition"]["tracker"]
        tracker["check"] = _checksum(tracker, {name: arrays[f"tracker.{name}"] for name in ("whole", "real")})
    except (AttributeError, KeyError, TypeError, ValueError):
        return  # they are none any more


def _nudged(array: np.ndarray, rng: random.Random) -> np.ndarray:
    """A number is another of its kind, or that of somewhere else."""
    array, at = array.copy(), rng.randrange(array.size)
    with np.errstate(all="ignore"):
        others = [array[at] + 1, array[at] - 1, -array[at], 2 * array[at], array[rng.randrange(array.size)]]
        array[at] = np.array(rng.choice([*others, rng.choice(NUMBERS)])).astype(array.dtype)
    return array


def _spoiled(array: np.ndarray, rng: random.Random) -> np.ndarray:
    what = rng.randrange(8)
    if what == 0:
        return array[: rng.randrange(len(array) + 1)] if array.ndim else array
    if what == 1:
        return np.concatenate([array, array]) if array.ndim else array
    if what == 2:
        return array.astype(rng.choice([np.float64, np.int64, np.int8, np.uint8, np.bool_, np.float32]))
    if what == 3:
        return array.reshape(rng.choice([(-1,), (1, -1), (-1, 1)]))
    if not array.size:
        return array
    array = array.copy()
    for _ in range(rng.choice([1, 1, 3])):
        at = rng.randrange(array.size)
        value = array.flat[rng.randrange(array.size)] if rng.random() < 0.4 else rng.choice(NUMBERS)
        with np.errstate(all="ignore"):
            array.flat[at] = np.array(value).astype(array.dtype)
    return array


def spoil(value: Any, rng: random.Random) -> None:
    """Change one thing within a value of JSON, in place."""
    while True:
        keys: list[Any] = list(value) if isinstance(value, dict) else list(range(len(value)))
        if not keys:
            return
        key = rng.choice(keys)
        inside = value[key]
        if isinstance(inside, dict | list) and inside and rng.random() < 0.93:
            value = inside
            continue
        what = rng.random()
        if what < 0.1:
            del value[key]
        elif what < 0.2 and isinstance(value, list):
            value.insert(rng.randrange(len(value) + 1), inside)
        elif what < 0.4 and isinstance(inside, int | float):
            value[key] = inside + rng.choice([1, -1, 0.5, 1000])
        else:
            value[key] = rng.choice(WEIRD)
        return


# -- what is tried with a damaged file -------------------------------------------------------------------------


FEW = TrackerOptions(most=3, folded=0)
RANDOM = 10
"""Steps at which what is sensed is drawn at random; then the agent stays, or each step would bring more doubt."""


def try_agent(path: Path, *, steps: int = 12, light: bool = False, loaded: Callable[[], object] = bool) -> None:
    """Load it, say so, and walk on; if it is to be light it looks one step ahead, with few hypotheses."""
    agent = Agent.load(path)
    loaded()
    if light:
        few = replace(agent.settings, look_ahead=1, hypotheses=FEW)
        agent = Agent.load(path, settings=few)
    rng = np.random.default_rng(0)
    sensed: dict[str, Any] = {}
    for step in range(steps):
        if step < RANDOM:
            sensed = {name: _sensed(sensor, agent, rng) for name, sensor in agent.map.sensors.items()}
        agent.step(sensed if step < RANDOM else {**sensed, "taken": agent.map.motions.stay})
        assert np.isclose(agent.belief.message.mass.sum(), 1.0)
        assert np.isfinite(agent.trace[-1].evidence)
        assert agent.hypotheses or not agent._recognising
    if len(agent.map.places) < 200:
        assert_map_is_sound(agent.map)


def _sensed(sensor: Any, agent: Agent, rng: np.random.Generator) -> Any:
    """What some sensor may have sensed."""
    actions = len(agent.map.motions)
    if isinstance(sensor, Ways):
        return [*(rng.random(actions - 1) < 0.6).tolist(), True]
    if isinstance(sensor, Bearings):
        return [None if rng.random() < 0.5 else float(rng.integers(8) * 45) for _ in range(actions)]
    return rng.normal(size=sensor.size) if isinstance(sensor, Features) else int(rng.integers(4))


def try_recording(path: Path) -> None:
    """Load it, go through its maps, and make a page."""
    recording = Recording.load(path)
    assert sum(1 for _ in recording.maps()) == len(recording)
    assert recording.places is not None
    assert recording.sights is not None
    assert "</html>" in replay_html(recording)


def try_ledger(path: Path) -> None:
    """Open it, and go on."""
    with Ledger(path) as ledger:
        ledger.begin(dict, made="here")
        ledger.append({"seed": 99})


def try_graph(path: Path) -> None:
    """Read a graph of factors, and write it as JSON."""
    assert load_graph(path).to_json()


def try_world(path: Path) -> None:
    """Load a world, and be in it."""
    world = load_world(path)
    observation, _ = world.reset(seed=0)
    assert observation


# -- files to damage -------------------------------------------------------------------------------------------


def agent_file(path: Path, places: int) -> None:
    """A saved agent that knows about so many places; of large mazes it was given the map."""
    if places <= 16:
        walked(load_world("4x4_alias"), 30, displace_every=9).save(path)
        return
    maze = labyrinth(places, rng=np.random.default_rng(0))
    agent, world = Agent(GRID, map=maze.to_networkx(), seed=0), MazeEnv(maze)
    observation, _ = world.reset(options={"start": maze.rooms[0]})
    for _ in range(5):
        observation, *_ = world.step(agent.step(observation))
    agent.save(path)


def doubting(path: Path) -> None:
    """One that errs in everything, and has many hypotheses."""
    world: Any = NoisyWorld(load_world("4x4_alias"), sight=0.1, door=0.1, slip=0.1, fail=0.1, moved=0.05)
    agent, _ = _led(world, Agent(world.motions, seed=0), 60)
    assert len(agent.hypotheses) > 3
    agent.save(path)


def lost(path: Path) -> None:
    """One that was moved, in a hall where that leaves many places."""
    maze = hall(6, 6, sights=2, rng=np.random.default_rng(1))
    world = MazeEnv(maze)
    agent, _ = _led(world, Agent(world.motions, seed=0), 60)
    for room in maze.rooms:
        agent.step({**world.displace(room), "moved": True})
        if agent._recognition.lost:
            break
    assert agent._recognition.lost
    agent.save(path)


def told(path: Path) -> None:
    """One that is told all that a percept can say, of two sensors of labels and one of vectors."""
    world, rng = load_world("3x3_alias"), np.random.default_rng(0)
    kinds = rng.normal(size=(3, 4))
    sensors = [Sight(), Sight("smell"), Features("view", size=4), Ways()]
    agent = Agent(world.motions, sensors=sensors, settings=Settings(look_ahead=3), seed=0)
    agent.prefer({1: 0.5}, sensors={"smell": {"b": 2.0}})

    def see(seen: dict[str, Any]) -> dict[str, Any]:
        number = int(seen["sight"])
        soft = {number: 0.7, (number + 1) % 5: 0.3} if rng.random() < 0.5 else number
        smell = UNSEEN if rng.random() < 0.3 else "abc"[number % 3]
        view = kinds[number % 3] + 0.1 * rng.normal(size=4)
        moved = {"cost": 1.5, "outcome": "unsure"} if agent.steps else {}
        return {"sight": soft, "open": seen["open"], "smell": smell, "view": view, **moved}

    _led(world, agent, 30, see)[0].save(path)


def in_the_plane(path: Path) -> None:
    """One whose places lie where odometry says."""
    graph, rng = nx.grid_2d_graph(3, 3), np.random.default_rng(3)
    for number, node in enumerate(graph):
        graph.nodes[node].update(sight=number % 2, position=tuple(10.0 * np.array(node) + rng.uniform(-2, 2, 2)))
    world = ListedWays(GraphWorld.from_networkx(nx.convert_node_labels_to_integers(graph).to_directed()))
    sensors = [Sight(), Ways(learned=True), Bearings()]
    _led(world, Agent(world.motions, sensors=sensors, pose=Plane(), seed=0), 14)[0].save(path)


def without_poses(path: Path) -> None:
    """One that knows nothing of where ways lead, and has closed loops by what it saw."""
    world = load_world("3x3")
    _led(world, Agent(world.motions, pose=NoPose(), seed=0), 40)[0].save(path)


def _led(
    world: Any, agent: Agent, steps: int, see: Callable[[dict[str, Any]], dict[str, Any]] = dict
) -> tuple[Agent, Any]:
    observation, _ = world.reset(seed=0)
    for _ in range(steps):
        observation = world.step(agent.step(see(observation)))[0]
    return agent, observation


def ledger_file(path: Path) -> None:
    with Ledger(path) as ledger:
        ledger.begin(dict, made="here")
        for seed in range(5):
            ledger.append({"seed": seed, "steps": {"learn": 3.5, "visit": None}, "world": "3x3"})


def network_file(path: Path) -> None:
    from cogmap.model import FactorGraph

    graph = FactorGraph()
    a = graph.variable("rain", ("no", "yes"))
    b = graph.variable("wet grass", ("dry", "wet", "very wet"))
    graph.factor("P", [a], [0.8, 0.2], kind="conditional")
    graph.factor("P", [b, a], [[0.9, 0.1], [0.05, 0.5], [0.05, 0.4]], kind="conditional")
    save_graph(graph, path)


def world_file(path: Path) -> None:
    graph = nx.grid_2d_graph(3, 3)
    for number, node in enumerate(graph):
        graph.nodes[node].update(sight=f"s{number}")
    if path.suffix == ".json":
        path.write_text(json.dumps(nx.node_link_data(nx.convert_node_labels_to_integers(graph), edges="edges")))
    elif path.suffix == ".graphml":
        nx.write_graphml(nx.convert_node_labels_to_integers(graph), path)
    elif path.suffix == ".yaml":
        names = [f"n{number}" for number in range(4)]
        path.write_text(
            "".join(
                f"- node:\n    name: {name}\n    properties: {{sight: s{name}}}\n"
                f"    pose: {{position: {{x: {at}, y: 0}}}}\n"
                f"    edges: [{{node: {names[at - 1]}}}, {{node: {names[(at + 1) % 4]}}}]\n"
                for at, name in enumerate(names)
            )
        )
    else:
        path.write_text("hall hall | study\n----   .     ----\nattic den    den\n")


KINDS: dict[str, tuple[str, Callable[[Path], Any], Callable[[Path], None], Damage]] = {
    "agent": ("map.npz", lambda path: agent_file(path, 16), try_agent, changed_agent),
    "agent600": ("map.npz", lambda path: agent_file(path, 600), try_agent, changed_agent),
    "agent10000": ("map.npz", lambda path: agent_file(path, 10_000), try_agent, changed_agent),
    "doubting": ("map.npz", doubting, try_agent, changed_agent),
    "lost": ("map.npz", lost, try_agent, changed_agent),
    "told": ("map.npz", told, try_agent, changed_agent),
    "plane": ("map.npz", in_the_plane, try_agent, changed_agent),
    "no poses": ("map.npz", without_poses, try_agent, changed_agent),
    "recording": ("r.json", lambda path: recorded(load_world("3x3"), 8).save(path), try_recording, changed_json),
    "gzip": ("r.json.gz", lambda path: recorded(load_world("3x3"), 8).save(path), try_recording, changed_gzip),
    "ledger": ("cells.jsonl", ledger_file, try_ledger, changed_lines),
    "json graph": ("g.json", network_file, try_graph, changed_json),
    "bif": ("g.bif", network_file, try_graph, changed_text),
    "xmlbif": ("g.xmlbif", network_file, try_graph, changed_text),
    "uai": ("g.uai", network_file, try_graph, changed_text),
    "world json": ("w.json", world_file, try_world, changed_json),
    "world graphml": ("w.graphml", world_file, try_world, changed_text),
    "world yaml": ("w.yaml", world_file, try_world, changed_text),
    "maze": ("w.txt", world_file, try_world, changed_text),
}


DAMAGES = ("flip", "end", "change")


def changes(kind: str) -> dict[str, Damage]:
    """What damages a file of a kind, by name."""
    return {"flip": flipped, "end": truncated, "change": KINDS[kind][3]}


def damaged(kind: str, folder: Path, count: int, seed: int = 0) -> Iterator[tuple[str, Path, Callable[[Path], None]]]:
    """`count` files, each damaged anew, and what is tried with them."""
    name, make, attempt, _ = KINDS[kind]
    path, rng = folder / name, random.Random(seed)
    make(path)
    content = path.read_bytes()
    for _ in range(count):
        what = rng.choice([*DAMAGES, "change"])
        path.write_bytes(changes(kind)[what](content, rng))
        yield what, path, attempt


def outcome(path: Path, attempt: Callable[[Path], None]) -> str:
    """`fine`, or `refused` in one line; anything else escapes."""
    try:
        attempt(path)
    except (CogmapError, WorldError) as error:
        text = str(error)
        assert text.isprintable(), repr(text)
        assert len(text) < 1000
        return "refused"
    return "fine"
