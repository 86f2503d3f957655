"""The study `growth`: three ways to grow a map, after the paper's figure on internal map layouts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Unpack

from ...worlds import MAZES
from .grid import Grid, Options, run_grid
from .grid_rows import COMPLETE, Cells
from .report import Table
from .steps import LEGEND, Steps

GROWN = ("static", "observed", "predicted")
GRID = Grid(tuple(MAZES), ("cogmap",), GROWN)


@dataclass(frozen=True, slots=True)
class GrowthResult:
    """All runs of the study."""

    cells: Cells

    def steps(self, world: str, growth: str) -> Steps:
        """Steps until a maze was complete."""
        return self.cells.steps(COMPLETE, world, "cogmap", growth)

    def failed(self) -> tuple[str, ...]:
        """Which maze was never complete."""
        return self.cells.failed(COMPLETE)

    def to_dict(self) -> dict[str, Any]:
        """Protocol, every run, and figures by maze and growth, as plain JSON values."""
        grid = self.cells.grid
        return {
            "protocol": self.cells.protocol(),
            "rows": [row.to_dict() for row in self.cells.rows],
            "summary": [
                {"world": world, "growth": growth, **self.steps(world, growth).to_dict()}
                for world in grid.worlds
                for growth in grid.growths
            ],
        }


def growth_study(**options: Unpack[Options]) -> GrowthResult:
    """Let agents that grow their map in each way explore the eight mazes.

    Raises:
        CogmapError: `agents` below 1, a negative seed, or a process was killed.
    """
    return GrowthResult(run_grid("growth", GRID, **options))


def growth_tasks(agents: int) -> int:
    """How many runs the study makes."""
    return len(GRID.cells(agents))


def growth_lines(result: GrowthResult) -> list[str]:
    """What the terminal shows."""
    grid, lines = result.cells.grid, [f"steps to complete, mean ± standard deviation (complete of runs); {LEGEND}"]
    for world in grid.worlds:
        lines.append(world)
        lines += [f"  {growth:<11}{result.steps(world, growth).text()}" for growth in grid.growths]
    return lines


def growth_tables(result: GrowthResult) -> list[Table]:
    """Every run; means by maze and growth; the figures for machines."""
    grid = result.cells.grid
    means = tuple((world, *(result.steps(world, growth).text() for growth in grid.growths)) for world in grid.worlds)
    summary = [
        {"world": world, "growth": growth, **result.steps(world, growth).to_dict()}
        for world in grid.worlds
        for growth in grid.growths
    ]
    return [
        result.cells.table("growth"),
        Table(
            "growth_table",
            ("maze", *grid.growths),
            means,
            f"Steps until every room was visited and every transition learned; mean ± standard deviation (complete of "
            f"runs) [95 % interval]. {LEGEND}.",
        ),
        Table(
            "growth_summary",
            tuple(summary[0]),
            tuple(tuple(row.values()) for row in summary),
            "steps_to_complete: figures by maze and growth",
            shown=False,
        ),
    ]
