"""What a study is: what it asks, what is run, and what the rows come to."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, replace
from functools import cache, partial
from importlib import import_module
from inspect import getdoc
from pathlib import Path
from pkgutil import iter_modules
from typing import Any, ClassVar, Generic, TypeVar

from ...agent import Settings
from ...model import CogmapError, make_folder
from .. import Ledger, completed
from .figures import Figure
from .tables import Table

EVERYTHING = "all"  # stands for every study, one after the other

Task = TypeVar("Task")
Row = TypeVar("Row")


@dataclass(frozen=True, slots=True)
class Findings:
    """What a study comes to."""

    json: Mapping[str, Any]  # what its JSON file holds besides the head: protocol, rows, summary
    lines: Sequence[str]  # what the terminal shows
    figures: Mapping[str, Callable[[], Figure]]  # by the stem of their file, drawn when they are asked for
    tables: Sequence[Table] | None = None  # the main rows first; None: read off `json`, the report shows `lines` too
    failed: Sequence[str] = ()  # what did not get there, one line each


class Study(ABC, Generic[Task, Row]):
    """A study. A subclass says in its docstring what it asks: the title of its report, a blank line, the question.

    How often its protocol does something are its fields; below 1 they are refused (CogmapError).
    """

    name: ClassVar[str]  # of the study and of its files
    notes: ClassVar[tuple[str, ...]] = ()  # where its figures differ from the published and why; what to keep in mind
    agents: ClassVar[int] = 20  # how many take part unless told otherwise
    settings: ClassVar[Settings] = Settings()  # of the agents unless told otherwise
    alone: ClassVar[bool] = False  # its tasks are done in this process, one after the other, whatever the executor

    def __post_init__(self) -> None:
        at_least(self.name, 1, **{name: value for name, value in vars(self).items() if type(value) is int})

    @abstractmethod
    def run(self, task: Task, settings: Settings) -> Row:
        """Do one task, wherever the executor is; what is random in it comes from its seed alone."""

    @abstractmethod
    def summarise(self, rows: Sequence[Row]) -> Findings:
        """What the rows come to, in the order of the tasks."""

    def tasks(self, seeds: Sequence[int], settings: Settings) -> Sequence[Task]:
        """What is to be done for the agents with these seeds; unless a study knows better, a task is a seed."""
        return seeds  # type: ignore[return-value]

    def ledger(self, folder: Path, settings: Settings) -> AbstractContextManager[Ledger | None]:
        """What keeps finished runs in a folder, so that the same command goes on; None: nothing does."""
        return nullcontext()

    def completed(
        self, tasks: Sequence[Task], settings: Settings, executor: Executor | None, ledger: Ledger | None
    ) -> Iterator[tuple[int, Row]]:
        """Number of the task and its row, as they finish."""
        return completed(partial(self.run, settings=settings), tasks, executor=executor)

    def rows(
        self,
        agents: int | None = None,
        *,
        seed: int = 0,
        settings: Settings | None = None,
        executor: Executor | None = None,
        ledger: Ledger | None = None,
        on_done: Callable[[], None] = lambda: None,
    ) -> list[Row]:
        """Do all tasks, in the executor or, without one, here; the rows do not depend on it.

        Args:
            agents: how many take part; agent i has the seed `seed` + i.
            seed: of the first.
            settings: of the agents.
            executor: any of `concurrent.futures`.
            ledger: see `ledger`.
            on_done: called after each task.

        Raises:
            CogmapError: `agents` below 1, a negative seed, or a worker was killed.
        """
        agents, settings = self.agents if agents is None else agents, settings or self.settings
        at_least(self.name, 1, agents=agents)
        at_least(self.name, 0, seed=seed)
        tasks, rows = self.tasks(range(seed, seed + agents), settings), dict[int, Row]()
        for number, row in self.completed(tasks, settings, None if self.alone else executor, ledger):
            rows[number] = row
            on_done()
        return [rows[number] for number in range(len(tasks))]

    def looking(self, look_ahead: int | None) -> Settings:
        """The settings, with another look-ahead if one is given; below 1 it is refused (CogmapError)."""
        return self.settings if look_ahead is None else replace(self.settings, look_ahead=look_ahead)

    @property
    def asks(self) -> tuple[str, str]:
        """Title and question."""
        title, _, question = (getdoc(type(self)) or self.name).partition("\n\n")
        return title, " ".join(question.split())


AnyStudy = Study[Any, Any]


class Kept(Study[Task, Row]):
    """A study that keeps every finished run in a file of its folder, and goes on from there."""

    file: ClassVar[str]  # its name

    @abstractmethod
    def key(self, task: Task) -> Any:
        """What tells a task from others; that of its row."""

    @abstractmethod
    def made(
        self, tasks: Sequence[Task], settings: Settings, executor: Executor | None, ledger: Ledger | None
    ) -> Iterator[Any]:
        """The row of each task, in any order; those that the ledger has are not made again."""

    def completed(
        self, tasks: Sequence[Task], settings: Settings, executor: Executor | None, ledger: Ledger | None
    ) -> Iterator[tuple[int, Row]]:
        number = {self.key(task): i for i, task in enumerate(tasks)}
        for row in self.made(tasks, settings, executor, ledger):
            yield number[row.key], row

    @contextmanager
    def ledger(self, folder: Path, settings: Settings) -> Generator[Ledger | None]:
        """The ledger in the folder; refused if it cannot be written, is in use, or of other settings (CogmapError)."""
        make_folder(folder)
        with Ledger(folder / self.file) as ledger:
            for _ in self.made((), settings, None, ledger):
                pass  # compares the settings, and runs nothing
            yield ledger


@cache
def studies() -> dict[str, AnyStudy]:
    """The studies of this package by name, in order: every class with a name of its own in a file beside this one."""
    found: dict[str, AnyStudy] = {}
    for file in iter_modules([str(Path(__file__).parent)]):
        for kind in vars(import_module(f".{file.name}", __package__)).values():
            if isinstance(kind, type) and issubclass(kind, Study) and "name" in vars(kind):
                found[kind.name] = kind()
    return dict(sorted(found.items()))


def study_named(name: str) -> AnyStudy:
    """The study of that name. Raises CogmapError: there is none."""
    if name not in studies():
        raise CogmapError(f"no study is called {name!r}; choose one of {', '.join(studies())}, or {EVERYTHING}")
    return studies()[name]


def at_least(who: str, least: int, **counts: int) -> None:
    """Refuse counts below `least` (CogmapError)."""
    for name, count in counts.items():
        if count < least:
            raise CogmapError(f"{who}: {name} is {count}; use {least} or more")


def failed_seeds(what: str, rows: Sequence[Any], failed: Callable[[Any], bool]) -> list[str]:
    """Of how many rows it is so, and their seeds, as a line of `Findings.failed`; none of no rows."""
    seeds = [str(row.seed) for row in rows if failed(row)]
    return [f"{len(seeds)} of {len(rows)} {what} (seeds {', '.join(seeds)})"] if seeds else []
