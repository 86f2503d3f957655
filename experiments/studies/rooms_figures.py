"""The figure of the study `rooms`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .grid_rows import TITLES, VISIT
from .published import AUTHORS_ROOMS
from .rooms_rows import RoomsResult
from .steps_figure import LOOKS, Series, steps_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def rooms_figures(result: RoomsResult) -> dict[str, Figure]:
    """`rooms_steps`: steps until every room was entered once, by maze and model."""
    cells, worlds = result.cells, result.cells.grid.worlds
    series = [
        Series(
            TITLES[agent],
            LOOKS[agent],
            [cells.steps(VISIT, world, agent) for world in worlds],
            [AUTHORS_ROOMS.get(world) if agent == "cogmap" else None for world in worlds],
        )
        for agent in cells.columns
    ]
    title = "Steps until every room was entered once (mean, 95 % bootstrap interval)"
    figure = steps_figure(title, "steps", worlds, series, cap=cells.cap, published="the authors' agent, mean")
    return {"rooms_steps": figure}
