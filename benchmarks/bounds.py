"""What must stay within bounds: bombs that are refused, commands that are killed, mazes of a million rooms.

    python benchmarks/bounds.py
    python benchmarks/bounds.py kills --times 25 --json bounds.json

`bombs`: files that unpack to gigabytes, ask for tables of a billion places, or are a graph of ten million edges, each
read by a process of its own: seconds of processor time and megabytes beyond `import cogmap`, and what it says. `kills`:
save, explore, study, fit and replay are killed (`kill -9`) at a random time, again and again over one output; then each
output is whole, an old or a new one, and once a run has ended nothing else is left in the folder. `rooms`: a maze of
`--rooms` rooms as text, `explore --max-steps 100`: seconds and megabytes.
"""

from __future__ import annotations

import argparse
import gzip
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
import zipfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from cogmap.agent import Agent
from cogmap.worlds import load_world
from machine import arguments, positive, write_json

Row = dict[str, Any]
MEASURED = """
import resource, sys, time
from cogmap.agent import Agent
from cogmap.views import Recording
from cogmap.worlds import load_world
before, begun = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, time.process_time()
try:
    {load}(sys.argv[1]); said = "loaded"
except ValueError as error:
    said = str(error)
more = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024
print(time.process_time() - begun, more, said[-90:])
"""


def saved(path: Path) -> None:
    world = load_world("3x3")
    agent = Agent(world.motions, seed=0)
    observation, _ = world.reset(seed=0)
    for _ in range(20):
        observation = world.step(agent.step(observation))[0]
    agent.save(path)


def unknown_member(path: Path) -> None:
    saved(path)
    more: dict[str, Any] = {"mode": "w", "force_zip64": True}
    with zipfile.ZipFile(path, "a", zipfile.ZIP_DEFLATED) as file, file.open("more.npy", **more) as member:
        for _ in range(3 * 2**10):
            member.write(bytes(2**20))


def many_places(path: Path) -> None:
    saved(path)
    with np.load(path) as file:
        arrays = {name: file[name] for name in file.files}
    header = json.loads(arrays["header"].tobytes())
    header["map"]["places"] = 10**9
    arrays["header"] = np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)
    np.savez(path, **arrays)


def packed_recording(path: Path) -> None:
    path.write_bytes(gzip.compress(bytes(2**24)) * 384)


def many_edges(path: Path) -> None:
    nodes = ", ".join(f'{{"id": {n}, "sight": 0}}' for n in range(2))
    edge = '{"source": 0, "target": 1}'
    with path.open("w") as file:
        file.write(f'{{"directed": true, "multigraph": true, "nodes": [{nodes}], "edges": [{edge}')
        for _ in range(10**3):
            file.write(f", {edge}" * 10**4)
        file.write("]}")


BOMBS: dict[str, tuple[str, str, Callable[[Path], None]]] = {
    "3 GB in 3 MB": ("map.npz", "Agent.load", unknown_member),
    "places: 10^9": ("map.npz", "Agent.load", many_places),
    "6 GB in 6 MB": ("run.json.gz", "Recording.load", packed_recording),
    "10^7 edges": ("graph.json", "load_world", many_edges),
}


def bombs(folder: Path, asked: argparse.Namespace) -> list[Row]:
    """Each bomb, refused."""
    rows: list[Row] = []
    for name, (file, load, make) in BOMBS.items():
        make(folder / file)
        command = [sys.executable, "-c", MEASURED.format(load=load), str(folder / file)]
        seconds, more, said = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split(" ", 2)
        rows.append({"what": name, "s": float(seconds), "mb": float(more), "said": said.strip()})
        (folder / file).unlink()
    return rows


COGMAP = str(Path(sys.executable).with_name("cogmap"))
SAVE = "import sys; sys.path[:0] = sys.argv[1:2]; from bounds import *\nwhile True: saved(Path('map.npz'))"
COMMANDS = {
    "save": [sys.executable, "-c", SAVE, str(Path(__file__).parent)],
    "explore": [COGMAP, "explore", "3x3", "--json", "out.json", "--save", "map.npz", "--trace", "run.json"],
    "study": [COGMAP, "study", "donut", "--runs", "2", "--out", "study"],
    "fit": [COGMAP, "fit", "../walk.json", "--world", "3x3", "--model", "uniform", "--json", "fit.json"],
    "replay": [COGMAP, "replay", "../walk.json", "--out", "page.html"],
}


def kills(folder: Path, asked: argparse.Namespace) -> list[Row]:
    """Each command, killed again and again."""
    subprocess.run([COGMAP, "explore", "3x3", "--trace", "walk.json"], check=True, capture_output=True, cwd=folder)
    return [killed(folder / name, name, asked.times) for name in COMMANDS]


def killed(folder: Path, name: str, times: int) -> Row:
    """How often what was left by a command that was killed was whole, and what is left of it after one that ended."""
    folder.mkdir()
    rng, whole, begun, longest = random.Random(name), 0, time.monotonic(), 3.0
    if name != "save":
        ended(name, folder)
        longest = 1.1 * (time.monotonic() - begun)
    for _ in range(times):
        process = subprocess.Popen(COMMANDS[name], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(rng.uniform(0.3 * longest, longest))
        process.send_signal(signal.SIGKILL)
        process.wait()
        whole += all(map(is_whole, (path for path in folder.rglob("*") if not path.name.startswith("."))))
    ended(name, folder)
    return {"what": name, "times": times, "whole": whole, "left": len([*folder.rglob(".*cogmap-*")])}


def ended(name: str, folder: Path) -> None:
    """Run a command to its end."""
    if name == "save":
        saved(folder / "map.npz")
    else:
        subprocess.run(COMMANDS[name], cwd=folder, capture_output=True, check=True)


def is_whole(path: Path) -> bool:
    """Whether a file is one that can be read to its end."""
    try:
        if path.suffix == ".npz":
            Agent.load(path)
        elif path.suffix == ".json":
            json.loads(path.read_text())
        elif path.suffix == ".html":
            assert path.read_text().rstrip().endswith("</html>")
    except (AssertionError, ValueError, OSError):
        return False
    return True


def rooms(folder: Path, asked: argparse.Namespace) -> list[Row]:
    """A large maze as text."""
    side = max(int(asked.rooms**0.5), 2)
    sights = np.random.default_rng(0).integers(50, size=(side, side))
    (folder / "large.txt").write_text("\n".join(" ".join(map(str, row)) for row in sights.tolist()) + "\n")
    begun = time.monotonic()
    command = [COGMAP, "explore", "large.txt", "--max-steps", "100", "--json", "out.json"]
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    row = {"what": f"{side * side:,} rooms", "s": time.monotonic() - begun, "mb": used.ru_maxrss / 1024}
    return [{**row, "ended": os.waitstatus_to_exitcode(status) in (0, 1) and (folder / "out.json").exists()}]


PARTS = {"bombs": bombs, "kills": kills, "rooms": rooms}


def main(given: Sequence[str] | None = None) -> None:
    """Measure and print."""
    parser = arguments(__doc__, parts=PARTS)
    parser.add_argument("--times", type=positive, default=25, help="that each command is killed")
    parser.add_argument("--rooms", type=positive, default=1_000_000)
    asked = parser.parse_args(given)
    found: dict[str, list[Row]] = {}
    for part in asked.parts:
        with tempfile.TemporaryDirectory() as folder:
            found[part] = PARTS[part](Path(folder), asked)
        for row in found[part]:
            print(part, {k: round(v, 2) if isinstance(v, float) else v for k, v in row.items()}, flush=True)
    write_json(asked.json, {"parts": found})


if __name__ == "__main__":
    main()
