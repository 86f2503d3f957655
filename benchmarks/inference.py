"""What exact inference of a window costs, by engine: milliseconds a window.

    python benchmarks/inference.py
    python benchmarks/inference.py --windows 10 --supports 5 10 20 40 --json inference.json
    python benchmarks/inference.py --networks FOLDER     published networks instead, see networks.py

The graphs are those that an agent emits when it is lost: every one of `support` places of a hall that it has
walked through, all of one sight, holds mass at each of the `window` steps. What is asked is what learning after
recovery asks: every marginal, and the joint of each (s_t, s_t-1, moved_t).
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from statistics import median
from typing import Any

import networks
import numpy as np
from cogmap.inference import infer
from cogmap.model import CognitiveMap, FactorGraph, Motions, Percept, Slice, take_slice, window_graph
from cogmap.worlds import GRID
from machine import arguments, write_json

ENGINES = ("numpy", "gtsam")
ROWS = 4


def learned_hall(places: int) -> CognitiveMap:
    """The map of a hall of `places` rooms, `ROWS` rows or fewer, one sight, every door sensed and walked."""
    motions = Motions.of(GRID)
    map_ = CognitiveMap(motions)
    map_.sensors["sight"].read("grey", step=0)
    for room in np.ndindex(-(-places // ROWS), ROWS):
        if len(map_.places) < places:
            map_.new_place((int(room[0]), int(room[1])), step=0)
    for place in map_.places:
        map_.mark_visited(place)
        map_.learn(place, {"sight": 0, "open": tuple(doors(map_, place))}, 1.0)
    return map_


def doors(map_: CognitiveMap, place: int) -> list[bool]:
    """Which ways of the hall are open."""
    return [
        map_.beyond(place, action) is not None or action == map_.motions.stay for action in range(len(map_.motions))
    ]


def lost_window(map_: CognitiveMap, steps: int, rng: np.random.Generator) -> list[Slice]:
    """Slices of an agent that walks at random and may be anywhere, the prior's slice first."""
    places = np.arange(len(map_.places))
    anywhere = (places, map_.position_index.copy(), np.full(len(places), 1.0 / len(places)))
    place, action = int(rng.integers(len(places))), None
    window: list[Slice] = []
    for step in range(steps + 1):
        open_ = tuple(doors(map_, place))
        percept = Percept(action, True, {"sight": 0, "open": open_})
        stays = 0.0 if action is None else map_.pose.stays(action, opened=True)
        window.append(
            take_slice(
                map_,
                window[-1] if window else None,
                anywhere,
                map_.likelihoods(places, percept),
                step=step,
                percept=percept,
                examined=True,
                ahead=None if action is None else map_.transitions.predict(places, action, percept, stays=stays),
            )
        )
        action = int(rng.choice(np.flatnonzero(open_)))
        beyond = map_.beyond(place, action)
        place = place if beyond is None else beyond
    return window


def milliseconds(graph: FactorGraph, steps: int, engine: str, runs: int) -> tuple[float, float]:
    """Median time of one query, and its log evidence."""
    pairs = [(f"s{t}", f"s{t - 1}", f"moved{t}") for t in range(1, steps + 1)]
    spent: list[float] = []
    log_evidence = 0.0
    for _ in range(runs):
        begin = time.perf_counter()
        posterior = infer(graph, pairs=pairs, engine=engine)
        for t in range(steps + 1):
            posterior.marginal(f"s{t}")
            posterior.marginal(f"p{t}")
        spent.append(1e3 * (time.perf_counter() - begin))
        log_evidence = posterior.log_evidence
    return median(spent), log_evidence


def measured(support: int, steps: int, engines: Sequence[str], runs: int) -> dict[str, Any]:
    """One line of the table: both engines on the same graph; they must agree."""
    window = lost_window(learned_hall(support), steps, np.random.default_rng(0))
    begin = time.perf_counter()
    graph = window_graph(learned_hall(support), window)
    row: dict[str, Any] = {"window": steps, "support": support, "build": 1e3 * (time.perf_counter() - begin)}
    evidence: list[float] = []
    for engine in engines:
        row[engine], log_evidence = milliseconds(graph, steps, engine, runs)
        evidence.append(log_evidence)
    row["difference"] = max(evidence) - min(evidence)
    return row


def _arguments(given: Sequence[str] | None) -> argparse.Namespace:
    parser = arguments(__doc__)
    parser.add_argument("--windows", type=int, nargs="+", default=[1, 5, 10, 20])
    parser.add_argument("--supports", type=int, nargs="+", default=[2, 5, 10, 20, 40, 60])
    parser.add_argument("--engines", nargs="+", default=list(ENGINES), choices=ENGINES)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--networks", nargs=argparse.REMAINDER, help="a folder of networks, and options of networks.py")
    return parser.parse_args(given)


def main(given: Sequence[str] | None = None) -> None:
    """Measure and print."""
    asked = _arguments(given)
    if asked.networks is not None:
        networks.main(asked.networks)
        return
    print("milliseconds a window, median of", asked.runs)
    print("window  support " + "".join(f"{engine:>9}" for engine in asked.engines) + "   log Z differs by")
    rows: list[dict[str, Any]] = []
    for steps in asked.windows:
        for support in asked.supports:
            row = measured(support, steps, asked.engines, asked.runs)
            rows.append(row)
            times = "".join(f"{row[engine]:9.2f}" for engine in asked.engines)
            print(f"{steps:6}  {support:7} {times}   {row['difference']:.0e}", flush=True)
    write_json(asked.json, {"runs": asked.runs, "rows": rows})


if __name__ == "__main__":
    main()
