"""What each side does with its two calls: warm them, time them, and write down times and results."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path

import numpy as np
from problem import Arrays, read_problem

Side = Callable[[Arrays], tuple[Callable[[], object], Callable[[], object], Callable[[], tuple[object, object]]]]
"""From a problem to the inference call, the planning call, and what gives posterior and G of the last calls."""


def milliseconds(call: Callable[[], object], seconds: float) -> list[float]:
    """Time of each warm call, for so many seconds in all (five calls at least)."""
    for _ in range(3):
        call()
    spent: list[float] = []
    end = time.perf_counter() + seconds
    while len(spent) < 5 or time.perf_counter() < end:
        begin = time.perf_counter()
        call()
        spent.append(1e3 * (time.perf_counter() - begin))
    return spent


def main(side: Side, packages: tuple[str, ...]) -> None:
    """`python SIDE.py SECONDS RESULT PROBLEM...`: write times, results and versions as JSON."""
    seconds, result, *problems = sys.argv[1:]
    rows = []
    for path in problems:
        infer, plan, last = side(read_problem(path))
        times = {"inference": milliseconds(infer, float(seconds)), "planning": milliseconds(plan, float(seconds))}
        posterior, G = (np.asarray(part, dtype=np.float64).ravel().tolist() for part in last())
        medians = {name: float(np.median(spent)) for name, spent in times.items()}
        counts = {f"{name}_calls": len(spent) for name, spent in times.items()}
        rows.append({**medians, **counts, "posterior": posterior, "G": G})
    versions = {"python": sys.version.split()[0], **{name: version(name) for name in packages}}
    Path(result).write_text(json.dumps({"versions": versions, "rows": rows}))
