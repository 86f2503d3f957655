"""Explorations of several mazes by several agents: what the studies `exploration`, `rooms` and `growth` look at.

They share their cells: one that a ledger holds already is not run again, whichever study asked for it first.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path

from ...agent import Settings
from ...model.errors import CogmapError
from ...worlds import MAZES
from ..cells import Cell, Key, Row, run_cells
from ..ledger import Ledger
from ..walkers import CSCG
from .grid_rows import PREDICTED, Cells
from .saving import make_folder

LEDGER = "cells.jsonl"
"""In the folder of a study, or of those that share their cells."""
CAP = 600
"""Moves after which every agent of these studies gives up."""
TABLE = tuple(name for name in MAZES if name != "tolman")
"""The mazes of the paper's table."""
MODELS = ("cogmap", *CSCG)
"""The models of the paper's table, but for the oracle."""


@dataclass(frozen=True, slots=True)
class Grid:
    """Which mazes are explored by whom.

    Attributes:
        worlds: names of the mazes.
        agents: names of the agents.
        growths: of the agent `cogmap`.
    """

    worlds: tuple[str, ...]
    agents: tuple[str, ...]
    growths: tuple[str, ...] = (PREDICTED,)

    def cells(self, runs: int, seed: int = 0) -> list[Cell]:
        """Every maze by every agent, `runs` times with the seeds `seed`, `seed` + 1, ..."""
        return [
            Cell(MAZES[world], agent, number, growth)
            for world in self.worlds
            for agent in self.agents
            for growth in self.growths
            for number in range(seed, seed + runs)
        ]

    def run(
        self,
        name: str,
        *,
        runs: int,
        seed: int,
        settings: Settings | None,
        executor: Executor | None,
        ledger: Ledger | None,
        on_done: Callable[[], None] | None,
        max_steps: int | None = None,
    ) -> Cells:
        """Run what the ledger does not hold yet; `on_done` is called after each cell.

        Raises:
            CogmapError: `runs` below 1, a negative seed, or what `run_cells` raises.
        """
        if runs < 1:
            raise CogmapError(f"{name}: agents is {runs}; use 1 or more")
        if seed < 0:
            raise CogmapError(f"{name}: seed is {seed}; use 0 or more")
        cells, cap = self.cells(runs, seed), CAP if max_steps is None else max_steps
        rows: dict[Key, Row] = {}
        for row in run_cells(cells, settings=settings, max_steps=cap, ledger=ledger, executor=executor):
            rows[row.key] = row
            if on_done is not None:
                on_done()
        return Cells(self, cap, tuple(rows[cell.key] for cell in cells))


def ledger_in(folder: Path, settings: Settings) -> Ledger:
    """The ledger that these studies keep in a folder, which is made if need be.

    Raises:
        CogmapError: it cannot be written, is in use, or was made with other settings.
    """
    make_folder(folder)
    ledger = Ledger(folder / LEDGER)
    try:
        for _ in run_cells((), settings=settings, max_steps=CAP, ledger=ledger):
            pass  # compares the settings, and runs nothing
    except BaseException:
        ledger.close()
        raise
    return ledger
