"""The study `rooms`: the paper's figure of the steps until every room has been entered once."""

from __future__ import annotations

from typing import Unpack

from .grid import MODELS, TABLE, Grid, Options, run_grid
from .grid_rows import TITLES, VISIT, summary_table
from .published import AUTHORS_ROOMS, FASTER
from .report import NONE, Table, Value
from .rooms_rows import Faster, RoomsResult
from .steps import LEGEND, MARK, Steps

GRID = Grid(TABLE, ("cogmap", "frontier", "random", *MODELS[1:]))


def rooms_study(**options: Unpack[Options]) -> RoomsResult:
    """Let every model, nearest-frontier search and a random walk explore every maze of the paper's table.

    Raises:
        CogmapError: `agents` below 1, a negative seed, or a process was killed.
    """
    return RoomsResult(run_grid("rooms", GRID, **options))


def rooms_tasks(agents: int) -> int:
    """How many runs the study makes."""
    return len(GRID.cells(agents))


def rooms_lines(result: RoomsResult) -> list[str]:
    """What the terminal shows."""
    cells, lines = result.cells, [f"steps until every room was entered once, mean ± standard deviation; {LEGEND}"]
    for world in cells.grid.worlds:
        lines.append(world)
        for agent in cells.columns:
            lines.append(f"  {TITLES[agent]:<17}{_cell(agent, cells.steps(VISIT, world, agent))}")
    for part in result.faster:
        lines.append(f"{part.world}: {_share(part)} fewer steps than the best CSCG ({TITLES[part.best]})")
    return [*lines, f"the paper: at least {FASTER:.0%} faster than CSCG in every maze"]


def rooms_tables(result: RoomsResult) -> list[Table]:
    """Every run; means by maze and model; the paper's claim; the figures for machines."""
    cells, columns = result.cells, result.cells.columns
    worlds = cells.grid.worlds
    means = tuple(
        (world, *(_cell(agent, cells.steps(VISIT, world, agent)) for agent in columns), AUTHORS_ROOMS.get(world))
        for world in worlds
    )
    claim = tuple(
        (part.world, part.own.mean_text(), TITLES[part.best], part.steps.mean_text(), _share(part), part.holds)
        for part in result.faster
    )
    return [
        cells.table("rooms"),
        Table(
            "rooms_table",
            ("maze", *(TITLES[agent] for agent in columns), "authors' code: theirs"),
            means,
            f"Steps until every room was entered once; mean ± standard deviation. {LEGEND}.",
        ),
        Table(
            "rooms_claim",
            ("maze", "cogmap", "best CSCG", "its steps", "steps saved [95 %]", f"{FASTER:.0%} or more"),
            claim,
            f"The paper's claim: all rooms discovered at least {FASTER:.0%} faster than CSCG, taken as that share of "
            f"the steps of the best CSCG saved, at the lower end of the interval. {LEGEND}.",
        ),
        summary_table("rooms_summary", cells, VISIT, columns),
    ]


def _cell(agent: str, steps: Steps) -> Value:
    if agent == "oracle":
        return NONE if steps.mean is None else f"{steps.mean:.1f} ± {steps.std:.1f}"
    return steps.text()


def _share(part: Faster) -> str:
    if part.share is None:
        return NONE
    before, after = ("≥ ", MARK) if part.steps.censored else ("", "")
    return f"{before}{part.share.value:.0%}{after} [{part.share.low:.0%}, {part.share.high:.0%}]"
