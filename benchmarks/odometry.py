"""A robot's log replayed: are the cells that it drove through one place each, and do the places lie where they should?

    python benchmarks/odometry.py intel.json
    python benchmarks/odometry.py intel.json --labels 8 --starts 10 --cell 2

The log has `odometry`, moves (dx, dy, dθ) in the robot's own frame, and `truth`, the poses (x, y, θ) as they were
optimised by others. The floor is cut into square cells; the agent is told the label of a cell as it enters it, and the
displacement since it entered the one before, as raw odometry has it: with all its drift, and nothing else. Labels are
all different, or so many at random, by the seed. A cell is right if all its visits were held to be in one place, which
no visit to another cell was held to be in. Places are laid over the truth by the rigid motion that fits best.
"""

from __future__ import annotations

import json
import time
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
from cogmap.agent import Agent
from cogmap.model import Plane, Sight, Ways
from machine import arguments, positive, write_json
from numpy.typing import NDArray

Floats = NDArray[np.float64]
MOTIONS = ("stay", "go")


def reckoned(odometry: Floats) -> Floats:
    """`[n + 1, 2]` positions by dead reckoning."""
    x, y, heading = 0.0, 0.0, 0.0
    found = [(x, y)]
    for dx, dy, turn in odometry.tolist():
        c, s = np.cos(heading), np.sin(heading)
        x, y, heading = x + c * dx - s * dy, y + s * dx + c * dy, heading + turn
        found.append((x, y))
    return np.array(found)


def entries(truth: Floats, cell: float) -> list[tuple[int, tuple[int, int]]]:
    """The steps at which another cell is entered, and that cell."""
    cells = [tuple(each) for each in np.round(truth[:, :2] / cell).astype(int).tolist()]
    return [(k, here) for k, here in enumerate(cells) if not k or here != cells[k - 1]]


def replayed(log: dict[str, Any], cell: float, labels: int | None, seed: int) -> dict[str, Any]:
    """One replay, and what it is measured by."""
    truth, dead = np.array(log["truth"]), reckoned(np.array(log["odometry"]))
    visits = entries(truth, cell)
    cells = list(dict.fromkeys(here for _, here in visits))
    drawn = range(len(cells)) if labels is None else np.random.default_rng(seed).integers(labels, size=len(cells))
    label = dict(zip(cells, map(int, drawn), strict=True))
    motions: Any = type("Motions", (), {"names": MOTIONS, "displacements": (), "reverse": (0, -1)})()
    agent = Agent(motions, sensors=[Sight(), Ways()], pose=Plane(), seed=seed)
    held: list[int] = []
    begun, before = time.process_time(), visits[0][0]
    for k, here in visits:
        seen: dict[str, Any] = {"sight": label[here], "open": [True, True]}
        told = {} if k == before else {"taken": "go", "displacement": tuple((dead[k] - dead[before]).tolist())}
        held.append(agent.perceive({**seen, **told}).place)
        before = k
    spent = 1000.0 * (time.process_time() - begun) / len(visits)
    in_cell, in_place = defaultdict[Any, set[int]](set), defaultdict[int, set[Any]](set)
    for (_, here), place in zip(visits, held, strict=True):
        in_cell[here].add(place)
        in_place[place].add(here)
    right = [here for here in cells if len(in_cell[here]) == 1 and len(in_place[min(in_cell[here])]) == 1]
    return {
        "labels": labels or "distinct", "seed": seed, "visits": len(visits), "cells": len(cells), "right": len(right),
        "split": sum(len(places) > 1 for places in in_cell.values()),
        "mixed": sum(len(found) > 1 for found in in_place.values()),
        "off": _off(agent, truth, visits, held), "milliseconds": spent,
    }  # fmt: skip


def _off(agent: Agent, truth: Floats, visits: list[tuple[int, tuple[int, int]]], held: list[int]) -> float:
    """How far a place lies from where it was truly entered, on average, in the median over places."""
    places = sorted(set(held))
    mine = np.array([(agent.map.position(place) or (np.nan, np.nan))[:2] for place in places], dtype=np.float64)
    entered = {
        place: [truth[k, :2] for (k, _), at in zip(visits, held, strict=True) if at == place] for place in places
    }
    true = np.array([np.mean(entered[place], axis=0) for place in places])
    middle, around = mine.mean(axis=0), true.mean(axis=0)
    u, _, v = np.linalg.svd((mine - middle).T @ (true - around))
    turn = u @ np.diag([1.0, np.sign(np.linalg.det(u @ v))]) @ v
    return float(np.median(np.linalg.norm((mine - middle) @ turn + around - true, axis=1)))


def main() -> None:
    parser = arguments(__doc__)
    parser.add_argument("log", type=Path, metavar="LOG")
    parser.add_argument("--labels", type=positive, help="drawn at random; all different unless given")
    parser.add_argument("--cell", type=float, default=2.0, help="metres a side")
    parser.add_argument("--starts", type=positive, default=1, help="seeds of labels at random")
    parser.add_argument("--seed", type=int, default=0)
    args = parser.parse_args()
    log = json.loads(args.log.read_text())
    rows = [replayed(log, args.cell, args.labels, seed) for seed in range(args.seed, args.seed + args.starts)]
    for row in rows:
        print(
            "  ".join(
                f"{key} {value:.2f}" if isinstance(value, float) else f"{key} {value}" for key, value in row.items()
            )
        )
    write_json(args.json, {"rows": rows})


if __name__ == "__main__":
    main()
