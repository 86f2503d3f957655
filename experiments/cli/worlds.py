"""`cogmap worlds`: the built-in mazes."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer


def worlds_command(
    json: Annotated[Path | None, typer.Option("--json", help="Write the table as JSON.")] = None,
) -> None:
    """List the built-in worlds."""
    from rich.box import HEAVY_HEAD

    from ...worlds import MAZES
    from ..output import check_outputs, write_json
    from .tables import show_table

    check_outputs([json])
    rows = [_row(name) for name in MAZES]
    cells = [
        (row["world"], row["rooms"], row["sights"], "yes" if row["aliased"] else "no", _steps(row)) for row in rows
    ]
    headings = ("world", ">rooms", ">different sights", "aliased", ">oracle steps (mean)")
    show_table(None, headings, cells, box=HEAVY_HEAD, pad_edge=True)
    if json is not None:
        write_json(json, rows)


def _row(name: str) -> dict[str, Any]:
    from ...worlds import MAZES
    from ..oracle import oracle_steps
    from ..statistics import mean

    maze = MAZES[name]
    steps, sights = [oracle_steps(maze, start) for start in maze.rooms], len(set(maze.sights.values()))
    return {
        "world": name,
        "rooms": len(maze.rooms),
        "sights": sights,
        "aliased": sights < len(maze.rooms),
        "mean_oracle_steps": None if None in steps else mean(steps),
    }


def _steps(row: dict[str, Any]) -> str:
    from ..statistics import number

    return number(row["mean_oracle_steps"], digits=2)
