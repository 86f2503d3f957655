"""One exploration as a cell of a table: a maze, an agent, a seed; many of them, and only those not made before."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field
from functools import partial
from hashlib import sha256
from importlib.metadata import version
from itertools import chain
from operator import attrgetter, methodcaller
from typing import Any, TypedDict, TypeVar, Unpack

from ..agent import Settings
from ..baselines import CscgSettings
from ..model import GROWTHS, CogmapError
from ..worlds import Maze
from .exploring import ExploreRun, explore
from .ledger import Ledger
from .parts import Parts
from .pool import WorkerLostError, completed
from .records import Record
from .session import described, draw_start

Key = tuple[str, str, str, str, int]
"""World, layout, agent, growth, seed."""


@dataclass(frozen=True, slots=True)
class Cell:
    """One exploration to be run."""

    maze: Maze  # its layout
    agent: str  # one of `AGENTS`
    seed: int  # of the start room and of the agent
    growth: str = "predicted"  # of the agent `cogmap`; without meaning for the others

    @property
    def key(self) -> Key:
        """What tells it from other cells."""
        return self.maze.name, layout_digest(self.maze), self.agent, self.growth, self.seed


@dataclass(frozen=True, slots=True)
class Row(Record):
    """One finished exploration, as ledgers keep it. Rows are equal whatever time they took."""

    world: str  # name of the maze
    layout: str = field(repr=False)  # digest of rooms and sights, since two mazes may have one name
    agent: str  # name of the agent
    growth: str  # of the agent `cogmap`
    run: ExploreRun  # its figures

    @property
    def key(self) -> Key:
        """That of its cell."""
        return self.world, self.layout, self.agent, self.growth, self.run.seed


_Task = TypeVar("_Task")
_Kept = TypeVar("_Kept")


class Options(TypedDict, total=False):
    """What rows are made with: settings of `cogmap` but for its growth, of the clone-structured graphs, most moves."""

    settings: Settings | None
    cscg: CscgSettings | None
    max_steps: int | None


def run_cells(
    cells: Sequence[Cell], *, ledger: Ledger | None = None, executor: Executor | None = None, **options: Unpack[Options]
) -> Iterator[Row]:
    """A row of each cell: first those that the ledger has, then the others as they finish, each kept at once.

    Args:
        cells: what to explore; all different.
        ledger: keeps the rows.
        executor: where the runs are made, in this process if None. But for the order and the seconds the rows do
            not depend on it.
        options: see `cells.Options`.

    Raises:
        CogmapError: a cell is bad or given twice, the ledger is of other settings, or a worker was killed.
    """
    made_with = _made_with(options)
    return kept_rows(partial(run_cell, **options), _checked(cells, options), Row.from_dict, ledger, executor, made_with)


def kept_rows(
    run: Callable[[_Task], _Kept],
    tasks: Mapping[Any, _Task],
    read: Callable[[dict[str, Any]], _Kept],
    ledger: Ledger | None,
    executor: Executor | None,
    made_with: Mapping[str, Any],
    *,
    key: Callable[[_Kept], Any] = attrgetter("key"),
    write: Callable[[_Kept], dict[str, Any]] = methodcaller("to_dict"),
) -> Iterator[_Kept]:
    """A row of each task, by its key: first those that the ledger has, then the others, each kept at once.

    A row tells the key of its task, and can be written as plain JSON values.

    Raises:
        CogmapError: the ledger was made with something else, `read` refuses one of its rows, or a worker was killed.
    """
    left = dict(tasks)
    rows = [] if ledger is None else ledger.begin(read, cogmap=version("cogmap"), **made_with)
    kept = [row for row in rows if left.pop(key(row), None) is not None]
    new = (row for _, row in completed(run, list(left.values()), executor=executor))
    return chain(kept, new if ledger is None else _keeping(new, ledger, write))


def run_cell(cell: Cell, **options: Unpack[Options]) -> Row:
    """Make one exploration; see `run_cells`."""
    parts = _parts(options, cell.agent).growing(cell.growth)
    run = explore(cell.maze, cell.seed, agent=parts, max_steps=options.get("max_steps"))
    return Row(cell.maze.name, layout_digest(cell.maze), cell.agent, cell.growth, run)


def layout_digest(maze: Maze) -> str:
    """Twelve hexadecimal digits that stand for the rooms, their sights, and the walls between them."""
    lines = [f"{row} {column} {maze.sights[row, column]!r}" for row, column in maze.rooms]
    return sha256("\n".join([*lines, *map(str, sorted(maze.walls))]).encode()).hexdigest()[:12]


def _keeping(rows: Iterator[_Kept], ledger: Ledger, write: Callable[[_Kept], dict[str, Any]]) -> Iterator[_Kept]:
    try:
        for row in rows:
            ledger.append(write(row))
            yield row
    except WorkerLostError as error:
        kept = f"finished runs are kept in {ledger.path}, run the same again to go on"
        raise WorkerLostError(f"{error}; {kept}") from error


def _checked(cells: Sequence[Cell], options: Options) -> dict[Key, Cell]:
    checked: dict[Key, Cell] = {}
    for cell in cells:
        described("cells", cell.maze, agent=cell.agent, max_steps=options.get("max_steps"))
        draw_start("cells", cell.maze, cell.seed)
        if cell.growth not in GROWTHS:
            raise CogmapError(f"cells: no growth is called {cell.growth!r}; choose one of {', '.join(GROWTHS)}")
        if cell.key in checked:
            raise CogmapError(f"cells: {cell.maze.name}, {cell.agent}, seed {cell.seed} is given twice; leave one out")
        checked[cell.key] = cell
    return checked


def _parts(options: Options, agent: str = "cogmap") -> Parts:
    return Parts(agent, options.get("settings") or Settings(), cscg=options.get("cscg") or CscgSettings())


def _made_with(options: Options) -> dict[str, Any]:
    parts, most = _parts(options), options.get("max_steps")
    own = {name: value for name, value in parts.to_dict().items() if name != "growth"}  # each row has its own
    return {"settings": own, "cscg": parts.cscg.to_dict(), "max_steps": most}
