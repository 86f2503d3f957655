"""What forced exploring costs: processor seconds for 100 steps, seconds to import, megabytes of memory.

    python benchmarks/step_time.py
    python benchmarks/step_time.py --policies all --look-ahead 6 8 10 12 14 --runs 3 --json step_time.json

The agent goes on exploring when there is nothing left to explore. A run is everything from an agent that knows
nothing to its last action, the world's part included. Runs of one process share caches: `first` had none. A run that
takes longer than `--seconds` is broken off, and the time of all steps worked out from those that were made (`made` says
how many); policies that cannot be listed at all are left out.
"""

from __future__ import annotations

import argparse
import math
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from typing import Any

from cogmap.agent import Agent, Settings
from cogmap.model import CogmapError
from cogmap.planning import POLICIES, Planner
from cogmap.worlds import load_world
from machine import arguments, write_json

IMPORT = "import time; t = time.perf_counter(); import cogmap.agent; print(time.perf_counter() - t)"


def walk(
    world_name: str, steps: int, settings: Settings, policies: str, seed: int, seconds: float = math.inf
) -> tuple[float, int]:
    """Seconds that `steps` steps of a new agent take, and how many of them were made before the time was over."""
    world = load_world(world_name)
    observation, _ = world.reset(seed=seed)
    made, end = 0, time.perf_counter() + seconds
    begin = time.process_time()
    planner = Planner(policies=POLICIES[policies]())
    agent = Agent(world.motions, planner=planner, settings=settings, seed=seed)
    while made < steps and (
        made == 0 or time.perf_counter() < end
    ):  # asking for processor time is slow on some machines
        observation, *_ = world.step(agent.step(observation))
        made += 1
    return (time.process_time() - begin) * steps / made, made


def timed(world: str, steps: int, settings: Settings, policies: str, runs: int, limit: float) -> dict[str, Any]:
    """Seconds of each run (run i has seed i), and what they come to."""
    walks = [walk(world, steps, settings, policies, seed, limit) for seed in range(runs)]
    seconds = [spent for spent, _ in walks]
    spread = {"first": seconds[0], "median": median(seconds), "min": min(seconds)}
    return {
        "policies": policies,
        "look_ahead": settings.look_ahead,
        **{name: round(value, 4) for name, value in spread.items()},
        "runs": [round(x, 4) for x in seconds],
        "made": min(made for _, made in walks),
    }


def import_seconds(times: int) -> float:
    """Median seconds of `import cogmap.agent` in a fresh process, start of Python left out."""
    return median(float(_fresh("-c", IMPORT)) for _ in range(times))


def peak_megabytes(asked: argparse.Namespace, look_ahead: int, policies: str) -> float:
    """Largest resident memory of a fresh process that walks once, Python and imports included."""
    walk_once = (asked.world, "--steps", str(asked.steps), "--seconds", str(asked.seconds), "--peak-only")
    return float(_fresh(__file__, *walk_once, "--look-ahead", str(look_ahead), "--policies", policies))


def _fresh(*arguments: str) -> str:
    return subprocess.run([sys.executable, *arguments], check=True, capture_output=True, text=True).stdout


def _own_peak() -> float:
    import resource

    status = Path("/proc/self/status")
    if status.exists():  # what a process started from a larger one is said to have used at most is that of the larger
        for line in status.read_text().splitlines():
            if line.startswith("VmHWM:"):
                return float(line.split()[1]) / 2**10
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / (2**20 if sys.platform == "darwin" else 2**10)


def _arguments(given: Sequence[str] | None) -> argparse.Namespace:
    parser = arguments(__doc__)
    parser.add_argument("world", nargs="?", default="4x4")
    parser.add_argument("--steps", type=int, default=100)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--look-ahead", type=int, nargs="+", default=[6])
    parser.add_argument("--policies", nargs="+", default=["map_guided"], choices=[*POLICIES, "all"])
    parser.add_argument("--seconds", type=float, default=60.0, help="of a run, at most")
    parser.add_argument("--peak-only", action="store_true", help="walk once and print megabytes")
    return parser.parse_args(given)


def main(given: Sequence[str] | None = None) -> None:
    """Measure and print."""
    asked = _arguments(given)
    names = list(POLICIES) if "all" in asked.policies else asked.policies
    if asked.peak_only:
        walk(asked.world, asked.steps, Settings(look_ahead=asked.look_ahead[0]), names[0], 0, asked.seconds)
        print(_own_peak())
        return
    result: dict[str, Any] = {"world": asked.world, "steps": asked.steps}
    result["import_seconds"] = round(import_seconds(min(asked.runs, 5)), 4)
    print(f"import cogmap.agent: {result['import_seconds']:.3f} s")
    print(f"{asked.steps} steps of {asked.world}, {asked.runs} runs: seconds, look-ahead first")
    result["rows"] = [row for name in names for look_ahead in asked.look_ahead for row in _row(asked, name, look_ahead)]
    write_json(asked.json, result)


def _row(asked: argparse.Namespace, name: str, look_ahead: int) -> list[dict[str, Any]]:
    """One line of the table; none where the policies are too many."""
    try:
        row = timed(asked.world, asked.steps, Settings(look_ahead=look_ahead), name, asked.runs, asked.seconds)
    except CogmapError as error:
        print(f"{look_ahead:4}  {name:14} {error}", flush=True)
        return []
    row["peak_megabytes"] = round(peak_megabytes(asked, look_ahead, name), 1)
    times = f"median {row['median']:.3f}, min {row['min']:.3f}, first {row['first']:.3f}"
    made = f" (from {row['made']} steps)" if row["made"] < asked.steps else ""
    print(f"{look_ahead:4}  {name:14} {times}{made}; peak {row['peak_megabytes']:.0f} MB", flush=True)
    return [row]


if __name__ == "__main__":
    main()
