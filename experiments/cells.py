"""One exploration as a cell of a table: a maze, an agent, a seed; many of them, and only those not made before."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field
from functools import partial
from hashlib import sha256
from importlib.metadata import version
from itertools import chain
from typing import Any

from ..agent import Settings
from ..baselines import CscgSettings
from ..model import GROWTHS, CogmapError
from ..worlds import Maze
from .exploring import ExploreRun, explore
from .ledger import Ledger
from .parts import Parts
from .pool import WorkerLostError, completed
from .records import Record
from .session import checked_steps

Key = tuple[str, str, str, str, int]
"""World, layout, agent, growth, seed."""


@dataclass(frozen=True, slots=True)
class Cell:
    """One exploration that is to be made.

    Attributes:
        maze: its layout.
        agent: one of `AGENTS`.
        seed: of the start room and of the agent.
        growth: of the agent `cogmap`; without meaning for the others.
    """

    maze: Maze
    agent: str
    seed: int
    growth: str = "predicted"

    @property
    def key(self) -> Key:
        """What tells it from other cells."""
        return self.maze.name, layout_digest(self.maze), self.agent, self.growth, self.seed


@dataclass(frozen=True, slots=True)
class Row(Record):
    """One exploration that was made, as ledgers keep it. Rows are equal whatever seconds they took.

    Attributes:
        world: name of the maze.
        layout: digest of rooms and sights, since two mazes may have one name.
        agent: name of the agent.
        growth: of the agent `cogmap`.
        run: its figures.
    """

    world: str
    layout: str = field(repr=False)
    agent: str
    growth: str
    run: ExploreRun

    @property
    def key(self) -> Key:
        """That of its cell."""
        return self.world, self.layout, self.agent, self.growth, self.run.seed


def run_cells(
    cells: Sequence[Cell],
    *,
    settings: Settings | None = None,
    cscg: CscgSettings | None = None,
    max_steps: int | None = None,
    ledger: Ledger | None = None,
    executor: Executor | None = None,
) -> Iterator[Row]:
    """A row of each cell: first those that the ledger has, then the others as they finish, each kept at once.

    Args:
        cells: what to explore; all different.
        settings: of the agent `cogmap`, but for its growth.
        cscg: settings of the clone-structured graphs.
        max_steps: moves after which a run gives up; by the size of its maze unless given.
        ledger: keeps the rows.
        executor: where the runs are made, in this process if None. But for the order and the seconds the rows do
            not depend on it.

    Raises:
        CogmapError: a cell is bad or given twice, the ledger is of other settings, or a worker was killed.
    """
    parts = Parts(settings=settings or Settings(), cscg=cscg or CscgSettings())
    left = _checked(cells, max_steps)
    rows = [] if ledger is None else ledger.begin(Row.from_dict, **_made_with(parts, max_steps))
    kept = [row for row in rows if left.pop(row.key, None) is not None]
    one = partial(run_cell, settings=settings, cscg=cscg, max_steps=max_steps)
    new = (row for _, row in completed(one, list(left.values()), executor=executor))
    return chain(kept, new if ledger is None else _keeping(new, ledger))


def run_cell(
    cell: Cell,
    *,
    settings: Settings | None = None,
    cscg: CscgSettings | None = None,
    max_steps: int | None = None,
) -> Row:
    """Make one exploration; see `run_cells`.

    Raises:
        CogmapError: no such agent or growth, a negative seed, or `max_steps` below 1.
    """
    parts = Parts(cell.agent, settings or Settings(), cscg or CscgSettings()).growing(cell.growth)
    run = explore(cell.maze, cell.seed, agent=parts, max_steps=max_steps)
    return Row(cell.maze.name, layout_digest(cell.maze), cell.agent, cell.growth, run)


def layout_digest(maze: Maze) -> str:
    """Twelve hexadecimal digits that stand for the rooms and their sights."""
    text = "\n".join(f"{row} {column} {maze.sights[row, column]!r}" for row, column in maze.rooms)
    return sha256(text.encode()).hexdigest()[:12]


def _keeping(rows: Iterator[Row], ledger: Ledger) -> Iterator[Row]:
    try:
        for row in rows:
            ledger.append(row.to_dict())
            yield row
    except WorkerLostError as error:
        raise WorkerLostError(
            f"{error}; finished runs are kept in {ledger.path}, run the same again to go on"
        ) from error


def _checked(cells: Sequence[Cell], max_steps: int | None) -> dict[Key, Cell]:
    checked: dict[Key, Cell] = {}
    for cell in cells:
        Parts(cell.agent)  # refuses an unknown name
        checked_steps("cells", cell.maze, max_steps)
        if cell.growth not in GROWTHS:
            raise CogmapError(f"cells: no growth is called {cell.growth!r}; choose one of {', '.join(GROWTHS)}")
        if cell.seed < 0:
            raise CogmapError(f"cells: seed is {cell.seed}; use 0 or more")
        if cell.key in checked:
            raise CogmapError(f"cells: {cell.maze.name}, {cell.agent}, seed {cell.seed} is given twice; leave one out")
        checked[cell.key] = cell
    return checked


def _made_with(parts: Parts, max_steps: int | None) -> dict[str, Any]:
    own = parts.settings.to_dict()
    del own["growth"]  # each row has its own
    return {"cogmap": version("cogmap"), "settings": own, "cscg": parts.cscg.to_dict(), "max_steps": max_steps}
