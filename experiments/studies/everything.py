"""Every study, one after the other, and the page that leads to their reports."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

from ...model.files import write_whole
from .about import about
from .frame import EVERYTHING, Study
from .json_tables import flat
from .machine import machine, versions
from .report import Report, Table
from .saving import save_study, study_report, write_report

if TYPE_CHECKING:
    from ..ledger import Ledger

INDEX = "index"

Counter = Callable[[str, int], AbstractContextManager[Callable[[], None]]]
"""Takes what is done and its parts; the context has a function to call after each part."""


@dataclass(frozen=True, slots=True)
class Asked:
    """What was asked for.

    Attributes:
        runs: agents that take part in each study; the study's own number if None.
        seed: of the first agent.
        look_ahead: steps that a policy looks ahead; the study's own if None.
    """

    runs: int | None = None
    seed: int = 0
    look_ahead: int | None = None

    @property
    def command(self) -> str:
        """That runs every study again."""
        runs = "" if self.runs is None else f" --runs {self.runs}"
        look_ahead = "" if self.look_ahead is None else f" --look-ahead {self.look_ahead}"
        return f"cogmap study {EVERYTHING}{runs} --seed {self.seed}{look_ahead}"


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a study went.

    Attributes:
        study: which.
        agents: how many took part.
        seconds: that it took, figures and report included.
        lines: what the terminal shows.
        written: its files, the report last.
        failure: why it was not done, in one line; None if it was.
        gave_up: what its report lists as failed.
    """

    study: Study
    agents: int
    seconds: float
    lines: tuple[str, ...] = ()
    written: tuple[Path, ...] = ()
    failure: str | None = None
    gave_up: int = 0


def run_study(
    study: Study,
    folder: Path,
    asked: Asked,
    *,
    counter: Counter,
    executor: Executor | None = None,
    ledger: Ledger | None = None,
) -> Outcome:
    """Run a study and write all that it leaves.

    Raises:
        CogmapError: a number is out of range, a process was killed, or a file cannot be written.
    """
    agents, begin = asked.runs or study.agents, perf_counter()
    with counter(f"studying {study.name}", study.parts(agents)) as one_more:
        result = study.run(
            agents=agents,
            seed=asked.seed,
            look_ahead=asked.look_ahead,
            executor=executor,
            ledger=ledger,
            on_done=one_more,
        )
    report = study_report(study, result, agents=agents, seed=asked.seed, settings=study.settings(asked.look_ahead))
    with counter("drawing", 1):
        written = save_study(folder, study, result, report)
    seconds, gave_up = perf_counter() - begin, len(study.failed(result))
    return Outcome(study, agents, seconds, tuple(study.lines(result)), tuple(written), gave_up=gave_up)


def try_study(
    study: Study,
    folder: Path,
    asked: Asked,
    *,
    counter: Counter,
    executor: Executor | None = None,
    ledger: Ledger | None = None,
) -> Outcome:
    """`run_study`, where whatever goes wrong is an outcome, so that the other studies are still run."""
    begin = perf_counter()
    try:
        return run_study(study, folder, asked, counter=counter, executor=executor, ledger=ledger)
    except Exception as error:  # Ctrl-C is none
        line = " ".join(f"{type(error).__name__}: {error}".split())
        return Outcome(study, asked.runs or study.agents, perf_counter() - begin, failure=line)


def write_index(folder: Path, outcomes: Sequence[Outcome], asked: Asked) -> list[Path]:
    """Write `index.md`, `index.html` and their table, which lead to the reports; answers with the files.

    Raises:
        CogmapError: a file cannot be written.
    """
    done = [outcome for outcome in outcomes if outcome.failure is None]
    rows = tuple(
        (
            outcome.study.name,
            outcome.agents,
            round(outcome.seconds, 1),
            "failed" if outcome.failure else "done",
            outcome.gave_up,
        )
        for outcome in outcomes
    )
    heads = ("study", "agents", "seconds", "outcome", "failures listed")
    table = Table(INDEX, heads, rows, "How they went; what did not get there is listed in the reports")
    document = Report(
        title="Every study",
        asked=f"{len(done)} of {len(outcomes)} studies were run to their end. Each has a report of its own.",
        links=tuple(
            (f"{name}/{name}.md", f"{about(name).title} ({name})") for name in (outcome.study.name for outcome in done)
        ),
        tables=(table,),
        failed=tuple(f"{outcome.study.name}: {outcome.failure}" for outcome in outcomes if outcome.failure),
        command=asked.command,
        facts=tuple(flat({"seed": asked.seed, "machine": machine(), "versions": versions()}).items()),
    )
    write_whole(folder / f"{INDEX}.csv", table.csv().encode())
    return write_report(folder / INDEX, document)
