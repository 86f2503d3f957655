"""Text and tables in a terminal."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.box import SIMPLE_HEAD, Box
from rich.console import Console
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from ..statistics import number, spread


def say(*lines: object, title: str | None = None, style: str | None = None) -> None:
    """A title and a few lines of plain text."""
    to = Console()
    if title is not None:
        to.print(title, style="bold", markup=False, highlight=False)
    for line in lines:
        to.print(str(line), style=style, markup=False, highlight=False, soft_wrap=True)


def say_saved(**files: Path | None) -> None:
    """Where what was asked for is kept, by what it is."""
    say(*(f"{what} saved: {path}" for what, path in files.items() if path is not None))


def show_table(
    title: str | None,
    headings: Sequence[str],
    rows: Sequence[Sequence[object]],
    *,
    more: int = 0,
    box: Box = SIMPLE_HEAD,
    pad_edge: bool = False,
    no_wrap: bool = False,
) -> None:
    """A table; a heading that begins with > is set right. `more` rows were left out."""
    table = Table(box=box, pad_edge=pad_edge)
    for heading in headings:
        right = heading.startswith(">")
        table.add_column(heading.removeprefix(">"), justify="right" if right else "left", no_wrap=no_wrap)
    for row in rows:
        table.add_row(*(escape(str(cell)) for cell in row))
    say(title=title)
    Console().print(table)
    if more > 0:
        Console().print(f"… {more} more; show them with --limit {len(rows) + more}", style="dim", highlight=False)


def show_facts(facts: Mapping[str, str | Text]) -> None:
    """A line a fact, its name before it."""
    table = Table(show_header=False, box=None, pad_edge=False)
    table.add_column(style="dim")
    table.add_column(overflow="fold")
    for name, text in facts.items():
        table.add_row(name, escape(text) if isinstance(text, str) else text)
    Console().print(table)


def show_sweeps(results: Sequence[dict[str, Any]]) -> None:
    """A line for each sweep: how many completed, and after how many steps (mean ± standard deviation)."""
    first = results[0]
    grown = "growth" in first["settings"]
    names = [result["settings"].get("growth", result["agent"]) for result in results]
    title = f"[bold]{escape(first['world'])}[/bold], agent {first['agent']}: steps, mean ± standard deviation"
    Console().print(title, highlight=False)
    headings = ("growth" if grown else "agent", ">done", ">visit all", ">learn", ">complete", ">oracle", ">ratio")
    cells = [(name, *_cells(result["summary"])) for name, result in zip(names, results, strict=True)]
    show_table(None, headings, cells, no_wrap=True)
    for name, result in zip(names, results, strict=True):
        if lost := seeds_of(result["runs"], lambda run: run["steps_to_complete"] is None):
            say(f"{name}: not complete with seeds {lost}", style="red")


def seeds_of(runs: Sequence[dict[str, Any]], condition: Callable[[dict[str, Any]], bool], *, most: int = 20) -> str:
    """The seeds of the runs of which the condition holds, as text."""
    seeds = [str(run["seed"]) for run in runs if condition(run)]
    return ", ".join(seeds[:most]) + (" ..." if len(seeds) > most else "")


def _cells(summary: dict[str, Any]) -> list[str]:
    return [
        f"{summary['completed']}/{summary['runs']}",
        *(spread(summary, name) for name in ("steps_to_visit_all", "steps_to_learn", "steps_to_complete")),
        number(summary["mean_oracle_steps"]),
        number(summary["ratio"], digits=3),
    ]
