"""Files that were damaged at random: each is refused in one line, or what is made of it is sound and walks on.

    python benchmarks/damage.py
    python benchmarks/damage.py agent bif --trials 1000 --seed 1 --json damage.json
    python benchmarks/damage.py --full --jobs 2

Kinds are agents (of 16 places by default, 600 and 10,000 places, in doubt, lost, with several sensors or with vectors,
in the plane, without poses), recordings (also packed), ledgers, factor graphs, worlds and mazes. Half of all trials
change a value and have the right checksums, a quarter flip bits, a quarter miss their end (`--damage`). `--full`: the
numbers of `FULL`, 50,000 flips, 30,000 ends and 10,000 changes of agents, and a little more of all other files.

An agent that loads takes fifty steps, after which its invariants must hold; but for one in `--whole` it looks one step
ahead and keeps few hypotheses for that, and where checksums are wrong it takes five. A trial fails by any error that is
none of the library's, or where reading takes more than `--seconds` of processor time or `--megabytes` beyond what a
process holds before; the file is kept in `--keep`. Trials are made in processes of their own, with a bound on memory
and an alarm after 60 s: what hangs or crashes ends one of them, is told, and the rest goes on.
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
from concurrent.futures import ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from random import Random
from traceback import extract_tb
from typing import Any

from machine import json_path, positive, write_json

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))
from fuzzing import DAMAGES, KINDS, changes, outcome, try_agent

Row = dict[str, Any]
FORK = get_context("fork")
ROOM = 2 * 2**30
"""Bytes that a process of trials may ask for beyond what it begins with; what needs more fails."""

CHUNK = 500
FULL = {
    "agent": (40_000, 24_000, 6_500), "doubting": (1500, 1000, 400), "lost": (1500, 1000, 400),
    "told": (2500, 1500, 1000), "plane": (2000, 1200, 800), "no poses": (2000, 1000, 800),
    "agent600": (470, 280, 85), "agent10000": (30, 20, 15),
}  # fmt: skip
"""Flips, ends and changes of each kind."""

OTHERS = (5000, 3000, 1000)


class Trials:
    """Trials of one kind.

    Args:
        kind: of the file.
        folder: an empty one.
        asked: options of the command line.
    """

    def __init__(self, kind: str, folder: Path, asked: argparse.Namespace) -> None:
        self.kind, self.folder, self.asked = kind, folder, asked
        name, make, self.attempt, _ = KINDS[kind]
        self.name, self.found, self.failures = name, Counter[str](), Counter[str]()
        self.slowest = self.more = 0.0
        make(folder / name)
        self.content = (folder / name).read_bytes()

    def run(self, task: tuple[str, int, int]) -> None:
        """Trials of one damage from one number up to another, in a process of their own."""
        what, begin, end = task
        if begin >= end:
            return
        at, (ours, theirs) = FORK.RawValue("i", begin), FORK.Pipe(duplex=False)
        process = FORK.Process(target=self._work, args=(what, begin, end, at, theirs))
        process.start()
        theirs.close()
        try:
            found, failures, slowest, more = ours.recv()
        except EOFError:
            process.join()
            self._keep(what, at.value, f"failed: ended by signal {-(process.exitcode or 0)}", self.failures)
            self.found[f"{what} failed"] += 1
            self.run((what, begin, at.value))
            self.run((what, at.value + 1, end))
            return
        process.join()
        self.found += found
        self.failures += failures
        self.slowest, self.more = max(self.slowest, slowest), max(self.more, more)

    def _work(self, what: str, begin: int, end: int, at: Any, theirs: Any) -> None:
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        most = 4096 * int(Path("/proc/self/statm").read_text().split()[0]) + ROOM
        resource.setrlimit(resource.RLIMIT_AS, (most, most))
        folder = self.folder / f"{what}-{begin}"
        folder.mkdir(exist_ok=True)
        found, failures, slowest, before = Counter[str](), Counter[str](), 0.0, _peak()
        for at.value in range(begin, end):
            (folder / self.name).write_bytes(self._damaged(what, at.value))
            signal.alarm(60)
            result, took = self._try(folder / self.name, what, at.value)
            signal.alarm(0)
            slowest = max(slowest, took)
            if took > self.asked.seconds:
                result = f"failed: {took:.1f} s"
            if result not in ("fine", "refused"):
                self._keep(what, at.value, result, failures)
            found[f"{what} {result.split(':')[0]}"] += 1
        theirs.send((found, failures, slowest, _peak() - before))

    def _damaged(self, what: str, number: int) -> bytes:
        return changes(self.kind)[what](self.content, Random(f"{self.kind} {what} {self.asked.seed} {number}"))

    def _try(self, path: Path, what: str, number: int) -> tuple[str, float]:
        """`fine`, `refused`, or how it failed and where; and the seconds that reading took."""
        begun = time.process_time()
        read = list[float]()
        steps = self.asked.steps if what == "change" else min(self.asked.steps, 5)

        def attempt(path: Path) -> None:
            if self.attempt is try_agent:
                light = number % self.asked.whole > 0
                try_agent(path, steps=steps, light=light, loaded=lambda: read.append(time.process_time() - begun))
            else:
                self.attempt(path)

        try:
            result = outcome(path, attempt)
        except Exception as error:
            where = extract_tb(error.__traceback__)[-1]
            result = f"failed: {type(error).__name__} {Path(where.filename).name}:{where.lineno} {str(error)[:120]}"
        return result, read[0] if read else time.process_time() - begun

    def _keep(self, what: str, number: int, result: str, failures: Counter[str]) -> None:
        failures[result] += 1
        self.asked.keep.mkdir(parents=True, exist_ok=True)
        name = f"{self.kind.replace(' ', '-')}-{what}-{self.asked.seed}-{number}{Path(self.name).suffix}"
        (self.asked.keep / name).write_bytes(self._damaged(what, number))


def measured(kind: str, asked: argparse.Namespace) -> Row:
    """Counts, the slowest, the memory taken, and what failed."""
    begun, counts = time.monotonic(), dict(zip(DAMAGES, FULL.get(kind, OTHERS), strict=True))
    if not asked.full:
        quarter = asked.trials // 4
        counts = {"flip": quarter, "end": quarter, "change": asked.trials - 2 * quarter}
    if asked.damage:
        counts = {asked.damage: counts[asked.damage] if asked.full else asked.trials}
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(asked.jobs) as threads:
        trials = Trials(kind, Path(folder), asked)
        tasks = [(what, at, min(at + CHUNK, n)) for what, n in counts.items() for at in range(0, n, CHUNK)]
        list(threads.map(trials.run, tasks))
    row = {"kind": kind, "trials": sum(counts.values()), "found": dict(sorted(trials.found.items()))}
    row |= {"failures": dict(trials.failures), "slowest_s": trials.slowest, "more_mb": trials.more}
    return row | {"s": time.monotonic() - begun}


def _peak() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def main(given: Sequence[str] | None = None) -> int:
    """Damage, try and print; 1 where something failed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=f"some of {', '.join(map(repr, KINDS))}")
    parser.add_argument("--trials", type=positive, default=200, help="of each kind")
    parser.add_argument("--full", action="store_true", help="as many trials as FULL says, in about twenty minutes")
    parser.add_argument("--damage", choices=DAMAGES, help="of one kind only")
    parser.add_argument("--steps", type=positive, default=50, help="that an agent which loads takes")
    parser.add_argument("--whole", type=positive, default=50, help="one agent in so many keeps its settings")
    parser.add_argument("--jobs", type=positive, default=1, help="processes at a time")
    parser.add_argument("--seconds", type=float, default=2.0)
    parser.add_argument("--megabytes", type=float, default=500.0)
    parser.add_argument("--keep", type=Path, default=Path("damaged"), help="folder of files that failed")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", type=json_path)
    asked = parser.parse_args(given)
    if unknown := [kind for kind in asked.kinds if kind not in KINDS]:
        parser.error(f"there is no kind {unknown[0]!r}; kinds are {', '.join(map(repr, KINDS))}")
    rows: list[Row] = []
    for kind in asked.kinds or KINDS:
        row = measured(kind, asked)
        rows.append(row)
        counts = ", ".join(f"{what} {many}" for what, many in row["found"].items())
        print(f"{kind:14} {counts}; slowest {row['slowest_s']:.2f} s, {row['more_mb']:.0f} MB more; {row['s']:.0f} s")
        for failure, times in Counter(row["failures"]).most_common(40):
            print(f"    {times} x {failure}")
        sys.stdout.flush()
    write_json(asked.json, {"seed": asked.seed, "rows": rows})
    return int(any(row["failures"] or row["more_mb"] > asked.megabytes for row in rows))


if __name__ == "__main__":
    sys.exit(main())
