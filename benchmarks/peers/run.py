"""One inference call and one planning call, beside pymdp: milliseconds, warm, one core, the same problem for all.

    python benchmarks/peers/run.py
    python benchmarks/peers/run.py --places 16 --peers pymdp-numpy --json peers.json

Inference is the posterior over places after one action and one sight; planning is G of each of a list of policies
(state information and utility; nothing is left to learn) and the posterior over them. Each library runs in an
environment of its own, which is made where there is none yet (pip downloads it). Posteriors and G are compared with
ours.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
import venv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
from problem import grid_problem

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent))
from machine import json_path, positive, write_json  # noqa: E402

ONE_THREAD = {
    **dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1"),
    "XLA_FLAGS": "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1",
    "JAX_PLATFORMS": "cpu",
}


@dataclass(frozen=True, slots=True)
class Peer:
    """A library: what pip installs, the script that runs it, and the environment variables it wants."""

    requirement: str
    script: str
    variables: Mapping[str, str] = field(default_factory=dict[str, str])


PEERS = {
    "pymdp-numpy": Peer("inferactively-pymdp==0.0.7.1", "side_pymdp_numpy.py"),
    "pymdp-jax": Peer("inferactively-pymdp>=1.0", "side_pymdp_jax.py", {"JAX_ENABLE_X64": "1"}),
    "pymdp-jax-single": Peer("inferactively-pymdp>=1.0", "side_pymdp_jax.py", {"JAX_ENABLE_X64": "0"}),
}
"""The second in double precision as the others, the third in single precision, which JAX takes unless told."""


def python_with(requirement: str, folder: Path) -> Path:
    """The interpreter of the environment with this requirement, made if it is not there yet."""
    home = folder / "".join(letter if letter.isalnum() else "-" for letter in requirement)
    python = home / "bin" / "python"
    if not (home / "complete").exists():
        print(f"making an environment with {requirement} in {home} ...", file=sys.stderr, flush=True)
        venv.create(home, with_pip=True, clear=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", "--quiet", requirement], check=True)
        (home / "complete").touch()
    return python


def measured(python: Path | str, peer: Peer, problems: Sequence[Path], seconds: float) -> dict[str, Any]:
    """What one side reports."""
    with tempfile.TemporaryDirectory() as folder:
        result = Path(folder) / "result.json"
        command = [str(python), str(HERE / peer.script), str(seconds), str(result), *map(str, problems)]
        subprocess.run(command, check=True, env={**os.environ, **ONE_THREAD, **peer.variables}, preexec_fn=_one_core)
        return json.loads(result.read_text())


def together(rounds: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Of several reports of one side: the last, with the median time of each call."""
    rows = [{**row} for row in rounds[-1]["rows"]]
    for i, row in enumerate(rows):
        for call in ("inference", "planning"):
            row[call] = median(report["rows"][i][call] for report in rounds)
    return {**rounds[-1], "rows": rows}


def _one_core() -> None:
    if hasattr(os, "sched_setaffinity"):  # not on macOS
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})


def table(places: Sequence[int], sides: Mapping[str, dict[str, Any]]) -> list[dict[str, Any]]:
    """A row for each size and library; `ratio` is its time for both calls together over ours."""
    rows: list[dict[str, Any]] = []
    for i, count in enumerate(places):
        ours = sides["cogmap"]["rows"][i]
        for name, side in sides.items():
            row = side["rows"][i]
            rows.append(
                {
                    "places": count,
                    "library": name,
                    "inference": row["inference"],
                    "planning": row["planning"],
                    "ratio": (row["inference"] + row["planning"]) / (ours["inference"] + ours["planning"]),
                    **{f"{part}_differs_by": _difference(row[part], ours[part]) for part in ("posterior", "G")},
                }
            )
    return rows


def _difference(one: Sequence[float], other: Sequence[float]) -> float:
    return float(np.abs(np.array(one) - np.array(other)).max())


def _square(text: str) -> int:
    places = int(text)
    if places < 4 or math.isqrt(places) ** 2 != places:
        raise argparse.ArgumentTypeError(f"{places} is no square of 2 or more; use 16, 100, 400, ...")
    return places


def _arguments(given: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--places", type=_square, nargs="+", default=[16, 100, 400])
    parser.add_argument(
        "--length", type=int, default=5, help="of the policies: all self-avoiding walks of so many steps"
    )
    parser.add_argument("--peers", nargs="*", default=list(PEERS), choices=[*PEERS, []])
    parser.add_argument("--seconds", type=float, default=2.0, help="for each call, library, size and round")
    parser.add_argument("--rounds", type=positive, default=5, help="in which the libraries take turns")
    parser.add_argument("--folder", type=Path, default=Path(tempfile.gettempdir()) / "cogmap-peers")
    parser.add_argument("--json", type=json_path)
    return parser.parse_args(given)


def main(given: Sequence[str] | None = None) -> None:
    """Measure and print."""
    asked = _arguments(given)
    with tempfile.TemporaryDirectory() as folder:
        problems = [Path(folder) / f"{count}.npz" for count in asked.places]
        for count, path in zip(asked.places, problems, strict=True):
            problem = grid_problem(math.isqrt(count), asked.length)
            np.savez(path, **problem)
        pythons = {name: python_with(PEERS[name].requirement, asked.folder) for name in asked.peers}
        turns = {"cogmap": (sys.executable, Peer("", "side_cogmap.py"))}
        turns |= {name: (python, PEERS[name]) for name, python in pythons.items()}
        rounds = [
            {name: measured(*turn, problems, asked.seconds) for name, turn in turns.items()}
            for _ in range(asked.rounds)
        ]
        sides = {name: together([reports[name] for reports in rounds]) for name in turns}
    rows = table(asked.places, sides)
    versions = {name: side["versions"] for name, side in sides.items()}
    print(
        f"{len(problem['policies'])} policies of {asked.length} steps; milliseconds, medians of warm calls and rounds"
    )
    for name, found in versions.items():
        print(f"  {name}: " + ", ".join(f"{package} {number}" for package, number in found.items()))
    print(f"{'places':>6}  {'library':16} {'inference':>10} {'planning':>10} {'ratio':>8}  posterior and G differ by")
    for row in rows:
        times = f"{row['inference']:10.3f} {row['planning']:10.3f} {row['ratio']:8.2f}"
        differences = f"{row['posterior_differs_by']:.0e}  {row['G_differs_by']:.0e}"
        print(f"{row['places']:6}  {row['library']:16} {times}  {differences}")
    write_json(
        asked.json, {"length": asked.length, "policies": len(problem["policies"]), "versions": versions, "rows": rows}
    )


if __name__ == "__main__":
    main()
