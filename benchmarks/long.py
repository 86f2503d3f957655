"""What a step costs, and what memory holds, after many steps: milliseconds of processor time and megabytes.

    python benchmarks/long.py
    python benchmarks/long.py plain noise --steps 50000 --json long.json

`plain`: an explorer in 3x3 that walks on. `cell`: one room without doors that shows a label never seen before at each
step; `labels`: such labels in 3x3, each of which it takes for a place never seen. `alike`: a hall in which all rooms
look alike. `moved`: put into a room at random before each step. `noise`: a tenth of all sights, doors and
moves of 4x4_alias go wrong, and now and then it is moved. Each walks in a process of its own. `first_ms` and `last_ms`
are medians over the second and the last tenth of the steps, `growth` is what the process holds at the end over what it
held after a fifth; `places` are those that the map says were visited, of so many `rooms`.
"""

from __future__ import annotations

import gc
import time
from collections.abc import Callable, Mapping
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
from cogmap.agent import Agent
from cogmap.worlds import MAZES, Maze, MazeEnv, NoisyWorld, hall
from machine import arguments, positive, write_json

Row = dict[str, Any]
Sensing = Callable[[Mapping[str, Any], int], Mapping[str, Any]]


def megabytes() -> float:
    """What this process holds in memory."""
    gc.collect()
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * 4096 / 1e6


def walk(form: str, steps: int, seed: int) -> Row:
    """One walk of so many steps."""
    maze, noise, displaced = FORMS[form]
    world: Any = NoisyWorld(MazeEnv(maze), **noise) if noise else MazeEnv(maze)
    agent, rng = Agent(world.motions, seed=seed, keep=100), np.random.default_rng(seed)
    observation, _ = world.reset(seed=seed)
    seconds, held = np.full(steps, np.nan), list[float]()  # all of it from the start, or it would count as growth
    for step in range(steps):
        if displaced:
            observation = world.displace(maze.rooms[int(rng.integers(len(maze.rooms)))])
        if form in ("labels", "cell"):
            observation = {**observation, "sight": f"label {step}"}
        begin = time.process_time()
        action = agent.step(observation)
        seconds[step] = time.process_time() - begin
        observation = world.step(action)[0]
        if step + 1 in (max(steps // 5, 1), steps):
            held.append(megabytes())
    tenth = max(steps // 10, 1)
    first, last = float(np.median(seconds[min(tenth, steps - 1) : 2 * tenth])), float(np.median(seconds[-tenth:]))
    return {
        "form": form, "steps": steps, "seed": seed, "first_ms": 1e3 * first, "last_ms": 1e3 * last,
        "ratio": last / first, "mb": held[-1], "growth": held[-1] / held[0],
        "places": int(np.sum(agent.map.visited)), "rooms": len(maze.rooms),
    }  # fmt: skip


FORMS: dict[str, tuple[Maze, dict[str, float], bool]] = {
    "plain": (MAZES["3x3"], {}, False),
    "cell": (Maze("cell", {(0, 0): 0}), {}, False),
    "labels": (MAZES["3x3"], {}, False),
    "alike": (hall(4, 4, sights=1, rng=np.random.default_rng(0)), {}, False),
    "moved": (MAZES["4x4"], {}, True),
    "noise": (MAZES["4x4_alias"], {"sight": 0.1, "door": 0.1, "slip": 0.1, "fail": 0.1, "moved": 0.01}, False),
}


def main() -> None:
    parser = arguments(__doc__, forms=FORMS)
    parser.add_argument("--steps", type=positive, default=2000)
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    rows: list[Row] = []
    for form in asked.forms:
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as alone:
            rows.append(alone.submit(walk, form, asked.steps, asked.seed).result())
        print({k: round(v, 3) if isinstance(v, float) else v for k, v in rows[-1].items()}, flush=True)
    write_json(asked.json, {"rows": rows})


if __name__ == "__main__":
    main()
