"""`cogmap study`: a study of the paper, or all; rows, tables, figures and a report in a folder."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..text import say
from .options import Dask, Jobs, Seed
from .progress import counting

if TYPE_CHECKING:
    from ..ledger import Ledger
    from ..studies.everything import Asked, Outcome
    from ..studies.frame import Study

Name = Annotated[
    str,
    typer.Argument(
        metavar="NAME",
        help="exploration, rooms, growth, cost, localisation, goals, donut, tolman, martinet or insight; or all.",
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
    from ..studies.everything import Asked
    from ..studies.frame import EVERYTHING, STUDIES, study_named
    from ..studies.saving import check_folder

    folder, asked = out or Path(f"study-{name}"), Asked(runs, seed, look_ahead)
    if name == EVERYTHING:
        check_folder(folder, "index")
        for study in STUDIES.values():
            study.settings(look_ahead)
            check_folder(folder / study.name, study.name)
        _all(folder, asked, jobs, dask)
        return
    study = study_named(name)
    study.settings(look_ahead)
    check_folder(folder, name)
    _one(study, folder, asked, jobs, dask)


def _one(study: Study, folder: Path, asked: Asked, jobs: int, dask: str | None) -> None:
    from ..pool import workers
    from ..studies.everything import run_study

    with workers(jobs=jobs, dask=dask) as executor, _kept(study, folder, asked) as ledger:
        outcome = run_study(study, folder, asked, counter=counting, executor=executor, ledger=ledger)
    _show(outcome)


def _all(folder: Path, asked: Asked, jobs: int, dask: str | None) -> None:
    from ..pool import workers
    from ..studies.everything import try_study, write_index
    from ..studies.frame import STUDIES

    outcomes: list[Outcome] = []
    keeper = next((study for study in STUDIES.values() if study.keeps_cells), None)
    with workers(jobs=jobs, dask=dask) as executor, _kept(keeper, folder, asked) as ledger:
        for study in STUDIES.values():
            below = folder / study.name
            outcomes.append(try_study(study, below, asked, counter=counting, executor=executor, ledger=ledger))
            _show(outcomes[-1])
    say(*(f"written: {path}" for path in write_index(folder, outcomes, asked)))
    if any(outcome.failure for outcome in outcomes):
        raise typer.Exit(SOME_FAILED)


def _show(outcome: Outcome) -> None:

    if outcome.failure is None:
        say(*outcome.lines, *(f"written: {path}" for path in outcome.written), title=outcome.study.name)
    else:
        say(f"{outcome.study.name} failed: {outcome.failure}", style="bold red")


@contextmanager
def _kept(study: Study | None, folder: Path, asked: Asked) -> Generator[Ledger | None]:
    """The ledger in the folder, if the study keeps one; on Ctrl-C it is said where the finished runs are."""
    from ..studies.grid import ledger_in
    from .group import INTERRUPTED, fail

    if study is None or not study.keeps_cells:
        yield None
        return
    with ledger_in(folder, study.settings(asked.look_ahead)) as ledger:
        try:
            yield ledger
        except KeyboardInterrupt:
            again = "the same command goes on from there"
            fail(f"interrupted; the finished runs are kept in {ledger.path}; {again}", code=INTERRUPTED)
