"""The figure of the study `exploration`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .exploration_rows import ExplorationResult
from .grid_rows import LEARN, TITLES
from .published import PAPER_LEARN
from .steps_figure import LOOKS, Series, steps_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def exploration_figures(result: ExplorationResult) -> dict[str, Figure]:
    """`exploration_steps`: steps to learn by maze and model."""
    cells, worlds = result.cells, result.cells.grid.worlds
    series = [
        Series(
            TITLES[agent],
            LOOKS[agent],
            [cells.steps(LEARN, world, agent) for world in worlds],
            [_paper(world, agent) for world in worlds],
        )
        for agent in cells.columns
    ]
    title = "Steps to learn every transition (mean, 95 % bootstrap interval)"
    figure = steps_figure(title, "steps", worlds, series, cap=cells.cap, published="the paper's mean")
    return {"exploration_steps": figure}


def _paper(world: str, agent: str) -> float | None:
    figure = PAPER_LEARN.get(world, {}).get(agent)
    return None if figure is None else figure.mean
