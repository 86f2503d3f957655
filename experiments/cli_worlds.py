"""`cogmap worlds`: the built-in mazes."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer


def worlds_command(
    json: Annotated[Path | None, typer.Option("--json", help="Write the table as JSON.")] = None,
) -> None:
    """List the built-in worlds."""
    from ..worlds import MAZES
    from .output import check_outputs, write_json

    check_outputs([json])
    rows = [_row(name) for name in MAZES]
    _show(rows)
    if json is not None:
        write_json(json, rows)


def _row(name: str) -> dict[str, Any]:
    from ..worlds import MAZES
    from .oracle import oracle_steps

    maze = MAZES[name]
    steps = [steps for start in maze.rooms if (steps := oracle_steps(maze, start)) is not None]
    sights = len(set(maze.sights.values()))
    return {
        "world": name,
        "rooms": len(maze.rooms),
        "sights": sights,
        "aliased": sights < len(maze.rooms),
        "mean_oracle_steps": sum(steps) / len(steps) if len(steps) == len(maze.rooms) else None,
    }


def _show(rows: list[dict[str, Any]]) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table()
    table.add_column("world")
    for heading in ("rooms", "different sights"):
        table.add_column(heading, justify="right")
    table.add_column("aliased")
    table.add_column("oracle steps (mean)", justify="right")
    for row in rows:
        oracle = "-" if row["mean_oracle_steps"] is None else f"{row['mean_oracle_steps']:.2f}"
        table.add_row(row["world"], str(row["rooms"]), str(row["sights"]), "yes" if row["aliased"] else "no", oracle)
    Console().print(table)
