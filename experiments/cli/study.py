"""`cogmap study`: a study of the paper, or all; rows, tables, figures and a report in a folder."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..text import say
from . import options as opt
from .progress import counting

if TYPE_CHECKING:
    from ..studies import Outcome

Name = Annotated[
    str,
    typer.Argument(
        metavar="NAME",
        help="exploration, rooms, growth, cost, distances, identity, localisation, "
        "goals, donut, tolman, martinet, insight, mice, minigrid, buildings, cue; or all.",
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
Maps = Annotated[
    Path | None, typer.Option(metavar="DIR", help="Of buildings: a folder of graph files; random graphs unless given.")
]
LookAhead = Annotated[
    int | None, typer.Option(min=1, help="L: steps that a policy looks ahead; the study's own unless given.")
]
SOME_FAILED = 1


def study_command(
    name: Name,
    runs: Agents = None,
    seed: opt.Seed = 0,
    out: Out = None,
    look_ahead: LookAhead = None,
    maps: Maps = None,
    jobs: opt.Jobs = 1,
    dask: opt.Dask = None,
) -> None:
    """Run a study of the paper; rows (JSON), tables (CSV), figures and a report (Markdown, HTML) are written.

    exploration, rooms, growth and identity keep every finished run in DIR: the same command goes on from there.
    """
    from ...model import CogmapError
    from .. import workers
    from ..studies import EVERYTHING, Buildings, Options, run_studies, run_study, study_named
    from .group import INTERRUPTED, fail

    study = None if name == EVERYTHING else study_named(name)
    if maps is not None:
        if not isinstance(study, Buildings):
            raise CogmapError(f"--maps is for the study buildings, not {name}; leave it out")
        study = Buildings(str(maps))
    folder, how = out or Path(f"study-{name}"), Options(runs=runs, seed=seed, look_ahead=look_ahead, counter=counting)
    try:
        with workers(jobs=jobs, dask=dask) as how["executor"]:
            if study is not None:
                _show(run_study(study, folder, **how))
                return
            outcomes, written = run_studies(folder, on_outcome=_show, **how)
    except KeyboardInterrupt as stop:
        if not stop.args:
            raise
        again = "the same command goes on from there"
        fail(f"interrupted; the finished runs are kept in {stop.args[0]}; {again}", code=INTERRUPTED)
    say(*(f"written: {path}" for path in written))
    if any(outcome.failure for outcome in outcomes):
        raise typer.Exit(SOME_FAILED)


def _show(outcome: Outcome) -> None:
    if outcome.failure:
        say(f"{outcome.study.name} failed: {outcome.failure}", style="bold red")
    else:
        say(*outcome.lines, *(f"written: {path}" for path in outcome.written), title=outcome.study.name)
