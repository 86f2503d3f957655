"""Goals behind doors that were shut: does an agent that knows the world get there, and how far does it walk?

    python benchmarks/detours.py
    python benchmarks/detours.py --worlds donut tolman office --look-ahead 2 6 15 --ways 8 --json detours.json

The agent was led through every room (see `known.py`). It is at one of `--ways` random starts, prefers a random room by
`--weight` nats, and the first door on the shortest way there was shut, where there is another way. It has looked at
that door `--looks` times; with `--met` any door on the way is shut, and met by walking there. The ratio is to the
shortest way with the door known shut, from where it is met. `never` counts those that have not chosen to stay at the
goal after four times the way and 20 moves.
"""

from __future__ import annotations

import argparse
from collections import deque
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from cogmap.agent import Settings
from cogmap.worlds import MAZES, Maze, MazeEnv, Position, hall, labyrinth, office, random_maze
from known import known_agent
from machine import arguments, write_json

Doors = dict[Position, tuple[Position, ...]]
OWN = {
    "office": lambda seed: office(3, 8, doors=0.2, seed=seed),
    "random": lambda seed: random_maze(40, rng=np.random.default_rng(seed)),
    "labyrinth": lambda seed: labyrinth(100, loops=0.2, rng=np.random.default_rng(seed)),
    "hall": lambda seed: hall(5, 7, sights=None, rng=np.random.default_rng(seed)),
}


def shortest(doors: Doors, start: Position, goal: Position, shut: set[Position] | None = None) -> list[Position] | None:
    """Rooms on a shortest way, both ends included, with one door shut."""
    before: dict[Position, Position] = {start: start}
    queue = deque([start])
    while queue:
        room = queue.popleft()
        for ahead in doors[room]:
            if ahead not in before and {room, ahead} != shut:
                before[ahead] = room
                queue.append(ahead)
    if goal not in before:
        return None
    way = [goal]
    while way[-1] != start:
        way.append(before[way[-1]])
    return way[::-1]


def tasks(
    maze: Maze, ways: int, seed: int, met: bool
) -> Iterator[tuple[Position, Position, tuple[Position, Position], int]]:
    """Start, goal, the door that is shut, and the moves of the way there by way of that door."""
    rng, found = np.random.default_rng(seed), 0
    doors = {room: maze.neighbours(room) for room in maze.rooms}
    for _ in range(200 * ways):
        start, goal = (maze.rooms[int(i)] for i in rng.choice(len(maze.rooms), 2, replace=False))
        way = shortest(doors, start, goal)
        at = int(rng.integers(len(way) - 1)) if way and met else 0
        detour = None if way is None else shortest(doors, way[at], goal, {way[at], way[at + 1]})
        if way is None or detour is None:
            continue
        yield start, goal, (way[at], way[at + 1]), at + len(detour) - 1
        found += 1
        if found == ways:
            return


def walked(maze: Maze, task: tuple[Any, ...], look_ahead: int, weight: float, looks: int, seed: int) -> int | None:
    """Moves until it chooses to stay at the goal; None where it does not get there."""
    start, goal, door, least = task
    agent = known_agent(maze, start, settings=Settings(look_ahead=look_ahead), seed=seed)
    world = MazeEnv(maze)
    world.reset(options={"start": start})
    world.close_door(*door)
    observation = world.displace(start)
    for _ in range(looks):
        agent.perceive({**observation, "taken": "stay"})
    agent._state.action, agent._state.acted = agent.map.motions.stay, True
    agent.prefer(places={agent.map.place_at((goal[0] - start[0], goal[1] - start[1])) or 0: weight})
    for step in range(4 * least + 20):
        action = agent.step(observation)
        if world.position == goal and action == world.motions.names.index("stay"):
            return step
        observation, *_ = world.step(action)
    return None


def maze_of(name: str, seed: int) -> Maze:
    """One of the library by name, or one made with the seed."""
    return MAZES[name] if name in MAZES else OWN[name](seed)


def measured(name: str, asked: argparse.Namespace, look_ahead: int) -> dict[str, Any]:
    """One line of the table."""
    maze = maze_of(name, asked.seed)
    found = list(tasks(maze, asked.ways, asked.seed, asked.met))
    looks = 0 if asked.met else asked.looks
    steps = [walked(maze, task, look_ahead, asked.weight, looks, seed) for seed, task in enumerate(found)]
    there = [(made, task[-1]) for made, task in zip(steps, found, strict=True) if made is not None]
    ratio = sum(made for made, _ in there) / max(sum(least for _, least in there), 1)
    worst = max((made / least for made, least in there), default=0.0)
    never = len(found) - len(there)
    return {"look_ahead": look_ahead, "ways": len(found), "never": never, "ratio": ratio, "worst": worst}


def main(given: Sequence[str] | None = None) -> None:
    """Measure and print."""
    parser = arguments(__doc__)
    parser.add_argument("--worlds", nargs="+", default=[*MAZES, *OWN], choices=[*MAZES, *OWN])
    parser.add_argument("--look-ahead", type=int, nargs="+", default=list(range(2, 16)))
    parser.add_argument("--ways", type=int, default=4, help="starts and goals of each world")
    parser.add_argument("--met", action="store_true", help="a door anywhere on the way, met by walking there")
    parser.add_argument(
        "--looks", type=int, default=12, help="at the shut door before it sets out, so that it is known"
    )
    parser.add_argument("--weight", type=float, default=8.0, help="log preference of the goal, in nats")
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args(given)
    rows: list[dict[str, Any]] = []
    for name in asked.worlds:
        if not any(tasks(maze_of(name, asked.seed), 1, asked.seed, asked.met)):
            print(f"{name:14} no door can be done without")
            continue
        mine = [{"world": name, **measured(name, asked, look_ahead)} for look_ahead in asked.look_ahead]
        rows += mine
        ways, never = sum(row["ways"] for row in mine), sum(row["never"] for row in mine)
        mean = float(np.mean([row["ratio"] for row in mine if row["never"] < row["ways"]]))
        worst = max(row["worst"] for row in mine)
        print(f"{name:14} never {never:3} of {ways:4}  ratio {mean:.3f}  worst {worst:.2f}", flush=True)
    write_json(asked.json, {"weight": asked.weight, "seed": asked.seed, "rows": rows})


if __name__ == "__main__":
    main()
