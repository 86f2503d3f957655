"""What percepts are worth: sights that are missing, soft, or vectors; two sensors; a walk led by hand; a frozen lake.

    python benchmarks/percepts.py
    python benchmarks/percepts.py soft features --seeds 0-4 --json percepts.json

An agent explores `4x4` (where not said otherwise) and goes on; its map is judged after the last step, by `judge` of
`cogmap.experiments`. `from` is the step from which on the map is right for good. Rows:

    missing20, missing50        sights are UNSEEN so often, 300 steps; and the same in 4x4_alias (-alias)
    soft, hard                  a camera takes one label for another by a random confusion matrix, 30 % in all; the
                                agent is given the likelihoods of what was seen, or the label alone
    features                    vectors of 16 numbers, 6 prototypes, noise of .3 of their spread, 80 steps
    two                         a second sensor is new to the agent, and then it is moved without a word, 3 times a seed
    hand                        led at random for 12 steps, half-way; most P(moved) of all steps
    lake                        FrozenLake, not slippery, sights alone, 60 steps
    slippery                    the same, slippery, 3,000 steps: mean absolute error over the true transitions
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from time import process_time
from typing import Any

import numpy as np
from cogmap.agent import Agent
from cogmap.experiments.judging import Trail
from cogmap.experiments.running import Moment
from cogmap.model import Features, Sight, Ways
from cogmap.worlds import frozen_lake, load_world, place_of
from machine import arguments, write_json

from cogmap import UNSEEN

Row = dict[str, Any]
See = Callable[[dict[str, Any], dict[str, Any]], dict[str, Any]]


def walked(world: Any, agent: Agent, see: See, *, steps: int, seed: int) -> tuple[Trail, int | None]:
    """Where the agent was, and from which step on its map was right for good; `see` makes its observations."""
    trail, since = Trail(), None
    observation, info = world.reset(seed=seed)
    chart = world.get_wrapper_attr("chart")
    for step in range(steps):
        seen = see(observation, info)
        action = agent.step(seen)
        trail(Moment(step, agent, world, seen, info, action))
        right = len(set(trail.rooms)) == len(chart.places) and complete(agent, trail, chart)
        since = None if not right else step if since is None else since
        observation, *_, info = world.step(action)
    return trail, since


def complete(agent: Agent, trail: Trail, chart: Any) -> bool:
    """Whether the map is right, and each of its places a room."""
    verdict = trail.verdict(agent, chart)
    return verdict.map_right and verdict.places == len(chart.places)


def missing(name: str, rate: float, seed: int) -> Row:
    """Sights that are not there."""
    rng, world = np.random.default_rng(seed), load_world(name)
    agent = Agent(world.motions, seed=seed)

    def see(seen: dict[str, Any], info: dict[str, Any]) -> dict[str, Any]:
        return {**seen, "sight": UNSEEN} if rng.random() < rate else seen

    trail, since = walked(world, agent, see, steps=300, seed=seed)
    sights = world.unwrapped.maze.sights
    false = 0
    for place in agent.map.visited_places.tolist():
        room, counts = trail.room(agent, place), agent.map.A_o.concentrations(place)
        if counts and room is not None:
            false += agent.map.sights[max(counts, key=counts.__getitem__)] != sights[room]
    return {"right": since is not None, "from": since, "false labels": false}


def confusion(labels: int, rng: np.random.Generator) -> np.ndarray:
    """`[true, read]` of a camera that is wrong in 30 % of all looks, each label in its own way."""
    table = 0.3 * rng.dirichlet(np.full(labels - 1, 0.5), size=labels)
    return np.stack([np.insert(row, at, 0.7) for at, row in enumerate(table)])


def soft(seed: int, *, told: bool) -> Row:
    """A camera that takes one label for another."""
    rng, world = np.random.default_rng(seed), load_world("4x4")
    table = confusion(16, rng)
    agent = Agent(world.motions, seed=seed)

    def see(seen: dict[str, Any], info: dict[str, Any]) -> dict[str, Any]:
        read = int(rng.choice(16, p=table[int(seen["sight"])]))
        likelihoods = {label: float(table[label, read]) for label in range(16)}
        return {**seen, "sight": likelihoods if told else read}

    _, since = walked(world, agent, see, steps=200, seed=seed)
    return {"right": since is not None, "from": since}


def features(seed: int) -> Row:
    """Vectors instead of labels."""
    rng, world = np.random.default_rng(seed), load_world("4x4")
    kinds = rng.normal(size=(6, 16))
    rooms = sorted(world.unwrapped.maze.rooms)
    kind = dict(zip(rooms, rng.permutation([*range(6), *rng.integers(6, size=10)]).tolist(), strict=True))
    view = Features("view", size=16)
    agent = Agent(world.motions, sensors=[view, Ways()], seed=seed)

    def see(seen: dict[str, Any], info: dict[str, Any]) -> dict[str, Any]:
        return {"open": seen["open"], "view": kinds[kind[info["position"]]] + 0.3 * rng.normal(size=16)}

    _, since = walked(world, agent, see, steps=80, seed=seed)
    many = len(view.prototypes)
    return {"right": since is not None and many == 6, "from": since, "prototypes": many}


def two(seed: int) -> Row:
    """A sensor that is sure, one that the agent has hardly heard of, and silent moves."""
    rng, world = np.random.default_rng(seed), load_world("4x4_alias")
    agent = Agent(world.motions, sensors=[Sight(), Sight("smell"), Ways()], seed=seed)
    rooms = sorted(world.unwrapped.maze.rooms)
    smells = dict(zip(rooms, rng.permutation(16).tolist(), strict=True))
    _, info = world.reset(seed=seed)
    start, right, wrong = info["position"], 0, 0

    def seen(smelt: bool) -> dict[str, Any]:
        return {**world.observe(), "smell": smells[world.unwrapped.position] if smelt else UNSEEN}

    for step in range(64):
        world.step(agent.step(seen(step >= 32)))
    for _ in range(3):
        world.displace(rooms[int(rng.integers(16))])
        agent.step(seen(smelt=True))
        row, column = world.unwrapped.position
        there = agent.belief.place == agent.map.place_at((row - start[0], column - start[1]))
        right, wrong = right + there, wrong + (agent.certain and not there)
        for _ in range(6):
            world.step(agent.act() if not agent._state.acted else agent.step(seen(smelt=True)))
    return {"right": right == 3, "recognised": right, "certain but wrong": wrong}


def hand(name: str, seed: int) -> Row:
    """Led at random for 12 steps after it has seen half."""
    rng, world = np.random.default_rng(seed), load_world(name)
    agent = Agent(world.motions, seed=seed)
    led, most = False, 0.0

    def see(seen: dict[str, Any], info: dict[str, Any]) -> dict[str, Any]:
        return seen

    trail, chart = Trail(), world.get_wrapper_attr("chart")
    observation, info = world.reset(seed=seed)
    for step in range(80):
        action = agent.step(see(observation, info))
        most = max(most, agent.belief.moved)
        trail(Moment(step, agent, world, observation, info, action))
        led = 8 <= step < 20
        if led:
            action = int(rng.choice(np.flatnonzero(np.array(observation["open"])[:4])))
        observation, *_, info = world.step(action)
        observation = {**observation, "taken": action} if led else observation
    places = trail.verdict(agent, chart).places
    return {"right": places == len(chart.places) and most < 0.01, "places": places, "P(moved)": most}


def lake(seed: int, *, slippery: bool) -> Row:
    """A frozen lake of 4 x 4 cells, whose ways nobody senses."""
    world = frozen_lake(4, 4, slippery=slippery)
    agent = Agent(world.motions, sensors=[Sight()], seed=seed)
    observation, info = world.reset(seed=seed)
    seen: set[Any] = set()
    steps = 3000 if slippery else 60
    for _ in range(steps):
        seen.add(place_of(info))
        observation, *_, info = world.step(agent.step(observation))
    many = len(agent.map.visited_places)
    if not slippery:
        return {"right": len(seen) == many == 16, "cells": len(seen), "places": many}
    error = lake_error(agent, world)
    return {"right": error <= 0.08, "error": error, "places": many}


def lake_error(agent: Agent, world: Any) -> float:
    """Mean of |B - P| over the transitions that are possible, or believed in; cells never seen are wrong throughout."""
    cell: dict[int, int] = {}
    for place in agent.map.visited_places.tolist():
        counts = agent.map.A_o.concentrations(place)
        cell[int(agent.map.sights[max(counts, key=counts.__getitem__)])] = place  # type: ignore[arg-type]
    P = world.unwrapped.P
    errors: list[float] = []
    for here in range(16):
        for action in range(4):
            true: dict[int, float] = {}
            for p, there, *_ in P[here][action]:
                true[there] = true.get(there, 0.0) + p
            for there, p in true.items():
                known = here in cell and there in cell
                found = agent.map.transition(cell[there], cell[here], action) if known else 0.0
                errors.append(abs(found - p))
    return float(np.mean(errors))


ROWS: dict[str, Callable[[int], Row]] = {
    **{f"missing{int(100 * p)}": lambda seed, p=p: missing("4x4", p, seed) for p in (0.2, 0.5)},
    **{f"missing{int(100 * p)}-alias": lambda seed, p=p: missing("4x4_alias", p, seed) for p in (0.2, 0.5)},
    "soft": lambda seed: soft(seed, told=True),
    "hard": lambda seed: soft(seed, told=False),
    "features": features,
    "two": two,
    "hand": lambda seed: hand("4x4", seed),
    "hand-alias": lambda seed: hand("4x4_alias", seed),
    "lake": lambda seed: lake(seed, slippery=False),
    "slippery": lambda seed: lake(seed, slippery=True),
}


def seeds(text: str) -> range:
    """`0-19`, or one number."""
    first, _, last = text.partition("-")
    return range(int(first), int(last or first) + 1)


def main(given: Sequence[str] | None = None) -> None:
    """Measure and print."""
    parser = arguments(__doc__, rows=ROWS)
    parser.add_argument("--seeds", type=seeds, default=range(20))
    asked = parser.parse_args(given)
    found: dict[str, list[Row]] = {}
    for name in asked.rows:
        begun = process_time()
        rows = found[name] = [{"seed": seed, **ROWS[name](seed)} for seed in asked.seeds]
        took = (process_time() - begun) / len(rows)
        told = {key: [row[key] for row in rows] for key in rows[0] if key not in ("seed", "right")}
        parts = [f"{key} {summary(values)}" for key, values in told.items()]
        right = sum(row["right"] for row in rows)
        print(f"{name:16} right {right} of {len(rows)}  {'  '.join(parts)}  {took:.1f} s", flush=True)
    write_json(asked.json, {"rows": found})


def summary(values: list[Any]) -> str:
    """Mean and most."""
    known = [value for value in values if value is not None]
    return f"{np.mean(known):.4g} (most {max(known):.4g})" if known else "never"


if __name__ == "__main__":
    main()
