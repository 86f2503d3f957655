"""Sweeps as a table in a terminal."""

from __future__ import annotations

from collections.abc import Sequence
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
    table.add_column("growth" if first["settings"] else "agent", no_wrap=True)
    for name in ("done", "visit all", "learn", "complete", "oracle", "ratio"):
        table.add_column(name, justify="right", no_wrap=True)
    for result in results:
        table.add_row(*_line(result))
    to = console()
    title = f"[bold]{escape(first['world'])}[/bold], agent {first['agent']}: steps, mean ± standard deviation"
    to.print(title, highlight=False)
    to.print(table)
    for result in results:
        lost = [str(run["seed"]) for run in result["runs"] if run["steps_to_complete"] is None]
        if lost:
            text = ", ".join(lost[:20]) + (" ..." if len(lost) > 20 else "")
            to.print(f"{_name(result)}: not complete with seeds {text}", style="red", markup=False, highlight=False)


def _line(result: dict[str, Any]) -> list[str]:
    summary = result["summary"]
    return [
        _name(result),
        f"{summary['completed']}/{summary['runs']}",
        *(_spread(summary, name) for name in ("steps_to_visit_all", "steps_to_learn", "steps_to_complete")),
        _number(summary["mean_oracle_steps"]),
        _number(summary["ratio"], digits=3),
    ]


def _name(result: dict[str, Any]) -> str:
    return result["settings"].get("growth", result["agent"])


def _spread(summary: dict[str, Any], name: str) -> str:
    mean, std = summary[f"mean_{name}"], summary[f"std_{name}"]
    return "-" if mean is None else f"{mean:.1f} ± {std:.1f}"


def _number(value: float | None, *, digits: int = 1) -> str:
    return "-" if value is None else f"{value:.{digits}f}"
