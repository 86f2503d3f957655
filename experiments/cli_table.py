"""Sweeps as a table in a terminal."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.markup import escape
from rich.table import Table


def console() -> Console:
    """The terminal on stdout, or what stands in for it."""
    return Console()


def show_sweeps(results: Sequence[dict[str, Any]]) -> None:
    """A line for each sweep: how many completed, and after how many steps (mean ± standard deviation)."""
    first = results[0]
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    table.add_column("growth" if "growth" in first["settings"] else "agent", no_wrap=True)
    for name in ("done", "visit all", "learn", "complete", "oracle", "ratio"):
        table.add_column(name, justify="right", no_wrap=True)
    for result in results:
        table.add_row(*_line(result))
    to = console()
    title = f"[bold]{escape(first['world'])}[/bold], agent {first['agent']}: steps, mean ± standard deviation"
    to.print(title, highlight=False)
    to.print(table)
    for result in results:
        if lost := seeds_of(result["runs"], lambda run: run["steps_to_complete"] is None):
            to.print(f"{_name(result)}: not complete with seeds {lost}", style="red", markup=False, highlight=False)


def show_lines(title: str | None, lines: Sequence[str]) -> None:
    """A title and a few lines of plain text."""
    to = console()
    if title is not None:
        to.print(title, style="bold", markup=False, highlight=False)
    for line in lines:
        to.print(line, markup=False, highlight=False, soft_wrap=True)


def seeds_of(runs: Sequence[dict[str, Any]], condition: Callable[[dict[str, Any]], bool], *, most: int = 20) -> str:
    """The seeds of the runs of which the condition holds, as text."""
    seeds = [str(run["seed"]) for run in runs if condition(run)]
    return ", ".join(seeds[:most]) + (" ..." if len(seeds) > most else "")


def spread(summary: dict[str, Any], name: str) -> str:
    """Mean ± standard deviation of a figure in a summary."""
    mean, std = summary[f"mean_{name}"], summary[f"std_{name}"]
    return "-" if mean is None else f"{mean:.1f} ± {std:.1f}"


def number(value: float | None, *, digits: int = 1) -> str:
    """A number, or a dash for none."""
    return "-" if value is None else f"{value:.{digits}f}"


def _line(result: dict[str, Any]) -> list[str]:
    summary = result["summary"]
    return [
        _name(result),
        f"{summary['completed']}/{summary['runs']}",
        *(spread(summary, name) for name in ("steps_to_visit_all", "steps_to_learn", "steps_to_complete")),
        number(summary["mean_oracle_steps"]),
        number(summary["ratio"], digits=3),
    ]


def _name(result: dict[str, Any]) -> str:
    return result["settings"].get("growth", result["agent"])


def count(number: int, what: str) -> str:
    """`1 step`, `2 steps`."""
    return f"{number} {what}" if number == 1 else f"{number} {what}s"
