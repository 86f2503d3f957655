"""Graph files, and large mazes, explored: steps over nearest frontier, maps that come out right, time of a step.

    python benchmarks/buildings.py FOLDER
    python benchmarks/buildings.py FOLDER --worlds house_31 farm --sights distinct ways 6 --starts 10 --jobs 2
    python benchmarks/buildings.py FOLDER --worlds house_31 house_49 --noise odometry=0.05 heading=3
    python benchmarks/buildings.py FOLDER --worlds streets_300 --told bearing
    python benchmarks/buildings.py FOLDER --cost metres --told lengths
    python benchmarks/buildings.py --worlds hall office geometric labyrinth

WORLDS are the graph files of the folder by name, all of them unless given, and families that are made, another with
each seed: hall (20x20), office (3 corridors of 8), geometric (100 places, degree 8), labyrinth (1,000 rooms). Seeds
settle the start, the sights at random, the noise and the agent. Nearest frontier is the mean of 20 draws of its ties
from the same start; by metres it is told how long ways are that nobody walked, and so is the agent with
`--told lengths`. `worst` is the worst single start; `beyond` the steps from the last place entered until every way was
known as well; milliseconds are processor time of a step of agent, world and judge.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from cogmap.experiments import Moment, Parts, walk
from cogmap.experiments.exploring import frontier_search
from cogmap.worlds import NoisyWorld, geometric, hall, is_graph_file, labyrinth, load_world, office
from machine import arguments, positive, write_json

DRAWS = 20
FAMILIES: dict[str, Callable[[int], Any]] = {
    "hall": lambda seed: hall(20, 20, sights=None),
    "office": lambda seed: office(3, 8, doors=0.2, seed=seed),
    "geometric": lambda seed: geometric(100, degree=8, seed=seed),
    "labyrinth": lambda seed: labyrinth(1_000, rng=np.random.default_rng(seed)),
}


def world_of(name: str, seed: int, args: argparse.Namespace, sights: str) -> Any:
    """The world of a name, with its sights and its noise."""
    if name in FAMILIES:
        return FAMILIES[name](seed)
    given: Any = int(sights) if sights.isdecimal() else sights
    path = next(path for path in args.folder.iterdir() if path.stem == name and is_graph_file(path))
    world = load_world(str(path), sights=given, seed=seed, pose=args.told, strong=False)
    noise = {kind: float(rate) for kind, rate in (each.split("=") for each in args.noise)}
    return NoisyWorld(world, **noise) if noise else world


def explored(task: tuple[str, str, int], args: argparse.Namespace) -> dict[str, Any]:
    """One exploration, and what it is measured by."""
    name, sights, seed = task
    world = world_of(name, seed, args, sights)
    spent: list[float] = []

    def timed(moment: Moment) -> None:
        spent.append(time.process_time())

    done = walk(world, seed, agent=Parts(cost=args.cost), watch=timed, max_steps=args.most)
    run = done.run
    nearest = run.frontier_mean
    if nearest is None:
        nearest = float(np.mean([frontier_search(world, run.start, draw) or np.nan for draw in range(DRAWS)]))
    steps, each = run.steps_to_visit_all, 1000.0 * np.diff(spent)
    return {
        "world": name,
        "sights": sights,
        "seed": seed,
        "steps": steps,
        "complete": run.steps_to_complete,
        "right": bool(run.map_right),
        "places": run.places,
        "over_frontier": None if steps is None else steps / nearest,
        "over_metres": None if run.metres is None or not run.frontier_metres else run.metres / run.frontier_metres,
        "median_ms": float(np.median(each)),
        "p99_ms": float(np.percentile(each, 99)),
    }


def summed(rows: list[dict[str, Any]]) -> str:
    """A line for the rows of one world with one kind of sights."""
    over = [row["over_frontier"] for row in rows if row["over_frontier"] is not None]
    metres = [row["over_metres"] for row in rows if row["over_metres"] is not None]
    beyond = [
        row["complete"] - row["steps"] for row in rows if row["complete"] is not None and row["steps"] is not None
    ]
    return (
        f"{rows[0]['world']:16} {rows[0]['sights']:9} n {len(rows)}  entered {len(over)}  "
        f"right {sum(row['right'] for row in rows)}  steps {_mean(over)} worst {max(over, default=np.nan):.3f}  "
        f"metres {_mean(metres)}  beyond {_mean(beyond)}  "
        f"ms {np.median([row['median_ms'] for row in rows]):.1f} p99 {max(row['p99_ms'] for row in rows):.1f}"
    )


def _mean(values: list[Any]) -> str:
    return f"{np.mean(values):.3f}" if values else "-"


def main() -> None:
    parser = arguments(__doc__)
    parser.add_argument("folder", nargs="?", type=Path, help="of graph files")
    parser.add_argument("--worlds", nargs="+", metavar="NAME")
    parser.add_argument(
        "--sights", nargs="+", default=["6"], metavar="KIND", help="distinct, ways or a number at random"
    )
    parser.add_argument("--noise", nargs="+", default=[], metavar="KIND=RATE")
    parser.add_argument("--told", help="of a pose: lengths, displacement (unless given), bearing or none")
    parser.add_argument("--cost", default="steps", choices=("steps", "metres"))
    parser.add_argument("--starts", type=positive, default=10)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--most", type=positive, help="steps; 50 a place and 50 unless given")
    parser.add_argument("--jobs", type=positive, default=1)
    args = parser.parse_args()
    files = [] if args.folder is None else sorted(path.stem for path in args.folder.iterdir() if is_graph_file(path))
    names = args.worlds or [name for name in files if name != "intel"]
    if unknown := [name for name in names if name not in (*files, *FAMILIES)]:
        parser.error(f"there is no world {unknown[0]!r}; there are {', '.join((*files, *FAMILIES))}")
    if not names:
        parser.error("give a folder of graph files, or --worlds")
    rows: list[dict[str, Any]] = []
    with ProcessPoolExecutor(args.jobs) as pool:
        for name in names:
            for sights in args.sights if name not in FAMILIES else ["own"]:
                tasks = [(name, sights, seed) for seed in range(args.seed, args.seed + args.starts)]
                found = list(pool.map(partial(explored, args=args), tasks))
                print(summed(found), flush=True)
                rows += found
    write_json(args.json, {"rows": rows})


if __name__ == "__main__":
    main()
