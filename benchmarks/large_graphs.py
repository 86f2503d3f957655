"""What a step costs on graphs of 16 to 100,000 places, and what a place: milliseconds of processor time, bytes.

    python benchmarks/large_graphs.py
    python benchmarks/large_graphs.py --places 10000 --parts goal

Random geometric graphs of mean degree 4, fifty sights at random; bearings are told, and displacements after a move. The
agent is led through all places, depth first, and back, and plans nothing. Then `known`: it wants nothing. `goal`: a
place `--far` steps away is preferred, or the furthest of a smaller graph. `memory`: bytes a place of the agent as it
was saved and loaded again, and with what plans keep of all places.
"""

from __future__ import annotations

import argparse
import gc
import tempfile
import time
import tracemalloc
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from cogmap.agent import Agent
from cogmap.experiments import Parts
from cogmap.worlds import ListedWays, geometric
from machine import json_path, positive, write_json
from scale import plan_everywhere

Row = dict[str, Any]


def walk_through(chart: Any, start: Any) -> Iterator[int]:
    """The actions of a walk through all places, depth first, and back."""
    seen, track = {start}, [start]
    while track:
        here = track[-1]
        for action, ahead in enumerate(chart.exits(here).values()):
            if ahead is not None and ahead not in seen:
                seen.add(ahead)
                track.append(ahead)
                yield action
                break
        else:
            track.pop()
            if track:
                yield list(chart.exits(here).values()).index(track[-1])


class Known:
    """An agent that was led through a graph, in it.

    Args:
        places: how many.
        seed: of the graph and the start.
    """

    def __init__(self, places: int, seed: int) -> None:
        self.world = ListedWays(geometric(places, degree=4.0, sights=50, seed=seed))
        self.chart = self.world.unwrapped.chart
        self.observation, info = self.world.reset(seed=seed)
        self.start = info["place"]
        self.agent: Agent = Parts().make(self.world, np.random.SeedSequence(seed))
        self.agent.perceive(self.observation)
        begin, self.of = time.process_time(), {self.start: self.agent.belief.place}
        for action in list(walk_through(self.chart, self.start)):
            self.observation, _, _, _, info = self.world.step(action)
            belief = self.agent.perceive({**self.observation, "taken": action})
            self.of[info["place"]] = belief.place
        self.led_ms = 1e3 * (time.process_time() - begin) / (2 * places)
        self.agent._state.action, self.agent._state.acted = 0, True
        gc.collect()

    def steps(self, most: int, until: int | None = None) -> list[float]:
        """Milliseconds of so many steps, or fewer, until a place is reached."""
        spent: list[float] = []
        for _ in range(most):
            begin = time.process_time()
            action = self.agent.step(self.observation)
            spent.append(1e3 * (time.process_time() - begin))
            self.observation, *_ = self.world.step(action)
            if self.agent.belief.place == until:
                break
        return spent


def known(made: Known, asked: argparse.Namespace) -> Row:
    """Steps of an agent that knows everything and wants nothing."""
    return _times(made.steps(asked.steps + 10)[10:])


def goal(made: Known, asked: argparse.Namespace) -> Row:
    """Steps towards a place so far away."""
    level, far, steps = [made.start], {made.start}, 0
    while steps < asked.far:
        ahead = {other for place in level for other in made.chart.successors(place).values()} - far
        if not ahead:
            break
        level, steps = sorted(ahead), steps + 1
        far |= ahead
    made.agent.prefer(places={made.of[level[0]]: 2.0})
    spent = made.steps(2 * steps + 20, made.of[level[0]])
    return {**_times(spent), "shortest": steps, "reached": made.agent.belief.place == made.of[level[0]]}


def memory(made: Known, asked: argparse.Namespace) -> Row:
    """Bytes a place."""
    with tempfile.TemporaryDirectory() as folder:
        made.agent.save(Path(folder) / "map.npz")
        tracemalloc.start()
        loaded = Agent.load(Path(folder) / "map.npz")
        held, _ = tracemalloc.get_traced_memory()
        plan_everywhere(loaded)
        in_use, _ = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    places = len(made.chart.places)
    return {"bytes_a_place": held / places, "in_use_bytes_a_place": in_use / places}


def _times(spent: list[float]) -> Row:
    median, p99 = np.percentile(spent, [50, 99])
    return {"steps": len(spent), "median_ms": float(median), "p99_ms": float(p99), "max_ms": max(spent)}


PARTS = {part.__name__: part for part in (known, goal, memory)}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--places", type=positive, nargs="+", default=[16, 1_000, 10_000, 100_000])
    parser.add_argument("--parts", nargs="+", default=list(PARTS), choices=PARTS)
    parser.add_argument("--steps", type=positive, default=200)
    parser.add_argument("--far", type=positive, default=200)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", type=json_path, metavar="FILE")
    asked = parser.parse_args()
    rows: list[Row] = []
    for places in asked.places:
        made = Known(places, asked.seed)
        right = len(made.agent.map.visited_places) == len(made.chart.places)
        for part in asked.parts:
            rows.append({"places": places, "part": part, "led_ms": made.led_ms, "each_one_place": right})
            rows[-1] |= PARTS[part](made, asked)
            shown = (
                f"{key} {value:.4g}" if isinstance(value, float) else f"{key} {value}"
                for key, value in rows[-1].items()
            )
            print("  ".join(shown), flush=True)
    write_json(asked.json, {"rows": rows})


if __name__ == "__main__":
    main()
