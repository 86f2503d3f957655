"""Files that were damaged at random: each is refused in one line, or what is made of it is sound and walks on.

    python benchmarks/damage.py
    python benchmarks/damage.py agent bif --trials 1000 --seed 1 --json damage.json

Kinds are agents (of 16 places by default, 600 and 10,000 places, in doubt, lost, with several sensors or with vectors,
in the plane, without poses), recordings (also packed), ledgers, factor graphs, worlds and mazes. Half of all trials
change a value and have the right checksums, a quarter flip bits, a quarter miss their end (`--damage`). An agent that
loads takes fifty steps, after which its invariants must hold. A trial fails by any error that is none of the
library's, by more than `--seconds` of processor time or `--megabytes` beyond what a process holds before; the file is
kept in `--keep`.
"""

from __future__ import annotations

import argparse
import resource
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from traceback import extract_tb
from typing import Any

from machine import json_path, positive, write_json

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))
from fuzzing import DAMAGES, KINDS, damaged, outcome, try_agent

Row = dict[str, Any]


def measured(kind: str, asked: argparse.Namespace) -> Row:
    """Counts, the slowest, the memory taken, and what failed."""
    found, failures, slowest = Counter[str](), Counter[str](), 0.0
    with tempfile.TemporaryDirectory() as folder:
        files = damaged(kind, Path(folder), asked.trials, asked.seed, only=asked.damage)
        what, path, attempt = next(files)
        before = _peak()
        for number in range(asked.trials):
            if number:
                what, path, attempt = next(files)
            signal.alarm(30)
            begun = time.process_time()
            result = _result(path, partial(attempt, steps=asked.steps) if attempt is try_agent else attempt)
            took = time.process_time() - begun
            signal.alarm(0)
            slowest = max(slowest, took)
            if took > asked.seconds:
                result = f"failed: {took:.1f} s"
            if result not in ("fine", "refused"):
                failures[result] += 1
                asked.keep.mkdir(parents=True, exist_ok=True)
                (asked.keep / f"{kind.replace(' ', '-')}-{asked.seed}-{number}{path.suffix}").write_bytes(
                    path.read_bytes()
                )
            found[f"{what} {result.split(':')[0]}"] += 1
    row = {"kind": kind, "trials": asked.trials, "found": dict(sorted(found.items())), "failures": dict(failures)}
    return row | {"slowest_s": slowest, "peak_mb": _peak(), "more_mb": _peak() - before}


def _result(path: Path, attempt: Any) -> str:
    """`fine`, `refused`, or how it failed and where."""
    try:
        return outcome(path, attempt)
    except Exception as error:
        where = extract_tb(error.__traceback__)[-1]
        return f"failed: {type(error).__name__} {Path(where.filename).name}:{where.lineno} {str(error)[:120]}"


def _peak() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def _late(*_: object) -> None:
    raise TimeoutError("took more than 30 s")


def main(given: Sequence[str] | None = None) -> int:
    """Damage, try and print; 1 where something failed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=f"some of {', '.join(map(repr, KINDS))}")
    parser.add_argument("--trials", type=positive, default=200, help="of each kind")
    parser.add_argument("--damage", choices=DAMAGES, help="of one kind only")
    parser.add_argument("--steps", type=positive, default=50, help="that an agent which loads takes")
    parser.add_argument("--seconds", type=float, default=2.0)
    parser.add_argument("--megabytes", type=float, default=500.0)
    parser.add_argument("--keep", type=Path, default=Path("damaged"), help="folder of files that failed")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", type=json_path)
    asked = parser.parse_args(given)
    if unknown := [kind for kind in asked.kinds if kind not in KINDS]:
        parser.error(f"there is no kind {unknown[0]!r}; kinds are {', '.join(map(repr, KINDS))}")
    signal.signal(signal.SIGALRM, _late)
    rows: list[Row] = []
    for kind in asked.kinds or KINDS:
        row = measured(kind, asked)
        rows.append(row)
        counts = ", ".join(f"{what} {many}" for what, many in row["found"].items())
        print(f"{kind:14} {counts}; slowest {row['slowest_s']:.2f} s, {row['more_mb']:.0f} MB more", flush=True)
        for failure, times in Counter(row["failures"]).most_common(40):
            print(f"    {times} x {failure}", flush=True)
    write_json(asked.json, {"seed": asked.seed, "rows": rows})
    return int(any(row["failures"] or row["more_mb"] > asked.megabytes for row in rows))


if __name__ == "__main__":
    sys.exit(main())
