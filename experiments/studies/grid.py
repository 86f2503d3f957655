"""Explorations of several mazes by several agents: what the studies `exploration`, `rooms` and `growth` look at.

They share their cells: one that a ledger holds already is not run again, whichever study asked for it first.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import Required, TypedDict, Unpack

from ...agent import Settings
from ...model.errors import CogmapError
from ...worlds import MAZES
from ..cells import Cell, Key, Row, run_cells
from ..ledger import Ledger
from ..parts import CSCG
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


class Options(TypedDict, total=False):
    """How a grid is run.

    Attributes:
        agents: runs of each model in each maze, with the seeds `seed`, `seed` + 1, ...
        seed: of the first; a seed draws start and agent.
        settings: of `cogmap`.
        executor: where the runs are made, here if None; the result does not depend on it, but for seconds.
        ledger: keeps finished runs; what it holds is not run again.
        on_done: called after each cell.
        grid: mazes and models, instead of those of the study.
        max_steps: moves after which a run gives up, `CAP` unless given.
    """

    agents: Required[int]
    seed: int
    settings: Settings | None
    executor: Executor | None
    ledger: Ledger | None
    on_done: Callable[[], None] | None
    grid: Grid | None
    max_steps: int | None


def run_grid(name: str, own: Grid, /, **options: Unpack[Options]) -> Cells:
    """Run what the ledger does not hold yet of the study `name`, whose own grid is `own`.

    Raises:
        CogmapError: `agents` below 1, a negative seed, or what `run_cells` raises.
    """
    grid, runs, seed = options.get("grid") or own, options["agents"], options.get("seed", 0)
    if runs < 1:
        raise CogmapError(f"{name}: agents is {runs}; use 1 or more")
    if seed < 0:
        raise CogmapError(f"{name}: seed is {seed}; use 0 or more")
    cap, on_done = options.get("max_steps"), options.get("on_done")
    cells, cap = grid.cells(runs, seed), CAP if cap is None else cap
    rows: dict[Key, Row] = {}
    for row in run_cells(
        cells,
        settings=options.get("settings"),
        max_steps=cap,
        ledger=options.get("ledger"),
        executor=options.get("executor"),
    ):
        rows[row.key] = row
        if on_done is not None:
            on_done()
    return Cells(grid, cap, tuple(rows[cell.key] for cell in cells))


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
