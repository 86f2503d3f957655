"""What a study is: what it asks, what is run, and what the rows come to."""

from __future__ import annotations

import sys
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from functools import cache, partial
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar

from ...agent import Settings
from ...model import CogmapError
from .. import Ledger, map_tasks
from .tables import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

EVERYTHING = "all"
"""Stands for every study, one after the other."""

Task = TypeVar("Task")
Row = TypeVar("Row")


@dataclass(frozen=True, slots=True)
class Findings:
    """What a study comes to.

    Attributes:
        json: what its JSON file holds besides the head: protocol, rows, summary; records count as objects.
        lines: what the terminal shows.
        figures: by the stem of their file, drawn when they are asked for.
        tables: the main rows first; None: read off `json`, and the report shows `lines` as well.
        failed: what did not get there, one line each.
    """

    json: Mapping[str, Any]
    lines: Sequence[str]
    figures: Mapping[str, Callable[[], Figure]]
    tables: Sequence[Table] | None = None
    failed: Sequence[str] = ()


class Study(ABC, Generic[Task, Row]):
    """A study; a subclass says what it is, and how often something is done in it is a field of it.

    Attributes:
        name: of the study and of its files.
        title: of its report.
        question: what it asks, and how it goes about it.
        notes: where its figures differ from the published ones and why, and what to keep in mind.
        agents: how many take part unless told otherwise.
        settings: of the agents unless told otherwise.
    """

    name: ClassVar[str]
    title: ClassVar[str]
    question: ClassVar[str]
    notes: ClassVar[tuple[str, ...]] = ()
    agents: ClassVar[int] = 20
    settings: ClassVar[Settings] = Settings()

    def tasks(self, seeds: Sequence[int], settings: Settings) -> Sequence[Task]:
        """What is to be done for the agents with these seeds: a task for each seed, unless a study knows better."""
        return seeds  # type: ignore[return-value]

    @abstractmethod
    def run(self, task: Task, settings: Settings) -> Row:
        """Do one task, wherever the executor is; what is random in it comes from its seed alone."""

    @abstractmethod
    def summarise(self, rows: Sequence[Row]) -> Findings:
        """What the rows come to, in the order of the tasks."""

    def rows(
        self,
        *,
        agents: int | None = None,
        seed: int = 0,
        settings: Settings | None = None,
        executor: Executor | None = None,
        ledger: Ledger | None = None,
        on_done: Callable[[], None] | None = None,
    ) -> list[Row]:
        """Do all tasks.

        Args:
            agents: how many take part; agent i has the seed `seed` + i.
            seed: of the first.
            settings: of the agents.
            executor: where the tasks are done, in this process if None; the rows do not depend on it.
            ledger: of a study that keeps one, see `ledger`.
            on_done: called after each of the `len(tasks(...))` tasks.

        Raises:
            CogmapError: `agents` below 1, a negative seed, or a worker was killed.
        """
        agents = self.agents if agents is None else agents
        at_least(self.name, 1, agents=agents)
        at_least(self.name, 0, seed=seed)
        settings = settings or self.settings
        tasks = self.tasks(range(seed, seed + agents), settings)
        return self.work(tasks, settings, executor=executor, ledger=ledger, on_done=on_done)

    def work(
        self,
        tasks: Sequence[Task],
        settings: Settings,
        *,
        executor: Executor | None,
        ledger: Ledger | None,
        on_done: Callable[[], None] | None,
    ) -> list[Row]:
        """The rows of these tasks; see `rows`."""
        return map_tasks(partial(self.run, settings=settings), tasks, executor=executor, on_done=on_done)

    def ledger(self, folder: Path, settings: Settings) -> AbstractContextManager[Ledger | None]:
        """The ledger in which finished runs are kept, in a folder that is there; None: it keeps none."""
        return nullcontext()

    def looking(self, look_ahead: int | None) -> Settings:
        """The settings of the protocol, with another look-ahead if one is given.

        Raises:
            CogmapError: `look_ahead` is below 1.
        """
        return self.settings if look_ahead is None else replace(self.settings, look_ahead=look_ahead)


AnyStudy = Study[Any, Any]


@cache
def studies() -> dict[str, AnyStudy]:
    """The studies of this package by name: each is a file beside this one that has a `STUDY`."""
    found: list[AnyStudy] = []
    for module in iter_modules([str(Path(__file__).parent)]):
        study = getattr(import_module(f".{module.name}", __package__), "STUDY", None)
        found += [study] if isinstance(study, Study) else []
    return {study.name: study for study in found}


def study_named(name: str) -> AnyStudy:
    """The study of that name; or, of a name that ends in `.py`, the `STUDY` in that file.

    Raises:
        CogmapError: there is none.
    """
    if name.endswith(".py"):
        return _study_in(Path(name))
    if name not in studies():
        choice = f"{', '.join(studies())}, or {EVERYTHING}, or give a file FILE.py"
        raise CogmapError(f"no study is called {name!r}; choose one of {choice}")
    return studies()[name]


def at_least(who: str, least: int, **counts: int) -> None:
    """Refuse counts below `least`.

    Raises:
        CogmapError: one is.
    """
    for name, count in counts.items():
        if count < least:
            raise CogmapError(f"{who}: {name} is {count}; use {least} or more")


def failed_seeds(what: str, rows: Sequence[Any], failed: Callable[[Any], bool]) -> list[str]:
    """Of how many rows it is so, and their seeds, as a line of `Findings.failed`; none of no rows."""
    seeds = [str(row.seed) for row in rows if failed(row)]
    return [f"{len(seeds)} of {len(rows)} {what} (seeds {', '.join(seeds)})"] if seeds else []


def short(what: str, count: int, of: int, unit: str = "") -> list[str]:
    """That fewer than all got there, as a line of `Findings.failed`; none if all did."""
    return [f"{what} {count} of {of} {unit}".rstrip()] if count < of else []


def _study_in(path: Path) -> AnyStudy:
    if not path.is_file():
        raise CogmapError(f"there is no file {path}; give the file of a study")
    sys.path.insert(0, str(path.resolve().parent))  # where other processes look for it, too
    study = getattr(import_module(path.stem), "STUDY", None)
    if not isinstance(study, Study):
        raise CogmapError(f"{path} has no STUDY; let it end with STUDY = a study of yours")
    return study
