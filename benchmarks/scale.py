"""What a step costs in mazes of 16 to 100,000 rooms, and what a map does: seconds of processor time.

    python benchmarks/scale.py
    python benchmarks/scale.py --rooms 16 1000 --parts localised lost --json scale.json

`localised`: everything is known, nothing is wanted. `goal`: the same, and the room furthest away is preferred. `lost`:
moved without a word, again and again, until it knows its place. `save`: seconds to save and load, size of the file,
memory of a loaded agent as it is and in use, when plans have looked at every place. `explore`: steps until every room
was visited and every transition is believed, beside nearest-frontier search from the same start. All but `explore`
begin with the maze as a map that is given, and have to find out where in it they are. A part ends after `--seconds`,
and where a step would take more than `--gigabytes`: the table says so.
"""

from __future__ import annotations

import argparse
import gc
import resource
import tempfile
import time
import tracemalloc
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from statistics import fmean
from typing import Any

import numpy as np
from cogmap.agent import Agent, Settings
from cogmap.baselines import FrontierAgent
from cogmap.experiments import Truth
from cogmap.planning import CHOICES, LocalCache, Planner
from cogmap.worlds import GRID, Maze, MazeEnv, Position, labyrinth
from machine import arguments, write_json

Row = dict[str, Any]
WARM = 10
"""Steps that are left out, at the beginning."""


def maze_of(rooms: int, asked: argparse.Namespace, seed: int) -> tuple[Maze, Position]:
    """A labyrinth and the room to start in."""
    rng = np.random.default_rng(seed)
    maze = labyrinth(rooms, loops=asked.loops, sights=min(asked.sights, rooms), rng=rng)
    return maze, maze.rooms[int(rng.integers(rooms))]


class Timed:
    """An agent in a world, by the clock of the process, which stands still while other processes run.

    Attributes:
        seconds: of each step of the agent.
    """

    def __init__(self, agent: Agent | FrontierAgent, maze: Maze, start: Position) -> None:
        self.agent, self.start, self.seconds = agent, start, list[float]()
        self.world = MazeEnv(maze)
        self.observation, _ = self.world.reset(options={"start": start})
        gc.collect()  # what teaching the map left behind is not to be collected on the clock

    def step(self) -> None:
        """One step."""
        begin = time.process_time()
        action = self.agent.step(self.observation)
        self.seconds.append(time.process_time() - begin)
        self.observation, *_ = self.world.step(action)

    def times(self, first: int = 0) -> Row:
        """Median, 99th percentile and most of the steps from `first` on, in milliseconds."""
        spent = 1e3 * np.array(self.seconds[min(first, len(self.seconds) - 1) :])
        median, p99 = np.percentile(spent, [50, 99])
        return {"steps": len(spent), "median_ms": float(median), "p99_ms": float(p99), "max_ms": float(spent.max())}


def for_a_while(most: int, seconds: float) -> Iterator[int]:
    """0, 1, ... below `most`, until the time is over; three at least."""
    end = time.process_time() + seconds
    for i in range(most):
        if i >= 3 and time.process_time() > end:
            return
        yield i


def with_map(maze: Maze, asked: argparse.Namespace) -> Agent:
    """An agent that was given the maze as its map; it has sensed nothing yet."""
    return Agent(GRID, map=maze.to_networkx(), settings=asked.settings, planner=asked.planner, seed=0)


def localised(rooms: int, asked: argparse.Namespace) -> Row:
    """Steps of an agent that knows everything and wants nothing."""
    maze, start = maze_of(rooms, asked, 0)
    walk = Timed(with_map(maze, asked), maze, start)
    for _ in for_a_while(WARM + asked.steps, asked.seconds):
        walk.step()
    return walk.times(WARM)


def goal(rooms: int, asked: argparse.Namespace) -> Row:
    """Steps towards the place that is furthest from the start."""
    maze, start = maze_of(rooms, asked, 0)
    agent = with_map(maze, asked)
    far = agent.map.places[max(range(rooms), key=lambda number: _apart(maze.rooms[number], start))]
    agent.prefer(places={far: 2.0})
    walk = Timed(agent, maze, start)
    reached = False
    for _ in for_a_while(WARM + asked.steps, asked.seconds):
        walk.step()
        reached = agent.belief.place == far
        if reached:
            break
    return {**walk.times(WARM if len(walk.seconds) > 2 * WARM else 0), "reached": reached}


def lost(rooms: int, asked: argparse.Namespace) -> Row:
    """Steps from a silent move until the right place is believed at the certainty of the settings."""
    maze, start = maze_of(rooms, asked, 0)
    agent = with_map(maze, asked)
    walk, rng = Timed(agent, maze, start), np.random.default_rng(1)
    for _ in range(3):
        walk.step()
    walk.seconds.clear()
    took: list[int] = []
    failed = 0
    for _ in for_a_while(asked.moves, asked.seconds):
        walk.observation = walk.world.displace(maze.rooms[int(rng.integers(rooms))])
        for step in range(asked.patience):
            room = walk.world.position
            walk.step()
            if agent.certain and (room,) == maze.rooms[agent.belief.place : agent.belief.place + 1]:  # or a new place
                took.append(step)
                break
        else:
            failed += 1
    return {**walk.times(), "moves": len(took) + failed, "recovered": len(took), "to_recover": fmean(took or [-1])}


def save(rooms: int, asked: argparse.Namespace) -> Row:
    """Seconds to save and to load, bytes a room in the file and in memory."""
    agent = with_map(maze_of(rooms, asked, 0)[0], asked)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "map.npz"
        seconds = [_seconds(partial(agent.save, path)), _seconds(partial(Agent.load, path))]
        size = path.stat().st_size
        tracemalloc.start()
        loaded = Agent.load(path)
        held, _ = tracemalloc.get_traced_memory()
        plan_everywhere(loaded)
        in_use, _ = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    assert len(loaded.map.places) == rooms
    a_room = {"file_bytes_a_room": size, "bytes_a_room": held, "in_use_bytes_a_room": in_use}
    return {"save_s": seconds[0], "load_s": seconds[1], **{name: value / rooms for name, value in a_room.items()}}


def plan_everywhere(agent: Agent) -> None:
    """Let it keep what a plan keeps of a place, of all places, and look up a sight."""
    places, cache = np.arange(len(agent.map.places)), LocalCache(agent.map, agent.settings.look_ahead)
    for part in np.array_split(places, max(1, len(places) // 1000)):
        cache.ways(part), cache.sights(part)
    agent.map.sensors["sight"].candidates(0)
    agent._cache = cache


def _apart(one: Sequence[int], other: Sequence[int]) -> int:
    return sum(abs(x - y) for x, y in zip(one, other, strict=True))


def _seconds(call: Callable[[], object]) -> float:
    begin = time.process_time()
    call()
    return time.process_time() - begin


def explore(rooms: int, asked: argparse.Namespace) -> Row:
    """Steps and seconds to the end, for the agent and for nearest-frontier search; null where one did not get there."""
    steps: dict[str, list[int | None]] = {"agent": [], "frontier": []}
    walks: list[Timed] = []
    for seed in range(asked.seed, asked.seed + (asked.mazes if rooms <= 1000 else 1)):
        maze, start = maze_of(rooms, asked, seed)
        agent = Agent(MazeEnv.motions, settings=asked.settings, planner=asked.planner, seed=seed)
        for name, walker in (("agent", agent), ("frontier", FrontierAgent(MazeEnv.motions, seed=seed))):
            walk = Timed(walker, maze, start)
            steps[name].append(_to_the_end(walk, maze, asked.seconds))
            if name == "agent":
                walks.append(walk)
    every = Timed(walks[0].agent, maze, start)
    every.seconds = [second for walk in walks for second in walk.seconds]
    means = {name: None if None in some else fmean(s for s in some if s is not None) for name, some in steps.items()}
    return {**every.times(), **means, "seconds": sum(every.seconds), "mazes": len(walks), "of_each": steps}


def _to_the_end(walk: Timed, maze: Maze, seconds: float) -> int | None:
    """Steps until every room was visited and every transition is known; None when the time is over."""
    truth, entered = Truth(maze, walk.start), {walk.start}
    for step in for_a_while(100 * len(maze.rooms), seconds):
        walk.step()
        if len(entered) == len(maze.rooms) and _knows(walk, truth):
            return step
        entered.add(walk.world.position)
    return None


def _knows(walk: Timed, truth: Truth) -> bool:
    if isinstance(walk.agent, Agent):
        return truth.visited(walk.agent.map) and truth.learned(walk.agent.map)
    return truth.known(walk.agent.edges)


PARTS = {part.__name__: part for part in (localised, goal, lost, save, explore)}


def _arguments(given: Sequence[str] | None) -> argparse.Namespace:
    parser = arguments(__doc__)
    parser.add_argument("--rooms", type=int, nargs="+", default=[16, 100, 1000, 10_000, 100_000])
    parser.add_argument("--parts", nargs="+", default=list(PARTS), choices=PARTS)
    parser.add_argument("--loops", type=float, default=0.1, help="of the labyrinths, 0 to 1")
    parser.add_argument("--sights", type=int, default=50, help="different ones")
    parser.add_argument("--steps", type=int, default=200)
    parser.add_argument("--moves", type=int, default=20, help="silent ones, of `lost`")
    parser.add_argument("--patience", type=int, default=50, help="steps after which a silent move counts as failed")
    parser.add_argument("--mazes", type=int, default=10, help="of `explore`, up to 1000 rooms; one above")
    parser.add_argument("--seconds", type=float, default=300.0, help="for each part (each run of `explore`)")
    parser.add_argument("--gigabytes", type=float, default=4.0, help="of address space, at most")
    parser.add_argument("--look-ahead", type=int, default=6)
    parser.add_argument("--choice", default="outward", choices=CHOICES, help="between policies")
    parser.add_argument("--seed", type=int, default=0, help="of the first maze of `explore`")
    parser.add_argument("--profile", action="store_true", help="print the functions that take longest")
    asked = parser.parse_args(given)
    if asked.seed < 0:
        parser.error(f"--seed is {asked.seed}; give 0 or more")
    asked.settings = Settings(look_ahead=asked.look_ahead)
    asked.planner = Planner(choice=CHOICES[asked.choice]())
    return asked


def measured(part: str, rooms: int, asked: argparse.Namespace) -> Row:
    """One line of the table."""
    row: Row = {"part": part, "rooms": rooms}
    try:
        return {**row, **PARTS[part](rooms, asked)}
    except MemoryError:
        return {**row, "failed": f"more than {asked.gigabytes:g} GB"}


def profiled(part: str, rooms: int, asked: argparse.Namespace) -> Row:
    """The same, and where the time went."""
    import cProfile
    import pstats

    profile = cProfile.Profile()
    row = profile.runcall(measured, part, rooms, asked)
    pstats.Stats(profile).sort_stats("tottime").print_stats("cogmap|work|model|planning|inference|agent|numpy", 25)
    return row


def main(given: Sequence[str] | None = None) -> None:
    """Measure and print."""
    asked = _arguments(given)
    limit = int(asked.gigabytes * 2**30)
    resource.setrlimit(resource.RLIMIT_AS, (limit, resource.getrlimit(resource.RLIMIT_AS)[1]))
    rows: list[Row] = []
    print("   rooms  part")
    for part in asked.parts:
        for rooms in asked.rooms:
            rows.append((profiled if asked.profile else measured)(part, rooms, asked))
            print(f"{rooms:8}  {part:10} {_text(rows[-1])}", flush=True)
    told = ("loops", "sights", "look_ahead", "choice", "seed", "seconds", "gigabytes")
    options = {name: getattr(asked, name) for name in told}
    write_json(asked.json, {**options, "rows": rows})


def _text(row: Row) -> str:
    shown = {name: value for name, value in row.items() if name not in ("part", "rooms", "of_each")}
    return "  ".join(
        f"{name} {value:.4g}" if isinstance(value, float) else f"{name} {value}" for name, value in shown.items()
    )


if __name__ == "__main__":
    main()
