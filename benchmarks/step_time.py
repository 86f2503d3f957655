"""What forced exploring costs: seconds for 100 steps, seconds to import, megabytes of memory.

    python benchmarks/step_time.py
    python benchmarks/step_time.py --policies all --runs 3 --json step_time.json

The agent goes on exploring when there is nothing left to explore. A run is everything from an agent that knows
nothing to its last action, the world's part included. Runs of one process share caches: `first` had none.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from typing import Any

from cogmap.agent import Agent, Settings
from cogmap.planning import GENERATORS
from cogmap.worlds import load_world
from machine import write_json

IMPORT = "import time; t = time.perf_counter(); import cogmap.agent; print(time.perf_counter() - t)"


def walk(world_name: str, steps: int, settings: Settings, seed: int) -> float:
    """Seconds that `steps` steps of a new agent take."""
    world = load_world(world_name)
    observation, _ = world.reset(seed=seed)
    begin = time.perf_counter()
    agent = Agent(world.motions, settings=settings, seed=seed)
    for _ in range(steps):
        observation, *_ = world.step(agent.step(observation))
    return time.perf_counter() - begin


def timed(world: str, steps: int, settings: Settings, runs: int) -> dict[str, Any]:
    """Seconds of each run (run i has seed i), and what they come to."""
    seconds = [walk(world, steps, settings, seed) for seed in range(runs)]
    spread = {"first": seconds[0], "median": median(seconds), "min": min(seconds)}
    return {**{name: round(value, 4) for name, value in spread.items()}, "runs": [round(x, 4) for x in seconds]}


def import_seconds(times: int) -> float:
    """Median seconds of `import cogmap.agent` in a fresh process, start of Python left out."""
    return median(float(_fresh("-c", IMPORT)) for _ in range(times))


def peak_megabytes(world: str, steps: int, look_ahead: int, policies: str) -> float:
    """Largest resident memory of a fresh process that walks once, Python and imports included."""
    asked = (world, "--steps", str(steps), "--look-ahead", str(look_ahead), "--policies", policies, "--peak-only")
    return float(_fresh(__file__, *asked))


def _fresh(*arguments: str) -> str:
    return subprocess.run([sys.executable, *arguments], check=True, capture_output=True, text=True).stdout


def _own_peak() -> float:
    import resource

    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / (2**20 if sys.platform == "darwin" else 2**10)


def _arguments(given: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("world", nargs="?", default="4x4")
    parser.add_argument("--steps", type=int, default=100)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--look-ahead", type=int, default=6)
    parser.add_argument("--policies", nargs="+", default=["map_guided"], choices=[*GENERATORS, "all"])
    parser.add_argument("--json", type=Path)
    parser.add_argument("--peak-only", action="store_true", help="walk once and print megabytes")
    return parser.parse_args(given)


def main(given: Sequence[str] | None = None) -> None:
    """Measure and print."""
    asked = _arguments(given)
    names = list(GENERATORS) if "all" in asked.policies else asked.policies
    if asked.peak_only:
        walk(asked.world, asked.steps, Settings(look_ahead=asked.look_ahead, policies=names[0]), 0)
        print(_own_peak())
        return
    result: dict[str, Any] = {"world": asked.world, "steps": asked.steps, "look_ahead": asked.look_ahead}
    result["import_seconds"] = round(import_seconds(min(asked.runs, 5)), 4)
    print(f"import cogmap.agent: {result['import_seconds']:.3f} s")
    print(f"{asked.steps} steps of {asked.world}, look-ahead {asked.look_ahead}, {asked.runs} runs:")
    result["policies"] = {}
    for name in names:
        row = timed(asked.world, asked.steps, Settings(look_ahead=asked.look_ahead, policies=name), asked.runs)
        row["peak_megabytes"] = round(peak_megabytes(asked.world, asked.steps, asked.look_ahead, name), 1)
        result["policies"][name] = row
        print(
            f"  {name:14} median {row['median']:.3f} s, min {row['min']:.3f} s, first {row['first']:.3f} s, "
            f"peak {row['peak_megabytes']:.0f} MB",
            flush=True,
        )
    write_json(asked.json, result)


if __name__ == "__main__":
    main()
