"""Does the map stay right along recorded animals: is an agent that is led along ever believed to be elsewhere?

    python benchmarks/recordings.py mice/ --world mouse_labyrinth.json
    python benchmarks/recordings.py mice/ --world mouse_labyrinth.json --individuals B2 C7 --steps 2000 --jobs 2

The agent perceives each step and learns; it plans nothing. A step is astray where the place of its map that it holds
most probable is not where the walk has led, in the positions of the world; places are those that its map has visited.
"""

from __future__ import annotations

import time
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any

from cogmap.agent import Agent
from cogmap.behaviour import load_ground, load_walks, routes_of
from machine import arguments, write_json

KEPT = 100
"""Steps whose records the agent keeps."""


def along(individual: str, *, walks: Path, world: str, steps: int | None) -> dict[str, Any]:
    """One animal from its first bout to its last, home between them."""
    routes, ground = routes_of(load_walks(walks), load_ground(world))
    nodes = [node for route in routes if route.individual == individual for node in route.places.tolist()][:steps]
    agent = Agent(dict(ground.motions), seed=0, keep=KEPT)
    origin = (0,) * len(next(iter(ground.motions.values())))
    where, astray, begun = {nodes[0]: origin}, 0, time.process_time()
    for k, observation in enumerate(ground.observations(nodes)):
        agent.perceive(observation)
        if k and nodes[k] not in where:
            step = ground.motions[observation["taken"]]
            where[nodes[k]] = tuple(x + d for x, d in zip(where[nodes[k - 1]], step, strict=True))
        astray += agent.map.position(agent.belief.place) != where[nodes[k]]
    spent = 1000.0 * (time.process_time() - begun) / len(nodes)
    places = len(agent.map.visited_places)
    return {
        "individual": individual, "steps": len(nodes), "astray": astray, "places": places, "nodes": len(where),
        "milliseconds": spent,
    }  # fmt: skip


def main() -> None:
    parser = arguments(__doc__)
    parser.add_argument("walks", type=Path, metavar="WALKS", help="recorded walks, as `cogmap fit` takes them")
    parser.add_argument("--world", required=True, metavar="WORLD")
    parser.add_argument("--individuals", nargs="+", metavar="NAME", help="all, unless given")
    parser.add_argument("--steps", type=int, help="the first so many of each; all, unless given")
    parser.add_argument("--jobs", type=int, default=1)
    asked = parser.parse_args()
    names = sorted({walk.individual for walk in load_walks(asked.walks)})
    if unknown := [name for name in asked.individuals or () if name not in names]:
        parser.error(f"no individual {unknown[0]!r}; there are {', '.join(names)}")
    rows: list[dict[str, Any]] = []
    work = partial(along, walks=asked.walks.absolute(), world=asked.world, steps=asked.steps)
    with ProcessPoolExecutor(asked.jobs) as pool:
        for row in pool.map(work, asked.individuals or names):
            rows.append(row)
            print(
                "{individual}: {steps} steps, {astray} astray, {places} places for {nodes} nodes".format(**row),
                flush=True,
            )
    print(f"{sum(row['astray'] for row in rows)} of {sum(row['steps'] for row in rows)} steps astray")
    write_json(asked.json, {"rows": rows})


if __name__ == "__main__":
    main()
