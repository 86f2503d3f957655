"""Studies run and written: one of them, or every one and the page that leads to their reports."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter

from ...agent import Settings
from ...model import make_folder, write_whole
from .. import check_outputs
from .saving import made_with, write_report, write_study
from .study import EVERYTHING, AnyStudy, studies
from .tables import Table, Value

INDEX = "index"

Counter = Callable[[str, int], AbstractContextManager[Callable[[], None]]]
"""Takes what is done and its parts; the context has a function to call after each part."""
SILENT: Counter = lambda what, parts: nullcontext(lambda: None)  # noqa: E731


@dataclass(frozen=True, slots=True)
class Asked:
    """What was asked for."""

    runs: int | None = None  # agents that take part in a study; the study's own number if None
    seed: int = 0  # of the first agent
    look_ahead: int | None = None  # steps that a policy looks ahead; the study's own if None

    def command(self, study: str) -> str:
        """That runs it again."""
        options = {"runs": self.runs, "seed": self.seed, "look-ahead": self.look_ahead}
        given = [f"--{name} {value}" for name, value in options.items() if value is not None]
        return " ".join(["cogmap study", study, *given])

    def settings(self, study: AnyStudy) -> Settings:
        """Those of the study, with another look-ahead if one is given.

        Raises:
            CogmapError: it is below 1.
        """
        return study.settings if self.look_ahead is None else replace(study.settings, look_ahead=self.look_ahead)


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a study went."""

    study: AnyStudy
    agents: int  # that took part
    seconds: float  # figures and report included
    lines: Sequence[str] = ()  # that the terminal shows
    written: Sequence[Path] = ()  # its files, the report last
    failed: Sequence[str] = ()  # what its report lists as failed
    failure: str = ""  # why it was not done, in one line; empty if it was


def run_study(
    study: AnyStudy,
    folder: Path | str,
    asked: Asked | None = None,
    *,
    executor: Executor | None = None,
    ledger: Path | None = None,
    counter: Counter = SILENT,
) -> Outcome:
    """Run a study and write all that it leaves.

    Args:
        study: of this package, or your own.
        folder: where its files go; is made if need be.
        asked: how many agents, with which seeds; as the study has it unless given.
        executor: where its tasks are done, in this process if None.
        ledger: the folder of the ledger of a study that keeps one, `folder` if None.
        counter: shows what is done.

    Raises:
        CogmapError: a number is out of range, a worker was killed, or a file cannot be written.
        KeyboardInterrupt: with the file of the finished runs, if they are kept.
    """
    asked, folder, begin = asked or Asked(), Path(folder), perf_counter()
    settings, agents = asked.settings(study), study.agents if asked.runs is None else asked.runs
    _check(folder, study.name)
    parts = len(study.tasks(range(agents), settings))
    with study.ledger(ledger or folder, settings) as kept, counter(f"studying {study.name}", parts) as on_done:
        try:
            rows = study.rows(
                agents, seed=asked.seed, settings=settings, executor=executor, ledger=kept, on_done=on_done
            )
        except KeyboardInterrupt as stop:
            raise KeyboardInterrupt(*([] if kept is None else [kept.path])) from stop
    with counter("drawing", 1):
        found = study.summarise(rows)
        command = Asked(agents, asked.seed, None if settings == study.settings else asked.look_ahead)
        head = {"study": study.name, "agents": agents, "seed": asked.seed, "command": command.command(study.name)}
        written = write_study(folder, study, found, {**head, "settings": settings.to_dict(), **made_with()})
    return Outcome(study, agents, perf_counter() - begin, found.lines, written, found.failed)


def run_studies(
    folder: Path,
    asked: Asked,
    *,
    executor: Executor | None = None,
    counter: Counter = SILENT,
    on_outcome: Callable[[Outcome], None] = lambda outcome: None,
) -> tuple[list[Outcome], list[Path]]:
    """Run every study, each in a folder below this one, and write the page that leads to them.

    A study that goes wrong is an outcome, whatever it was; the others are still run. They share one ledger.

    Raises:
        CogmapError: nothing could be written, the ledger is of other settings, or a bad look-ahead.
    """
    _check(folder, INDEX)
    for study in studies().values():
        with study.ledger(folder, asked.settings(study)):
            pass
    outcomes: list[Outcome] = []
    for study in studies().values():
        begin = perf_counter()
        try:
            done = run_study(study, folder / study.name, asked, executor=executor, ledger=folder, counter=counter)
        except Exception as error:  # Ctrl-C is none
            line = " ".join(f"{type(error).__name__}: {error}".split())
            done = Outcome(study, asked.runs or study.agents, perf_counter() - begin, failure=line)
        outcomes.append(done)
        on_outcome(done)
    return outcomes, write_index(folder, outcomes, asked)


def write_index(folder: Path, outcomes: Sequence[Outcome], asked: Asked) -> list[Path]:
    """Write `index.md`, `index.html` and their table, which lead to the reports; answers with the reports.

    Raises:
        CogmapError: a file cannot be written.
    """
    links, failed, rows = list[tuple[str, str]](), list[str](), list[tuple[Value, ...]]()
    for one in outcomes:
        name, state = one.study.name, "failed" if one.failure else "done"
        rows.append((name, one.agents, round(one.seconds, 1), state, len(one.failed)))
        if one.failure or one.failed:
            failed.append(f"{name}: {one.failure or f'{len(one.failed)} listed in its report'}")
        if not one.failure:
            links.append((name, f"{one.study.asks[0]} ({name})"))
    heads = ("study", "agents", "seconds", "outcome", "failures listed")
    table = Table(INDEX, heads, rows, "How they went; what did not get there is listed in the reports")
    write_whole(folder / f"{INDEX}.csv", table.csv().encode())
    whole = f"{len(links)} of {len(outcomes)} studies were run to their end. Each has a report of its own."
    values = {"command": asked.command(EVERYTHING), "seed": asked.seed, **made_with()}
    parts = {"question": whole, "links": links, "tables": [table], "failed": failed}
    return write_report(folder / INDEX, "Every study", values, **parts)


def _check(folder: Path, name: str) -> None:
    make_folder(folder)
    check_outputs([folder / f"{name}{suffix}" for suffix in (".json", ".md", ".html")])
