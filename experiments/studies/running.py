"""Studies run and written: one of them, or every one and the page that leads to their reports."""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import Any, TypedDict, Unpack

from ...model import make_folder, write_whole
from .. import Parts, check_outputs
from .buildings import Buildings
from .saving import made_with, write_report, write_study
from .study import EVERYTHING, AnyStudy, studies
from .tables import Table, Value

INDEX = "index"

Counter = Callable[[str, int], AbstractContextManager[Callable[[], None]]]
"""Takes what is done and its parts; the context has a function to call after each part."""
SILENT: Counter = lambda what, parts: nullcontext(lambda: None)  # noqa: E731


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


class Options(TypedDict, total=False):
    """How studies are run."""

    runs: int | None  # agents that take part; the study's own number unless given
    seed: int  # of the first agent, 0 unless given
    look_ahead: int | None  # steps that a policy looks ahead; the study's own unless given
    executor: Executor | None  # where tasks are done; in this process unless given
    ledger: Path  # folder of the ledger of a study that keeps one; that of its files unless given
    counter: Counter  # shows what is done


def run_study(study: AnyStudy, folder: Path | str, **options: Unpack[Options]) -> Outcome:
    """Run a study, of this package or your own, and write all that it leaves into a folder, made if need be.

    Raises:
        CogmapError: a number is out of range, a worker was killed, or a file cannot be written.
        KeyboardInterrupt: with the file of the finished runs, if they are kept.
    """
    begin, folder, counter = perf_counter(), Path(folder), options.get("counter", SILENT)
    runs, seed, look_ahead = options.get("runs"), options.get("seed", 0), options.get("look_ahead")
    agents, settings = study.agents if runs is None else runs, study.looking(look_ahead)
    _check(folder, study.name)
    how: dict[str, Any] = {"seed": seed, "settings": settings, "executor": options.get("executor")}
    parts = len(study.tasks(range(agents), settings))
    with study.ledger(options.get("ledger", folder), settings) as kept:
        try:
            with counter(f"studying {study.name}", parts) as on_done:
                rows = study.rows(agents, ledger=kept, on_done=on_done, **how)
        except KeyboardInterrupt as stop:
            raise KeyboardInterrupt(*([] if kept is None else [kept.path])) from stop
    with counter("drawing", 1):
        found = study.summarise(rows)
        again = _command(study, agents, seed, None if settings == study.settings else look_ahead)
        head = {"study": study.name, "agents": agents, "seed": seed, "command": again}
        written = write_study(
            folder, study, found, {**head, "settings": Parts(settings=settings).to_dict(), **made_with()}
        )
    return Outcome(study, agents, perf_counter() - begin, found.lines, written, found.failed)


def run_studies(
    folder: Path, *, on_outcome: Callable[[Outcome], None] = lambda outcome: None, **options: Unpack[Options]
) -> tuple[list[Outcome], list[Path]]:
    """Run every study, each in a folder below this one, and write the page that leads to them.

    A study that goes wrong is an outcome, whatever it was; the others are still run. They share one ledger.

    Raises:
        CogmapError: nothing could be written, the ledger is of other settings, or a bad look-ahead.
    """
    runs, seed, look_ahead = options.get("runs"), options.get("seed", 0), options.get("look_ahead")
    _check(folder, INDEX)
    for study in studies().values():
        with study.ledger(folder, study.looking(look_ahead)):
            pass
    outcomes: list[Outcome] = []
    for study in studies().values():
        begin = perf_counter()
        try:
            done = run_study(study, folder / study.name, **{"ledger": folder, **options})
        except Exception as error:  # Ctrl-C is none
            line = " ".join(f"{type(error).__name__}: {error}".split())
            done = Outcome(study, runs or study.agents, perf_counter() - begin, failure=line)
        outcomes.append(done)
        on_outcome(done)
    return outcomes, write_index(folder, outcomes, seed, _command(None, runs, seed, look_ahead))


def write_index(folder: Path, outcomes: Sequence[Outcome], seed: int, command: str) -> list[Path]:
    """Write `index.md`, `index.html` and their table, which lead to the reports; answers with the pages."""
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
    values = {"command": command, "seed": seed, **made_with()}
    parts = {"question": whole, "links": links, "tables": [table], "failed": failed}
    return write_report(folder / INDEX, "Every study", values, **parts)


def _command(study: AnyStudy | None, runs: int | None, seed: int, look_ahead: int | None) -> str:
    options = {"runs": runs, "seed": seed, "look_ahead": look_ahead}
    given: dict[str, Any] = {name: value for name, value in options.items() if value is not None}
    if study is not None and study.name not in studies():
        return f"run_study({type(study).__name__}(), folder, {', '.join(f'{name}={given[name]}' for name in given)})"
    if isinstance(study, Buildings) and study.folder is not None:
        given["maps"] = study.folder
    words = [f"--{name.replace('_', '-')} {value}" for name, value in given.items()]
    return " ".join(["cogmap study", EVERYTHING if study is None else study.name, *words])


def _check(folder: Path, name: str) -> None:
    make_folder(folder)
    check_outputs([folder / f"{name}{suffix}" for suffix in (".json", ".md", ".html")])
