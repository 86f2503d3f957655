"""The figure of the study `growth`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .grid_rows import ORACLE
from .growth import GrowthResult
from .steps_figure import LOOKS, Series, steps_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def growth_figures(result: GrowthResult) -> dict[str, Figure]:
    """`growth_steps`: steps to complete by maze and way to grow."""
    cells, grid = result.cells, result.cells.grid
    oracle = [cells.steps(ORACLE, world, "cogmap", grid.growths[0]) for world in grid.worlds]
    series = [Series("Oracle", LOOKS["oracle"], oracle)]
    series += [
        Series(growth, LOOKS[growth], [result.steps(world, growth) for world in grid.worlds]) for growth in grid.growths
    ]
    title = "Steps until every room was visited and every transition learned (mean, 95 % bootstrap interval)"
    return {"growth_steps": steps_figure(title, "steps", grid.worlds, series, cap=cells.cap)}
