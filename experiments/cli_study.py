"""`cogmap study`: a study of the paper, or all, or one of your own; rows, tables, figures and a report in a folder."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .cli_explore import Dask, Jobs, Seed

if TYPE_CHECKING:
    from .studies import Outcome

Name = Annotated[
    str,
    typer.Argument(
        metavar="NAME",
        help="cost, donut, exploration, goals, growth, insight, localisation, martinet, rooms or tolman; or all; or "
        "FILE.py, a study of your own.",
        show_default=False,
    ),
]
Agents = Annotated[
    int | None,
    typer.Option(
        "--runs",
        "--agents",
        min=1,
        help="How many agents (of each kind) take part; the study's own number unless given.",
    ),
]
Out = Annotated[
    Path | None, typer.Option(metavar="DIR", help="Folder to write in; study-NAME in this folder unless given.")
]
LookAhead = Annotated[
    int | None, typer.Option(min=1, help="L: steps that a policy looks ahead; the study's own unless given.")
]
SOME_FAILED = 1


def study_command(
    name: Name,
    runs: Agents = None,
    seed: Seed = 0,
    out: Out = None,
    look_ahead: LookAhead = None,
    jobs: Jobs = 1,
    dask: Dask = None,
) -> None:
    """Run a study of the paper; rows (JSON), tables (CSV), figures and a report (Markdown, HTML) are written.

    exploration, rooms and growth keep every finished run in DIR/cells.jsonl: the same command goes on from there.
    """
    from .cli_group import INTERRUPTED, fail
    from .cli_progress import counting
    from .cli_table import show_lines
    from .executors import workers
    from .studies import EVERYTHING, Asked, run_studies, run_study, study_named

    folder, asked = out or Path(f"study-{Path(name).stem}"), Asked(runs, seed, look_ahead)
    study = None if name == EVERYTHING else study_named(name)
    try:
        with workers(jobs=jobs, dask=dask) as executor:
            if study is not None:
                _show(run_study(study, folder, asked, executor=executor, counter=counting))
                return
            outcomes, written = run_studies(folder, asked, executor=executor, counter=counting, on_outcome=_show)
    except KeyboardInterrupt as stop:
        if not stop.args:
            raise
        fail(f"interrupted; {stop}; the same command goes on from there", code=INTERRUPTED)
    show_lines(None, [f"written: {path}" for path in written])
    if any(outcome.failure for outcome in outcomes):
        raise typer.Exit(SOME_FAILED)


def _show(outcome: Outcome) -> None:
    from .cli_table import console, show_lines

    if outcome.failure is None:
        show_lines(outcome.study.name, [*outcome.lines, *(f"written: {path}" for path in outcome.written)])
    else:
        text = f"{outcome.study.name} failed: {outcome.failure}"
        console().print(text, style="bold red", markup=False, highlight=False, soft_wrap=True)
