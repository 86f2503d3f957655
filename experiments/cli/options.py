"""Options that several commands have."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

World = Annotated[str, typer.Argument(metavar="WORLD", help="A built-in name, or a maze or graph file.")]
Agent = Annotated[
    str,
    typer.Option(metavar="NAME", help="cogmap, frontier, random, cscg, cscg_pose, cscg_random or cscg_pose_random."),
]
Runs = Annotated[
    int | None, typer.Option(min=1, help="Walk so often, run i with seed S + i; without it, once and in detail.")
]
Seed = Annotated[int, typer.Option(min=0, help="S: of the start room and of the agent.")]
LookAhead = Annotated[int, typer.Option(min=1, help="Steps that policies look ahead (cogmap only).")]
Policies = Annotated[
    str, typer.Option(metavar="NAME", help="map_guided, self_avoiding, l_shaped or exhaustive (cogmap only).")
]
MaxStepsTwice = Annotated[
    int | None,
    typer.Option(min=1, help="Give up exploring after so many, and again what follows; 50 a room + 50 unless given."),
]
Jobs = Annotated[int, typer.Option(min=1, help="Processes of a sweep.")]
Dask = Annotated[
    str | None,
    typer.Option(
        metavar="ADDRESS", help="Run a sweep on the Dask cluster whose scheduler is there, like tcp://host:8786."
    ),
]
Json = Annotated[Path | None, typer.Option(metavar="FILE", help="Write the runs as JSON.")]
Trace = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="Record the walk (of a sweep, its first) for `cogmap replay`; .gz packs it."),
]
