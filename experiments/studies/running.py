"""Studies run and written: one of them, or every one and the page that leads to their reports."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

from .report import Report
from .saving import check_folder, facts, made_with, make_folder, write_report, write_study, write_tables
from .study import EVERYTHING, AnyStudy, studies
from .tables import Table

INDEX = "index"

Counter = Callable[[str, int], AbstractContextManager[Callable[[], None]]]
"""Takes what is done and its parts; the context has a function to call after each part."""


@dataclass(frozen=True, slots=True)
class Asked:
    """What was asked for.

    Attributes:
        runs: agents that take part in a study; the study's own number if None.
        seed: of the first agent.
        look_ahead: steps that a policy looks ahead; the study's own if None.
    """

    runs: int | None = None
    seed: int = 0
    look_ahead: int | None = None

    def command(self, study: str) -> str:
        """That runs it again."""
        runs = "" if self.runs is None else f" --runs {self.runs}"
        look_ahead = "" if self.look_ahead is None else f" --look-ahead {self.look_ahead}"
        return f"cogmap study {study}{runs} --seed {self.seed}{look_ahead}"


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a study went.

    Attributes:
        study: which.
        agents: how many took part.
        seconds: that it took, figures and report included.
        lines: what the terminal shows.
        written: its files, the report last.
        failed: what its report lists as failed.
        failure: why it was not done, in one line; None if it was.
    """

    study: AnyStudy
    agents: int
    seconds: float
    lines: Sequence[str] = ()
    written: Sequence[Path] = ()
    failed: Sequence[str] = ()
    failure: str | None = None


def check_study(study: AnyStudy, folder: Path, asked: Asked, *, ledger: Path | None = None) -> None:
    """Refuse, before anything is computed, what `run_study` could not do.

    Raises:
        CogmapError: a bad look-ahead, a folder that cannot be written, or a ledger that was made with other settings.
    """
    settings = study.looking(asked.look_ahead)
    check_folder(folder, study.name)
    with study.ledger(ledger or folder, settings):
        pass


def run_study(
    study: AnyStudy,
    folder: Path | str,
    asked: Asked = Asked(),
    *,
    executor: Executor | None = None,
    ledger: Path | None = None,
    counter: Counter = lambda what, parts: nullcontext(lambda: None),
) -> Outcome:
    """Run a study and write all that it leaves.

    Args:
        study: of this package, or your own.
        folder: where its files go; is made if need be.
        asked: how many agents, with which seeds.
        executor: where its tasks are done, in this process if None.
        ledger: the folder of the ledger of a study that keeps one, `folder` if None.
        counter: shows what is done.

    Raises:
        CogmapError: a number is out of range, a worker was killed, or a file cannot be written.
        KeyboardInterrupt: with the place of the finished runs, if they are kept.
    """
    folder, begin, settings = Path(folder), perf_counter(), study.looking(asked.look_ahead)
    agents = study.agents if asked.runs is None else asked.runs
    tasks = study.tasks(range(asked.seed, asked.seed + agents), settings)
    with study.ledger(ledger or folder, settings) as kept:
        try:
            with counter(f"studying {study.name}", len(tasks)) as on_done:
                rows = study.rows(
                    agents=agents, seed=asked.seed, settings=settings, executor=executor, ledger=kept, on_done=on_done
                )
        except KeyboardInterrupt as stop:
            where = () if kept is None else (f"the finished runs are kept in {kept.path}",)
            raise KeyboardInterrupt(*where) from stop
    with counter("drawing", 1):
        make_folder(folder)
        found = study.summarise(rows)
        changed = None if settings == study.settings else asked.look_ahead
        command = Asked(agents, asked.seed, changed).command(study.name)
        head = {"study": study.name, "agents": agents, "seed": asked.seed, "command": command}
        written = write_study(folder, study, found, {**head, "settings": settings.to_dict(), **made_with()})
    return Outcome(study, agents, perf_counter() - begin, found.lines, written, found.failed)


def run_studies(
    folder: Path,
    asked: Asked,
    *,
    executor: Executor | None = None,
    counter: Counter,
    on_outcome: Callable[[Outcome], None],
) -> tuple[list[Outcome], list[Path]]:
    """Run every study, each in a folder below this one, and write the page that leads to them.

    A study that goes wrong, whatever it was, is an outcome; the others are still run. They share one ledger.

    Raises:
        CogmapError: a file of the page cannot be written.
    """
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
    """Write `index.md`, `index.html` and their table, which lead to the reports; answers with the files.

    Raises:
        CogmapError: a file cannot be written.
    """
    done = [outcome for outcome in outcomes if outcome.failure is None]
    rows = [
        (one.study.name, one.agents, round(one.seconds, 1), "failed" if one.failure else "done", len(one.failed))
        for one in outcomes
    ]
    heads = ("study", "agents", "seconds", "outcome", "failures listed")
    table = Table(INDEX, heads, rows, "How they went; what did not get there is listed in the reports")
    failed = [
        f"{one.study.name}: {one.failure or f'{len(one.failed)} listed in its report'}"
        for one in outcomes
        if one.failure or one.failed
    ]
    report = Report(
        title="Every study",
        question=f"{len(done)} of {len(outcomes)} studies were run to their end. Each has a report of its own.",
        links=[(f"{one.study.name}/{one.study.name}.md", f"{one.study.title} ({one.study.name})") for one in done],
        tables=[table],
        failed=failed,
        command=asked.command(EVERYTHING),
        facts=facts({"seed": asked.seed, **made_with()}),
    )
    make_folder(folder)
    write_tables(folder, [table])
    return write_report(folder / INDEX, report)
