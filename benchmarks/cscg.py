"""The clone-structured graph: what its settings are worth, how long it takes, and how long any random walk must take.

    python benchmarks/cscg.py readings     steps to learn, by how it explores, whether it stays, how it is retrained
    python benchmarks/cscg.py speed        seconds of 100 exploring steps in 4x4, retrained every 5
    python benchmarks/cscg.py floor        steps until a random walk has tried every move in every room

Run i has seed i, and gives up after 600 steps. `--mazes` and `--runs` choose less, `--json FILE` keeps the rows.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from statistics import mean, median
from typing import Any

import numpy as np
from cogmap.baselines import CscgAgent, CscgSettings
from cogmap.experiments import Parts, explore_many, workers
from cogmap.worlds import GRID, MAZES, MazeEnv
from machine import arguments, write_json

Row = dict[str, Any]
MOST = 600
READINGS: Mapping[str, CscgSettings] = {
    "as it is": CscgSettings(),
    "targets": CscgSettings(exploring="targets"),
    "curious": CscgSettings(exploring="curious"),
    "stays": CscgSettings(stays=True),
    "continued": CscgSettings(retraining="continue"),
    "to the end": CscgSettings(tolerance=0.0),
}


def readings(mazes: list[str], runs: int, jobs: int) -> list[Row]:
    """How many of `runs` learn, and after how many steps; a run that does not counts as `MOST` in `at least`."""
    rows: list[Row] = []
    with workers(jobs=jobs) as executor:
        for maze in mazes:
            for agent in ("cscg", "cscg_pose"):
                for name, cscg in READINGS.items():
                    done = explore_many(
                        MAZES[maze], runs=runs, agent=Parts(agent, cscg=cscg), max_steps=MOST, executor=executor
                    )
                    steps = [run.steps_to_learn for run in done]
                    rows.append(
                        {
                            "maze": maze,
                            "agent": agent,
                            "setting": name,
                            "learned": sum(step is not None for step in steps),
                            "at least": mean(MOST if step is None else step for step in steps),
                            "runs": steps,
                        }
                    )
                    print(f"{maze:13} {agent:10} {name:10} {rows[-1]['learned']:2}/{runs} {rows[-1]['at least']:6.1f}")
    return rows


def speed(runs: int) -> list[Row]:
    """Median seconds of 100 steps in 4x4; with tolerance 0 all 200 iterations are made in each training."""
    rows: list[Row] = []
    for positions in (False, True):
        for tolerance in (CscgSettings().tolerance, 0.0):
            seconds = [_hundred(seed, positions, CscgSettings(tolerance=tolerance)) for seed in range(runs)]
            rows.append({"positions": positions, "tolerance": tolerance, "seconds": seconds})
            print(f"positions {positions!s:5} tolerance {tolerance:g}: median {median(seconds):.3f} s of {runs}")
    return rows


def floor(mazes: list[str], runs: int) -> list[Row]:
    """Mean steps of random walks that try 4 moves, or all 5 actions, until each was tried in each room."""
    rows: list[Row] = []
    for maze in mazes:
        for actions in (4, 5):
            steps = [_tried(maze, actions, seed) for seed in range(runs)]
            within = mean(step <= MOST for step in steps)
            rows.append({"maze": maze, "actions": actions, "mean": mean(steps), "within": within})
            print(f"{maze:13} {actions} actions: {rows[-1]['mean']:6.1f}, {100 * within:.0f} % within {MOST}")
    return rows


def _hundred(seed: int, positions: bool, settings: CscgSettings) -> float:
    world = MazeEnv(MAZES["4x4"])
    observation, _ = world.reset(seed=seed)
    begin = time.perf_counter()
    agent = CscgAgent(GRID, observations=16, positions=positions, settings=settings, seed=seed)
    for _ in range(100):
        observation, *_ = world.step(agent.step({**observation, "position": world.position}))
    return time.perf_counter() - begin


def _tried(maze: str, actions: int, seed: int) -> int:
    world, rng = MazeEnv(MAZES[maze]), np.random.default_rng(seed)
    world.reset(seed=seed)
    left = {(room, action) for room in world.maze.rooms for action in range(actions)}
    steps = 0
    while left:
        action = int(rng.integers(actions))
        left.discard((world.position, action))
        world.step(action)
        steps += 1
    return steps


def main() -> None:
    """Print a line for each measurement."""
    parser = arguments(__doc__)
    parser.add_argument("what", choices=("readings", "speed", "floor"))
    parser.add_argument("--mazes", nargs="+", choices=list(MAZES), default=[name for name in MAZES if name != "tolman"])
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--jobs", type=int, default=1)
    asked = parser.parse_args()
    if asked.what == "readings":
        rows = readings(asked.mazes, asked.runs, asked.jobs)
    else:
        rows = speed(asked.runs) if asked.what == "speed" else floor(asked.mazes, asked.runs)
    write_json(asked.json, {"what": asked.what, "rows": rows})


if __name__ == "__main__":
    main()
