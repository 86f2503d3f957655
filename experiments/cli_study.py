"""`cogmap study`: a study of the paper, its rows as JSON and its figures in a folder."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .cli_explore import Jobs, Seed

Name = Annotated[
    str,
    typer.Argument(
        metavar="NAME", help="Which study: localisation, goals, donut, tolman, martinet or insight.", show_default=False
    ),
]
Agents = Annotated[
    int | None,
    typer.Option("--runs", "--agents", min=1, help="How many agents take part; the study's own number unless given."),
]
Out = Annotated[
    Path | None, typer.Option(metavar="DIR", help="Folder to write in; study-NAME in this folder unless given.")
]
LookAhead = Annotated[
    int | None, typer.Option(min=1, help="L: steps that a policy looks ahead; the study's own unless given.")
]


def study_command(
    name: Name,
    runs: Agents = None,
    seed: Seed = 0,
    out: Out = None,
    look_ahead: LookAhead = None,
    jobs: Jobs = 1,
) -> None:
    """Run a study of the paper; its rows are written as JSON, its figures as PNG and SVG."""
    from .cli_progress import counting, progress
    from .cli_table import show_lines
    from .studies.frame import check_folder, save_study, study_named, study_report

    study = study_named(name)
    agents, folder = runs or study.agents, out or Path(f"study-{name}")
    settings = study.settings(look_ahead)
    check_folder(folder, name)
    with counting(f"studying {name}, agents", agents) as one_more:
        result = study.run(agents=agents, seed=seed, look_ahead=look_ahead, jobs=jobs, on_done=one_more)
    show_lines(name, study.lines(result))
    report = study_report(study, result, agents=agents, seed=seed, settings=settings)
    with progress("drawing", 1):
        written = save_study(folder, study, result, report)
    show_lines(None, [f"written: {path}" for path in written])
