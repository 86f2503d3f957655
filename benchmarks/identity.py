"""How places are recognised: rows of worlds and noise, with poses and without.

python benchmarks/identity.py ROW [ROW ...] --seeds 0-19 --json FILE
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from cogmap.inference.hypotheses import Tracker, TrackerOptions
from cogmap.inference.hypotheses.rates import ASTRAY, FAILS, MOVED, SIGHT_MISREAD, WAY_MISREAD
from cogmap.worlds import load_world
from identity_explorer import Explorer
from identity_world import Noise, Rooms, World, behaviours, grid, judge, room_of, scheme


def maze(name: str) -> Rooms:
    sights = load_world(name).unwrapped.maze.sights
    labels = {label: k for k, label in enumerate(sorted(set(sights.values()), key=str))}
    return grid({room: labels[label] for room, label in sights.items()})


def torus(n: int, sights: str, seed: int) -> Rooms:
    rng = np.random.default_rng(770_000 + seed)
    while True:
        cells = {
            (r, c): r * n + c if sights == "distinct" else (r + c) % 3 if sights == "mod3" else int(rng.integers(6))
            for r in range(n)
            for c in range(n)
        }
        rooms = grid(cells, (n, n))
        if sights != "six" or behaviours(rooms) == n * n:
            return rooms


def portals(n: int, count: int, labels: int, seed: int) -> Rooms:
    """A grid with two-way portals between outer walls that face each other."""
    rng = np.random.default_rng(880_000 + seed)
    while True:
        rooms = grid(
            {(r, c): int(rng.integers(labels)) if labels < n * n else r * n + c for r in range(n) for c in range(n)}
        )
        for _ in range(count):
            one, other = [(0, 1), (1, 0), (2, 3), (3, 2)][int(rng.integers(4))]
            free = [[k for k, row in enumerate(rooms.ways) if row[way] == k] for way in (one, other)]
            a, b = (int(rng.choice(side)) for side in free)
            rooms.ways[a][one], rooms.ways[b][other] = b, a
        if behaviours(rooms) == n * n:
            return rooms


QUIET = Noise()


@dataclass
class Row:
    """One row of the table: how its world is made, what goes wrong, for how long."""

    rooms: object
    steps: int
    noise: Noise = QUIET
    poses: bool = True
    inverses: bool = True
    doors: bool = True
    moves: int = 0
    after: int = 150


def rows() -> dict[str, Row]:
    found: dict[str, Row] = {}
    for n in (3, 4, 5):
        for sights, times in (("distinct", 10), ("six", 10), ("mod3", 10)):
            found[f"torus{n}-{sights}"] = Row(lambda s, n=n, k=sights: torus(n, k, s), times * n * n)
    found["portal4"] = Row(lambda s: portals(4, 1, 99, s), 200)
    found["portals5"] = Row(lambda s: portals(5, 3, 12, s), 250)
    names = ["3x3", "3x3_alias", "4x4", "4x4_alias", "t_maze", "t_maze_alias", "donut", "tolman"]
    for name in names:
        room = lambda s, name=name: maze(name)  # noqa: E731
        found[f"plain-{name}"] = Row(room, 60)
        found[f"moved-{name}"] = Row(room, 12, moves=1, after=150)
        found[f"moved3-{name}"] = Row(room, 12, moves=3, after=200)
        for kind in ("slip", "fail", "sight", "door"):
            for percent in (5, 10, 20, 30):
                found[f"{kind}{percent}-{name}"] = Row(room, 400, Noise(**{kind: percent / 100}))
        found[f"all-{name}"] = Row(room, 400, Noise(sight=0.05, door=0.05, slip=0.05, moved=0.01))
        found[f"nopose-{name}"] = Row(room, 200, poses=False)
        found[f"noinverse-{name}"] = Row(room, 200, poses=False, inverses=False)
        found[f"blind-{name}"] = Row(room, 400, poses=False, doors=False)
        found[f"nodoors-{name}"] = Row(room, 300, doors=False)
    return found


def stable(history: list[bool]) -> int | None:
    k = len(history)
    while k > 0 and history[k - 1]:
        k -= 1
    return k if k < len(history) else None


def run(row: Row, seed: int, options: TrackerOptions) -> dict[str, Any]:
    rooms = row.rooms(seed)  # type: ignore[operator]
    rng = np.random.default_rng(990_000 + seed)
    world = World(rooms, int(rng.integers(len(rooms.sights))), rng, row.noise, doors=row.doors)
    tracker = Tracker(scheme(poses=row.poses, inverses=row.inverses), options)
    explorer = Explorer(tracker, seed, doors=row.doors)
    moves = sorted(
        int(x) for x in np.cumsum([rng.integers(3, 13) if k == 0 else rng.integers(10, 40) for k in range(row.moves)])
    )
    steps = row.steps if not row.moves else moves[-1] + row.after
    labels: set[int] = set()
    exact: list[bool] = []
    right: list[bool] = []
    bins: list[tuple[float, bool]] = []
    alive, spent = [], 0.0
    all_seen = None
    n = len(rooms.sights)
    action: int | None = None
    for t in range(steps + 1):
        if action is None:
            percept = world.percept(None)
        else:
            if t in moves:
                world.act(action)
                del world.history[world.time - 1]
                world.time -= 1
                world.room = int(rng.choice([z for z in range(n) if z != world.room]))
                percept = world.percept(action)
            else:
                percept = world.act(action)
        labels.add(percept.sights[0])  # type: ignore[arg-type]
        began = time.process_time()
        tracker.step(percept, [len(labels)])
        spent += time.process_time() - began
        alive.append(len(tracker.hypotheses))
        h = tracker.best
        found = judge(h, world)
        exact.append(found.exact(n) and found.visited == n)
        right.append(found.right and (found.places == found.visited or not row.moves))
        if all_seen is None and found.visited == n:
            all_seen = t
        bins.append((tracker.certainty(), room_of(h, h.here, world.history) == world.room))
        action = explorer.act()
    h = tracker.best
    last = judge(h, world)
    start = moves[-1] if moves else 0
    wrong_sure = sum(1 for p, ok in bins if p >= 0.99 and not ok)
    sure = sum(1 for p, _ in bins if p >= 0.99)
    since = stable(exact)
    rates = (("sight", SIGHT_MISREAD), ("door", WAY_MISREAD), ("fails", FAILS), ("astray", ASTRAY), ("moved", MOVED))
    return {
        "seed": seed,
        "exact": exact[-1],
        "from": since,
        "after": None if since is None else max(0, since - start),
        "places": last.places,
        "size": h.size,
        "right": last.right,
        "known": round(last.known, 3),
        "visited": last.visited,
        "seen_all": all_seen,
        "sure": sure,
        "wrong_sure": wrong_sure,
        "here_late": round(float(np.mean([ok for _, ok in bins[200:]])), 3) if len(bins) > 200 else None,
        "alive": round(float(np.mean(alive)), 1),
        "ms": round(1000 * spent / (steps + 1), 2),
        "certainty": round(bins[-1][0], 3),
        "rates": {name: round(h.counts.mean(rate), 3) for name, rate in rates},
        "bins": bins,
    }


def summary(name: str, results: list[dict[str, Any]]) -> str:
    """What the runs of a row come to, in a line."""
    after = sorted(r["after"] for r in results if r["after"] is not None)
    seen = [r["seen_all"] for r in results if r["seen_all"] is not None]
    rates = {k: round(float(np.mean([r["rates"][k] for r in results])), 3) for k in results[0]["rates"]}
    parts = (
        f"exact {sum(bool(r['exact']) for r in results)}/{len(results)}",
        f"from median {np.median(after) if after else None}, latest {after[-1] if after else None}",
        f"all seen {np.mean(seen) if seen else None} ({len(seen)})",
        f"hypotheses {np.mean([r['alive'] for r in results]):.1f}",
        f"ms {np.mean([r['ms'] for r in results]):.2f}",
        f"sure {sum(r['sure'] for r in results)}, of these wrong {sum(r['wrong_sure'] for r in results)}",
        f"right late {np.mean([r['here_late'] or 0 for r in results]):.3f}",
    )
    return f"{name}: {'; '.join(parts)}; rates {rates}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("rows", nargs="+")
    parser.add_argument("--seeds", default="200-204")
    parser.add_argument("--json")
    parser.add_argument("--most", type=int, default=32)
    parser.add_argument("--least", type=float, default=1e-5)
    parser.add_argument("-v", action="store_true")
    args = parser.parse_args()
    first, last = (int(x) for x in args.seeds.split("-"))
    options = TrackerOptions(most=args.most, least=args.least)
    table = rows()
    names = [
        name
        for name in table
        if any(name == want or (want.endswith("*") and name.startswith(want[:-1])) for want in args.rows)
    ]
    everything: dict[str, object] = {}
    for name in names:
        results = [run(table[name], seed, options) for seed in range(first, last + 1)]
        everything[name] = results
        print(summary(name, results), flush=True)
        for r in results:
            if args.v or not r["exact"]:
                print("   ", {k: v for k, v in r.items() if k not in ("bins", "rates")})
    if args.json:
        Path(args.json).write_text(json.dumps(everything, default=str))


if __name__ == "__main__":
    main()
