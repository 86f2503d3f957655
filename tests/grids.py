"""Small grids of explorations for the studies that share them, and rows that nobody walked."""

from __future__ import annotations

from cogmap.experiments import ExploreRun, Row
from cogmap.experiments.studies.grid import Grid
from cogmap.experiments.studies.grid_rows import Cells

CAP = 30
"""Moves in which our agent knows a maze of nine rooms and a clone-structured graph does not."""


def row(agent: str, seed: int, steps: int | None, *, world: str = "3x3", growth: str = "predicted") -> Row:
    """A row in which everything took `steps` and the oracle 8."""
    run = ExploreRun(seed, (0, 0), steps, steps, steps, 8, 0.5)
    return Row(world, "layout", agent, growth, run)


def cells(steps: dict[str, list[int | None]], *, cap: int = CAP, world: str = "3x3") -> Cells:
    """Explorations of one maze with these steps by agent, seeds from 0."""
    rows = [row(agent, seed, one, world=world) for agent, every in steps.items() for seed, one in enumerate(every)]
    return Cells(Grid((world,), tuple(steps)), cap, tuple(rows))
