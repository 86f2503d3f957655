"""Damage of every kind for files of every kind: bits, ends, and changes whose checksums are right.

`python tests/fuzzing.py KIND N` runs the large form, each damaged file within limits of time and memory.
"""

from __future__ import annotations

import gzip
import io
import json
import random
import resource
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from cogmap.agent import Agent
from cogmap.experiments import Ledger
from cogmap.model import CogmapError, load_graph, save_graph
from cogmap.views import Recording, replay_html
from cogmap.worlds import WorldError, load_world
from parts import agent_with
from recordings import recorded
from walks import assert_map_is_sound, walk, walked

SECONDS, MEMORY = 2.0, 500 * 2**20
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
    name = rng.choice(list(arrays))
    if name == "header" or rng.random() < 0.4:
        header = json.loads(arrays["header"].tobytes())
        spoil(header, rng)
        arrays["header"] = np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)
    else:
        arrays |= {name: _spoiled(arrays[name], rng)}
    file = io.BytesIO()
    (np.savez_compressed if rng.random() < 0.1 else np.savez)(file, **arrays)
    return file.getvalue()


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


def try_agent(path: Path, *, steps: int = 12) -> None:
    """Load it, and walk on."""
    agent = Agent.load(path)
    rng = np.random.default_rng(0)
    size, names = len(agent.map.motions), list(agent.map.sensors)
    for _ in range(steps):
        observation = {"sight": int(rng.integers(4)), "open": [*(rng.random(size - 1) < 0.6).tolist(), True]}
        agent.step({name: observation[name] for name in names})
        assert np.isclose(agent.belief.message.mass.sum(), 1.0)
        assert np.isfinite(agent.trace[-1].evidence)
    if len(agent.map.places) < 200:
        assert_map_is_sound(agent.map)


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
    """A saved agent that knows about so many places."""
    if places <= 16:
        walked(load_world("4x4_alias"), 30, displace_every=9).save(path)
        return
    from cogmap.worlds import MazeEnv
    from cogmap.worlds.generate import random_maze

    side = int((places * 1.1) ** 0.5)
    world = MazeEnv(random_maze(side * side, sights=None, rng=np.random.default_rng(0)))
    agent = agent_with(world.motions, look_ahead=2)
    for _ in walk(world, agent, 10 * places):
        if len(agent.map.places) >= places:
            break
    agent.save(path)


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
    import networkx as nx

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


def damaged(kind: str, folder: Path, count: int, seed: int = 0) -> Iterator[tuple[str, Path, Callable[[Path], None]]]:
    """`count` files, each damaged anew, and what is tried with them."""
    name, make, attempt, change = KINDS[kind]
    path, rng = folder / name, random.Random(seed)
    make(path)
    content = path.read_bytes()
    for _ in range(count):
        what, damage = rng.choice([("flip", flipped), ("end", truncated), ("change", change), ("change", change)])
        path.write_bytes(damage(content, rng))
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


def main(kind: str, count: int, seed: int = 0) -> None:
    """The large form: counts, the slowest, and how much memory was taken; failures are named and kept."""
    found, slowest, failures = Counter[str](), 0.0, Counter[str]()
    with tempfile.TemporaryDirectory() as folder:
        steady = 0
        for number, (what, path, attempt) in enumerate(damaged(kind, Path(folder), count, seed)):
            if number == 0:
                steady = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
            signal.alarm(20)
            begin = time.process_time()
            try:
                result = outcome(path, partial(attempt, steps=50) if attempt is try_agent else attempt)
            except BaseException as error:
                at = error.__traceback__
                while at and at.tb_next and "/cogmap" not in at.tb_frame.f_code.co_filename:
                    at = at.tb_next
                while at and at.tb_next:
                    at = at.tb_next
                where = f"{Path(at.tb_frame.f_code.co_filename).name}:{at.tb_lineno}" if at else "?"
                result = f"FAILED {type(error).__name__} {where}"
                failures[f"{result}: {str(error)[:150]}"] += 1
                Path(f"/tmp/fuzz-{kind}-{seed}-{number}{path.suffix}").write_bytes(path.read_bytes())
                if isinstance(error, KeyboardInterrupt):
                    raise
            signal.alarm(0)
            slowest = max(slowest, time.process_time() - begin)
            found[f"{what} {result.split()[0]}"] += 1
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    for failure, times in failures.most_common(40):
        print(times, failure)
    print(
        kind, count, dict(found), f"slowest {slowest:.2f} s, peak {(peak) / 2**20:.0f} MB (before {steady / 2**20:.0f})"
    )


def _late(*_: object) -> None:
    raise TimeoutError("took more than 20 s")


if __name__ == "__main__":
    signal.signal(signal.SIGALRM, _late)
    main(sys.argv[1], int(sys.argv[2]), *map(int, sys.argv[3:]))
