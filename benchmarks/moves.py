"""Silent moves and searches, in mazes of the paper and in others: what the pages on changes and decisions quote.

    python benchmarks/moves.py kidnap       moved after exploring, in eighteen mazes that are not built in
    python benchmarks/moves.py doors        the same with less sharp priors of doors
    python benchmarks/moves.py exploring    moved once while exploring the built-in mazes, into a room seen before
    python benchmarks/moves.py shut         shut out of rooms that close the moment it sets out for them
    python benchmarks/moves.py search       steps until each label is first seen, beside nearest-frontier search

Run i has seed i. `--mazes` chooses some of them, `--json FILE` keeps the rows.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any
from unittest.mock import patch

import numpy as np
from cogmap.agent import Agent, Settings
from cogmap.baselines import FrontierAgent
from cogmap.experiments import Truth, draw_start, explored, kidnap
from cogmap.model import Priors
from cogmap.worlds import (
    GRID,
    MAZES,
    Maze,
    MazeEnv,
    Position,
    WorldError,
    comb,
    hall,
    random_maze,
    rings,
    shortest_path,
    spiral,
)
from machine import arguments, write_json

Row = dict[str, Any]


def drawn(seed: int) -> np.random.Generator:
    """Draws the sights of a maze."""
    return np.random.default_rng(seed)


OTHERS: dict[str, Maze] = {
    "comb": comb(5, 3),
    "comb_alias": comb(6, 2, sights=3, rng=drawn(1)),
    "deep_comb": comb(3, 7, sights=3, rng=drawn(2)),
    "spiral": spiral(7),
    "spiral_alias": spiral(6, sights=3, rng=drawn(3)),
    "spiral6_3": spiral(6, sights=3, rng=drawn(1)),
    "spiral5_2": spiral(5, sights=2, rng=drawn(2)),
    "rings": rings(3, 3),
    "rings_alias": rings(2, 5, sights=3, rng=drawn(4)),
    "hall_4x4": hall(4, 4, sights=3, rng=drawn(5)),
    "hall_5x5": hall(5, 5, sights=3, rng=drawn(6)),
    "hall_5x6": hall(5, 6, sights=3, rng=drawn(7)),
    "hall_3x10": hall(3, 10, sights=3, rng=drawn(8)),
    "hall45_2": hall(4, 5, sights=2, rng=drawn(3)),
    "random": random_maze(26, sights=3, rng=drawn(9)),
    "random20_2": random_maze(20, sights=2, rng=drawn(4)),
    "random40_4": random_maze(40, sights=4, rng=drawn(5)),
    "random12_4": random_maze(12, sights=4, rng=drawn(6)),
}
OPEN_MINDED = {"never": 2.0, "odds 7 to 3": 0.7, "as it is": None}
"""Probability from which an agent believes that it had been moved before."""


def kidnapped(maze: Maze, runs: int, priors: Priors | None = None) -> Row:
    """Moved after exploring: how many recovered, in how many steps, with the map intact."""
    done = [kidnap(maze, settings=Settings(priors=priors or Priors()), seed=seed) for seed in range(runs)]
    steps = [run.steps_to_recover for run in done if run.steps_to_recover is not None]
    wrong = [run.steps_certain_but_wrong for run in done if run.steps_certain_but_wrong is not None]
    return {
        "recovered": sum(run.recovered for run in done),
        "steps": float(np.mean(steps)),
        "wrong": float(np.mean(wrong)),
        "intact": sum(run.map_intact is True for run in done),
    }


def kidnap_rows(name: str, maze: Maze, runs: int) -> list[Row]:
    """With the priors as they are."""
    return [kidnapped(maze, runs)]


def doors_rows(name: str, maze: Maze, runs: int) -> list[Row]:
    """By prior of a transition and floor of a door."""
    pairs = ((1e-4, 1e-5), (1e-6, 1e-6))
    return [
        {
            "priors": f"{transition:g}, {floor:g}",
            **kidnapped(maze, runs, Priors(transition=transition, door_floor=floor)),
        }
        for transition, floor in pairs
    ]


def exploring_rows(name: str, maze: Maze, runs: int) -> list[Row]:
    """By how soon it believes that it had been moved: maps that came out right, and steps certain but wrong."""
    rows: list[Row] = []
    for label, probability in OPEN_MINDED.items():
        if probability is None:
            done = [moved_while_exploring(maze, seed) for seed in range(runs)]
        else:
            with patch("cogmap.agent.recognition.DECIDED", probability):
                done = [moved_while_exploring(maze, seed) for seed in range(runs)]
        rows.append({"changes its mind": label, "right": sum(right for right, _ in done), "wrong": _mean(done)})
    return rows


def _mean(done: Sequence[tuple[bool, int]]) -> float:
    return float(np.mean([wrong for _, wrong in done]))


def moved_while_exploring(maze: Maze, seed: int) -> tuple[bool, int]:
    """Whether the map came out right, with no place too many, and the steps certain but wrong."""
    rng, rooms = np.random.default_rng(seed), list(maze.rooms)
    start = rooms[int(rng.integers(len(rooms)))]
    world, agent = MazeEnv(maze), Agent(GRID, seed=seed)
    world.reset(options={"start": start})
    at, seen, wrong = int(rng.integers(3, len(rooms))), [start], 0
    for step in range(8 * len(rooms)):
        if step == at:
            others = [room for room in seen if room != world.position]
            world.displace(others[int(rng.integers(len(others)))])
        seen += [world.position] * (world.position not in seen)
        action = agent.step(world.observe())
        row, column = world.position
        wrong += agent.certain and agent.belief.place != agent.map.place_at((row - start[0], column - start[1]))
        world.step(action)
    return len(agent.map.places) == len(rooms) and Truth(maze, start).learned(agent.map), wrong


def shut_rows(name: str, maze: Maze, runs: int) -> list[Row]:
    """By how a door shut in the face is counted: runs right about it the step after, and goals reached all the same."""
    done = [shut_out(maze, seed) for seed in range(runs)]
    with (
        patch("cogmap.inference.filter.found_shut", _thrice),
        patch("cogmap.model.slices.found_shut", _thrice),
    ):
        before = [shut_out(maze, seed) for seed in range(runs)]
    return [
        {"counted": label, "right": sum(right for right, _ in part), "reached": sum(there for _, there in part)}
        for label, part in (("once", done), ("three times", before))
    ]


def _thrice(map_: Any, places: Any, keys: Any, p: Any, action: int, open_: Any, *, slip: float) -> Any:
    return np.ones(keys.shape)


def shut_out(maze: Maze, seed: int) -> tuple[bool, bool]:
    """Explored and at rest, sent to another room, and shut out of the first two rooms that it can do without.

    Answers whether it was certain and right after each, and whether it stayed at the goal within six steps a room.
    """
    session = explored("moves", maze, seed)
    agent, world, rng = session.agent, session.world, np.random.default_rng(seed)
    goal = maze.rooms[int(rng.integers(len(maze.rooms)))]
    place = agent.map.place_at((goal[0] - session.start[0], goal[1] - session.start[1]))
    agent.prefer({}, places={} if place is None else {place: 8.0})
    right, closed = True, list[Position]()
    for _ in range(6 * len(maze.rooms)):
        action = agent.step(world.observe())
        if world.position == goal and action == agent.map.motions.stay:
            return right, True
        down, across = GRID.displacements[action]
        ahead = (world.position[0] + down, world.position[1] + across)
        shut = len(closed) < 2 and ahead not in (goal, world.position) and _way_round(maze, [*closed, ahead], goal)
        if shut:
            closed.append(ahead)
            world.close_room(ahead)
        world.step(action)
        if shut:
            action = agent.step(world.observe())
            right = right and agent.certain and agent.belief.place == session.true_place
            world.step(action)
    return right, False


def _way_round(maze: Maze, closed: list[Position], goal: Position) -> bool:
    left = [room for room in maze.rooms if room not in closed]
    try:
        return all(shortest_path(maze, room, goal, closed=closed) for room in left)
    except WorldError:
        return False


def search_rows(name: str, maze: Maze, runs: int) -> list[Row]:
    """Steps until a label is first seen, mean over all labels, and the same over all rooms."""
    walkers: dict[str, Callable[[np.random.SeedSequence], Agent | FrontierAgent]] = {
        "cogmap": lambda seed: Agent(GRID, seed=int(seed.generate_state(1)[0])),
        "frontier": lambda seed: FrontierAgent(GRID, seed=seed),
    }
    rows: list[Row] = []
    for label, made in walkers.items():
        starts = [draw_start("moves", maze, seed) for seed in range(runs)]
        found = [first_seen(maze, made(seeds), start) for start, seeds, _ in starts]
        labels, rooms = (float(np.mean(part)) for part in zip(*found, strict=True))
        rows.append({"walker": label, "labels": labels, "rooms": rooms})
    return rows


def first_seen(maze: Maze, walker: Agent | FrontierAgent, start: Position) -> tuple[float, float]:
    """Mean over the labels, and over the rooms, of the step at which a walker that explores first meets them."""
    world = MazeEnv(maze)
    observation, _ = world.reset(options={"start": start})
    labels: dict[Any, int] = {}
    rooms: dict[Position, int] = {}
    for step in range(20 * len(maze.rooms)):
        labels.setdefault(observation["sight"], step)
        rooms.setdefault(world.position, step)
        if len(rooms) == len(maze.rooms):
            break
        observation, *_ = world.step(walker.step(observation))
    return float(np.mean(list(labels.values()))), float(np.mean(list(rooms.values())))


MEASURES: Mapping[str, tuple[Callable[[str, Maze, int], list[Row]], Mapping[str, Maze]]] = {
    "kidnap": (kidnap_rows, OTHERS),
    "doors": (doors_rows, OTHERS),
    "exploring": (exploring_rows, MAZES),
    "shut": (shut_rows, MAZES),
    "search": (search_rows, MAZES),
}


def main(given: Sequence[str] | None = None) -> None:
    """Measure and print."""
    parser = arguments(__doc__)
    parser.add_argument("measure", choices=MEASURES)
    parser.add_argument("--mazes", nargs="+", help="all of the measure unless given")
    parser.add_argument("--runs", type=int, default=20)
    asked = parser.parse_args(given)
    measure, mazes = MEASURES[asked.measure]
    if unknown := sorted(set(asked.mazes or ()) - set(mazes)):
        parser.error(f"no maze {', '.join(unknown)}; choose from {', '.join(mazes)}")
    if asked.runs < 1:
        parser.error(f"runs is {asked.runs}; use 1 or more")
    rows: list[Row] = []
    for name in asked.mazes or mazes:
        for row in measure(name, mazes[name], asked.runs):
            rows.append({"maze": name, **row})
            values = (
                f"{key} {value:.2f}" if isinstance(value, float) else f"{key} {value}" for key, value in row.items()
            )
            print(f"{name:13} {', '.join(values)}", flush=True)
    for key in ("recovered", "intact", "right", "reached", "labels", "rooms"):
        if key in rows[0]:
            print(f"{key}: {_totals(rows, key)}")
    write_json(asked.json, {"measure": asked.measure, "runs": asked.runs, "rows": rows})


def _totals(rows: Sequence[Row], key: str) -> str:
    """Sum of counts, mean of means, by variant."""
    kinds: dict[str, list[float]] = {}
    for row in rows:
        variant = next(
            (str(row[name]) for name in ("priors", "changes its mind", "counted", "walker") if name in row), "all"
        )
        kinds.setdefault(variant, []).append(row[key])
    counts = isinstance(rows[0][key], int)
    return ", ".join(
        f"{variant} {sum(values) if counts else float(np.mean(values)):g}" for variant, values in kinds.items()
    )


if __name__ == "__main__":
    main()
