"""Measures the tables of README.md and docs/ that come from `explore`, `navigate` and `kidnap` anew.

    python benchmarks/tables.py
    python benchmarks/tables.py kidnap navigate --jobs 2

It writes them there. Only rows that begin with a maze are written; what a page says of them in words is to be read
again. `explore`, `growth`, `kidnap` and `navigate` take a minute or two each on one idle core.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
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

ROOT = Path(__file__).resolve().parents[1]
GOALS = {"3x3": 8, "3x3_alias": 2, "4x4": 12, "4x4_alias": 5, "t_maze": 7, "t_maze_alias": 0, "donut": 12, "tolman": 0}
Rows = Mapping[str, Sequence[str]]


def written(page: str, heading: str, rows: Rows, *, first: int = 1) -> str:
    """The page with the cells of its table under `heading` replaced from the `first` on, maze by maze.

    Raises:
        ValueError: there is no such table, or it has no row of a maze.
    """
    before, found, after = page.partition(heading)
    if not found:
        raise ValueError(f"no table under {heading!r}")
    table, gap, rest = after.partition("\n\n")
    for maze, cells in rows.items():
        line = re.search(rf"^\| `{maze}` \|.*$", table, re.M)
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


def explored(how: dict[str, Any], growth: str, maze: str) -> dict[str, Any]:
    """The summary of one sweep."""
    parts = Parts(growth=growth)
    return exploration(MAZES[maze], explore_many(MAZES[maze], agent=parts, **how), agent=parts)["summary"]


def explore(how: dict[str, Any]) -> None:
    """Steps to explore: README and docs/exploring.md."""
    found = {maze: explored(how, "predicted", maze) for maze in MAZES}
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
            for one in (explored(how, name, maze) for name in ("static", "observed", "predicted"))
        ]
        for maze in MAZES
    }
    change("docs/exploring.md", "| maze | static | observed | predicted |", rows)


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


def change(name: str, heading: str, rows: Rows, *, first: int = 1) -> None:
    """Write the rows into a page, and say which."""
    page = ROOT / name
    page.write_text(written(page.read_text("utf-8"), heading, rows, first=first), "utf-8")
    print(f"{name}: {heading}")
    for maze, cells in rows.items():
        print(f"  {maze:13} {' | '.join(cells)}")


PARTS: dict[str, Callable[[dict[str, Any]], None]] = {
    "explore": explore,
    "growth": growth,
    "kidnap": kidnap,
    "navigate": navigate,
}


def main() -> None:
    """The tables that are asked for, or all."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("parts", nargs="*", choices=[[], *PARTS], help="which tables; all unless given")
    parser.add_argument("--runs", type=int, default=20, help="runs a maze")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    asked = parser.parse_args()
    with workers(jobs=asked.jobs) as executor:
        for part in asked.parts or PARTS:
            PARTS[part]({"runs": asked.runs, "executor": executor})


if __name__ == "__main__":
    main()
