"""`cogmap worlds`: the built-in mazes."""

from pathlib import Path
from typing import Annotated, Any

import typer
from rich.box import HEAVY_HEAD

from ..text import number, show_table

Json = Annotated[Path | None, typer.Option("--json", help="Write the table as JSON.")]


def worlds_command(json: Json = None) -> None:
    """List the built-in worlds."""
    from ...worlds import MAZES
    from .. import check_outputs, write_json

    check_outputs([json])
    rows = [_row(name) for name in MAZES]
    cells = [
        (
            row["world"],
            row["rooms"],
            row["sights"],
            "yes" if row["aliased"] else "no",
            number(row["mean_oracle_steps"], digits=2),
        )
        for row in rows
    ]
    headings = ("world", ">rooms", ">different sights", "aliased", ">oracle steps (mean)")
    show_table(headings, cells, box=HEAVY_HEAD)
    if json is not None:
        write_json(json, rows)


def _row(name: str) -> dict[str, Any]:
    from ...worlds import MAZES
    from .. import mean, oracle_steps

    maze = MAZES[name]
    steps, sights = [oracle_steps(maze, start) for start in maze.rooms], len(set(maze.sights.values()))
    row = {"world": name, "rooms": len(maze.rooms), "sights": sights, "aliased": sights < len(maze.rooms)}
    return {**row, "mean_oracle_steps": None if None in steps else mean(steps)}
