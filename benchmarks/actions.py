"""Long lists of actions of which most are never open: steps until the map is right, and time, beside the short list.

    python benchmarks/actions.py
    python benchmarks/actions.py 4x4_alias hall --actions 0 100 --seeds 0-4 --json actions.json

Worlds are `4x4_alias`, a hall of 6 x 8 rooms and a labyrinth of 100, both of 3 sights. To the five actions of the grid
so many more are added, in pairs that undo each other, whose ways are never open. `right`: the map is right before
`--steps` a room were taken, each of its places a room, and stays so for `--on` steps more; `lost`: at some step after
that the agent was believed elsewhere than where it was; `steps`: from which on it is right; `ms`: processor time of a
step.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from statistics import mean
from time import process_time
from typing import Any

import numpy as np
from cogmap.agent import Agent
from cogmap.experiments.judging import Trail
from cogmap.experiments.running import Moment
from cogmap.model import Motions
from cogmap.worlds import GRID, MAZES, Maze, MazeEnv, hall, labyrinth
from machine import arguments, positive, write_json
from percepts import complete, seeds

WORLDS: dict[str, Callable[[int], Maze]] = {
    "4x4_alias": lambda seed: MAZES["4x4_alias"],
    "hall": lambda seed: hall(6, 8, sights=3, rng=np.random.default_rng(seed)),
    "labyrinth": lambda seed: labyrinth(100, sights=3, rng=np.random.default_rng(seed)),
}


def with_more(actions: int) -> Motions:
    """The grid, and further actions in pairs that undo each other."""
    more = [(3 + i // 2, 1) if i % 2 else (-3 - i // 2, -1) for i in range(actions)]
    names = *GRID.names, *(f"never {i}" for i in range(actions))
    return Motions(names, (*GRID.displacements, *more))


def explored(maze: Maze, actions: int, seed: int, *, most: int, on: int) -> dict[str, Any]:
    """One walk, until the map has been right for so many steps."""
    world, trail = MazeEnv(maze), Trail()
    agent = Agent(with_more(actions), seed=seed)
    observation, info = world.reset(seed=seed)
    since, lost, spent, step = None, False, 0.0, 0
    for step in range(most + on):
        seen = {**observation, "open": [*np.array(observation["open"]).tolist(), *[False] * actions]}
        begun = process_time()
        action = agent.step(seen)
        spent += process_time() - begun
        trail(Moment(step, agent, world, seen, info, action))
        right = len(set(trail.rooms)) == len(maze.rooms) and complete(agent, trail, world.chart)
        since = None if not right else step if since is None else since
        lost = since is not None and (lost or trail.room(agent, agent.belief.place) != world.position)
        if since is not None and step == since + on:
            break
        observation, *_, info = world.step(action)
    return {"right": since is not None, "lost": lost, "steps": since, "ms": 1e3 * spent / (step + 1)}


def main(given: Sequence[str] | None = None) -> None:
    """Measure and print."""
    parser = arguments(__doc__, worlds=WORLDS)
    parser.add_argument("--actions", type=int, nargs="+", default=[0, 12, 40, 100])
    parser.add_argument("--seeds", type=seeds, default=range(20))
    parser.add_argument("--steps", type=positive, default=6, help="a room, at most")
    parser.add_argument("--on", type=positive, default=10)
    asked = parser.parse_args(given)
    found: list[dict[str, Any]] = []
    for name in asked.worlds:
        for actions in asked.actions:
            mazes = [(seed, WORLDS[name](seed)) for seed in asked.seeds]
            options: dict[str, Any] = {"on": asked.on}
            rows = [
                {"seed": seed, **explored(maze, actions, seed, most=asked.steps * len(maze.rooms), **options)}
                for seed, maze in mazes
            ]
            found.append({"world": name, "actions": actions, "rows": rows})
            right, lost = sum(row["right"] for row in rows), sum(row["lost"] for row in rows)
            steps = mean([row["steps"] for row in rows if row["right"]] or [0])
            ms = mean(row["ms"] for row in rows)
            told = f"right {right} of {len(rows)}, lost {lost}, {steps:.1f} steps, {ms:.1f} ms"
            print(f"{name:10} {actions:4} more: {told}", flush=True)
    write_json(asked.json, {"found": found})


if __name__ == "__main__":
    main()
