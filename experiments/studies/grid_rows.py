"""Explorations of a grid, by maze and model."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ...baselines import CscgSettings
from ..cells import Row
from ..parts import CSCG
from .json_tables import flat
from .report import Table
from .steps import Steps

if TYPE_CHECKING:
    from .grid import Grid

PREDICTED = "predicted"
TITLES = {
    "oracle": "Oracle",
    "cogmap": "cogmap",
    "frontier": "frontier",
    "random": "random",
    "cscg": "CSCG",
    "cscg_pose": "CSCG pose",
    "cscg_random": "CSCG random",
    "cscg_pose_random": "CSCG pose random",
}
"""Names of the models as the paper has them."""

LEARN, VISIT, COMPLETE, ORACLE = "steps_to_learn", "steps_to_visit_all", "steps_to_complete", "oracle_steps"


@dataclass(frozen=True, slots=True)
class Cells:
    """All explorations of a grid.

    Attributes:
        grid: which they are.
        cap: moves after which a run gave up.
        rows: in the order of the grid, seeds ascending.
    """

    grid: Grid
    cap: int
    rows: tuple[Row, ...]

    @property
    def columns(self) -> tuple[str, ...]:
        """Of a table: the oracle and the agents."""
        return ("oracle", *self.grid.agents)

    def steps(self, what: str, world: str, agent: str, growth: str = PREDICTED) -> Steps:
        """What the runs of one agent in one maze come to; the oracle walks from the starts of the first agent."""
        if agent == "oracle":
            what, agent = ORACLE, self.grid.agents[0]
        runs = [row.run for row in self.rows if (row.world, row.agent, row.growth) == (world, agent, growth)]
        return Steps.of([getattr(run, what) for run in runs], self.cap)

    def best(self, what: str, world: str, agents: Iterable[str]) -> tuple[str, Steps] | None:
        """The agent with the smallest mean, those that gave up counted at the cap; None of no agents."""
        found = [(agent, self.steps(what, world, agent)) for agent in agents if agent in self.grid.agents]
        return min(found, key=lambda item: item[1].bound.value, default=None)

    def failed(self, what: str) -> tuple[str, ...]:
        """Who gave up where, with which seeds."""
        lines: list[str] = []
        for world, agent, growth in dict.fromkeys((row.world, row.agent, row.growth) for row in self.rows):
            group = [row.run for row in self.rows if (row.world, row.agent, row.growth) == (world, agent, growth)]
            seeds = [str(run.seed) for run in group if getattr(run, what) is None]
            if seeds:
                name = TITLES[agent] if growth == PREDICTED else f"{TITLES[agent]} ({growth})"
                which = f"seed{'s' if len(seeds) > 1 else ''} {', '.join(seeds)}"
                lines.append(f"{world}, {name}: {len(seeds)} of {len(group)} gave up after {self.cap} moves ({which})")
        return tuple(lines)

    def table(self, name: str) -> Table:
        """One line a cell."""
        rows = [flat(row.to_dict()) for row in self.rows]
        columns = tuple(dict.fromkeys(key for row in rows for key in row))
        values = tuple(tuple(row.get(column) for column in columns) for row in rows)
        return Table(name, columns, values, "every run", shown=False)

    def protocol(self) -> dict[str, Any]:
        """What is run, as plain JSON values."""
        return {
            "worlds": list(self.grid.worlds),
            "agents": list(self.grid.agents),
            "growths": list(self.grid.growths),
            "max_steps": self.cap,
            "cscg_settings": CscgSettings().to_dict() if set(self.grid.agents) & set(CSCG) else None,
        }


def summary_table(name: str, cells: Cells, what: str, agents: Sequence[str]) -> Table:
    """Figures by maze and model, for machines."""
    rows = [
        {"world": world, "agent": agent, **cells.steps(what, world, agent).to_dict()}
        for world in cells.grid.worlds
        for agent in agents
    ]
    values = tuple(tuple(row.values()) for row in rows)
    return Table(name, tuple(rows[0]), values, f"{what}: figures by maze and model", shown=False)
