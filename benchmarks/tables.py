"""Measures the tables and figures of README.md and docs/ anew, and writes them there.

    python benchmarks/tables.py --all --jobs 2
    python benchmarks/tables.py kidnap navigate --jobs 2
    python benchmarks/tables.py mice --jobs 2

Only the cells of measured rows are written; what a page says of them in words is printed, to be read beside it.
`--all` makes everything but `mice`, which needs recordings and more than an hour. `--keep DIR` keeps finished runs of
`exploration` and `rooms` there, and the same command goes on from them.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any

from cogmap.experiments import (
    Parts,
    exploration,
    explore_many,
    kidnap_many,
    kidnap_result,
    navigate_many,
    navigate_result,
    workers,
)
from cogmap.worlds import MAZES
from figures import STUDIES, spoken

ROOT = Path(__file__).resolve().parents[1]
GOALS = {"3x3": 8, "3x3_alias": 2, "4x4": 12, "4x4_alias": 5, "t_maze": 7, "t_maze_alias": 0, "donut": 12, "tolman": 0}
Rows = Mapping[str, Sequence[str]]


def written(page: str, heading: str, rows: Rows, *, first: int = 1, whole: bool = False) -> str:
    """The page with the cells of its table under `heading` replaced from the `first` on, row by row.

    A row begins with its name, the name of a maze in backticks. With `whole` the table has these rows and no others.

    Raises:
        ValueError: there is no such table, or it has no row of that name.
    """
    before, found, after = page.partition(heading)
    if not found:
        raise ValueError(f"no table under {heading!r}")
    table, gap, rest = after.partition("\n\n")
    if whole:
        lines = [f"| {' | '.join([name, *cells])} |" for name, cells in rows.items()]
        return before + found + "\n".join([*table.splitlines()[:2], *lines]) + gap + rest
    for maze, cells in rows.items():
        line = re.search(rf"^\| `?{re.escape(maze)}`? \|.*$", table, re.M)
        if line is None:
            raise ValueError(f"the table under {heading!r} has no row of {maze}")
        old = line[0].strip("| ").split(" | ")
        new = " | ".join([*old[:first], *cells, *old[first + len(cells) :]])
        table = table.replace(line[0], f"| {new} |")
    return before + found + table + gap + rest


def spread(summary: Mapping[str, Any], name: str, digits: int = 2) -> str:
    """Mean ± standard deviation of the runs that got there."""
    mean, std = summary[f"mean_{name}"], summary[f"std_{name}"]
    return "–" if mean is None else f"{mean:.{digits}f} ± {std:.{digits}f}"


def explored(how: dict[str, Any], maze: str, **options: Any) -> dict[str, Any]:
    """The summary of one sweep."""
    parts = Parts.named(**options)
    return exploration(MAZES[maze], explore_many(MAZES[maze], agent=parts, **how), agent=parts)["summary"]


def explore(how: dict[str, Any]) -> None:
    """Steps to explore: README and docs/exploring.md."""
    found = {maze: explored(how, maze) for maze in MAZES}
    change("README.md", "| maze | oracle | paper | authors | cogmap |", column(found, "steps_to_complete"), first=4)
    names = ("steps_to_visit_all", "steps_to_learn", "steps_to_complete")
    rows = {
        maze: [
            f"{one['completed']}/{one['runs']}",
            *(spread(one, name) for name in names),
            f"{one['mean_oracle_steps']:.2f}",
            f"{one['ratio']:.3f}",
        ]
        for maze, one in found.items()
    }
    change("docs/exploring.md", "| maze | done | every room visited |", rows)


def growth(how: dict[str, Any]) -> None:
    """The three ways to grow: docs/exploring.md."""
    rows = {
        maze: [
            f"{spread(one, 'steps_to_complete', 1)} ({one['completed']}/{one['runs']})"
            for one in (explored(how, maze, growth=name) for name in ("static", "observed", "predicted"))
        ]
        for maze in MAZES
    }
    change("docs/exploring.md", "| maze | static | observed | predicted |", rows)


def preset(how: dict[str, Any]) -> None:
    """The paper's own agent: docs/paper.md."""
    found = {maze: [explored(how, maze, preset=name) for name in ("cogmap", "paper")] for maze in MAZES}
    rows = {
        maze: [f"{own['mean_steps_to_complete']:.2f}", spread(paper, "steps_to_complete", 1)]
        for maze, (own, paper) in found.items()
    }
    change("docs/paper.md", "| maze | default | preset `paper` |", rows)


def kidnap(how: dict[str, Any]) -> None:
    """Moved without a word: docs/changing.md."""
    rows: dict[str, list[str]] = {}
    for maze, chart in MAZES.items():
        one = kidnap_result(chart, kidnap_many(chart, **how))["summary"]
        means = (one["mean_steps_to_recover"], one["mean_steps_certain_but_wrong"])
        shares = [f"{one[name]}/{one['runs']}" for name in ("recovered", "map_intact")]
        rows[maze] = [shares[0], *(f"{mean:.1f}" for mean in means), shares[1]]
    change("docs/changing.md", "| maze | recovered |", rows)


def navigate(how: dict[str, Any]) -> None:
    """Going to a goal, with a map and without: docs/changing.md."""
    rows: dict[str, list[str]] = {}
    for maze, goal in GOALS.items():
        one, other = (led(how, maze, goal=goal, known=known) for known in (True, False))
        rows[maze] = [
            f"{one['reached']}/{one['runs']}, {one['ratio']:.3f}",
            f"{other['reached']}/{other['runs']}, {other['mean_steps']:.1f}",
            f"{other['mean_frontier_steps']:.1f}",
        ]
    change("docs/changing.md", "| maze | goal |", rows, first=2)


def led(how: dict[str, Any], maze: str, **task: Any) -> dict[str, Any]:
    """The summary of one sweep to a goal."""
    return navigate_result(MAZES[maze], navigate_many(MAZES[maze], **task, **how), **task)["summary"]


def column(found: Mapping[str, Mapping[str, Any]], name: str) -> Rows:
    """One cell a maze: the mean."""
    return {maze: [f"{one[f'mean_{name}']:.2f}"] for maze, one in found.items()}


def change(name: str, heading: str, rows: Rows, *, first: int = 1, whole: bool = False) -> None:
    """Write the rows into a page, and say which."""
    page = ROOT / name
    page.write_text(written(page.read_text("utf-8"), heading, rows, first=first, whole=whole), "utf-8")
    print(f"{name}: {heading}")
    for maze, cells in rows.items():
        print(f"  {maze:13} {' | '.join(cells)}")


PARTS: dict[str, Callable[[dict[str, Any]], None]] = {
    "explore": explore,
    "growth": growth,
    "preset": preset,
    "kidnap": kidnap,
    "navigate": navigate,
}
ALL = (*PARTS, *STUDIES)


def main() -> None:
    """The tables and figures that are asked for, or all, and how long each took."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("parts", nargs="*", choices=[[], *ALL, "mice"], help="which; the tables of sweeps unless given")
    parser.add_argument("--all", action="store_true", help="every table and figure but mice")
    parser.add_argument(
        "--runs", type=int, help="runs a maze, or agents of a study; as the documents have them unless given"
    )
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument("--keep", type=Path, help="folder that keeps finished runs; a temporary one unless given")
    asked = parser.parse_args()
    seconds: dict[str, float] = {}
    with workers(jobs=asked.jobs) as executor, TemporaryDirectory() as folder:
        for part in ALL if asked.all else asked.parts or PARTS:
            begin = perf_counter()
            print(f"\n== {part}", flush=True)
            if part in PARTS:
                PARTS[part]({"runs": asked.runs or 20, "executor": executor})
            else:
                run = STUDIES.get(part) or spoken(part)
                run({"few": asked.runs, "executor": executor, "keep": asked.keep or Path(folder)}, change)
            seconds[part] = perf_counter() - begin
    print("\nminutes:", *(f"{part} {taken / 60:.1f}" for part, taken in seconds.items()))


if __name__ == "__main__":
    main()
