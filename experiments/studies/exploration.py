"""The study `exploration`: the paper's table of the steps that each model needs to learn each maze."""

from __future__ import annotations

from typing import Unpack

from .exploration_rows import ExplorationResult, Factor
from .grid import MODELS, TABLE, Grid, Options, run_grid
from .grid_rows import LEARN, TITLES, Cells, summary_table
from .published import AUTHORS_LEARN, PAPER_LEARN
from .report import NONE, Table, Value
from .steps import LEGEND, Steps, factor_text

GRID = Grid(TABLE, MODELS)


def exploration_study(**options: Unpack[Options]) -> ExplorationResult:
    """Let every model explore every maze of the paper's table.

    Raises:
        CogmapError: `agents` below 1, a negative seed, or a process was killed.
    """
    return ExplorationResult(run_grid("exploration", GRID, **options))


def exploration_tasks(agents: int) -> int:
    """How many runs the study makes."""
    return len(GRID.cells(agents))


def exploration_lines(result: ExplorationResult) -> list[str]:
    """What the terminal shows."""
    cells, lines = result.cells, [f"steps to learn, mean ± standard deviation (learned of runs); {LEGEND}"]
    for world in cells.grid.worlds:
        lines.append(world)
        for agent in cells.columns:
            steps, paper = cells.steps(LEARN, world, agent), PAPER_LEARN.get(world, {}).get(agent)
            beside = "" if paper is None else f"  paper {paper}"
            lines.append(f"  {TITLES[agent]:<17}{_own(agent, steps):<46}{beside}".rstrip())
    for factor in result.factors:
        text = factor_text(factor.ratio, censored=factor.steps.censored)
        lines.append(f"{factor.world}: best CSCG ({TITLES[factor.best]}) over cogmap {text}")
    return lines


def exploration_tables(result: ExplorationResult) -> list[Table]:
    """Every run; the paper's table; ours beside the published; the ratios; the figures for machines."""
    cells, columns = result.cells, result.cells.columns
    worlds = cells.grid.worlds
    paper = tuple((world, *(_own(agent, cells.steps(LEARN, world, agent)) for agent in columns)) for world in worlds)
    return [
        cells.table("exploration"),
        Table(
            "exploration_table",
            ("maze", *(TITLES[agent] for agent in columns)),
            paper,
            f"Steps to learn, as in the paper's table; mean ± standard deviation (learned of runs). {LEGEND}.",
        ),
        Table(
            "exploration_compared",
            ("maze", "model", "mean ± sd", "95 % interval", "learned", "paper", "authors' code"),
            tuple(_compared(world, agent, cells) for world in worlds for agent in columns),
            f"Steps to learn beside the published; interval of the mean by bootstrap. {LEGEND}.",
        ),
        Table(
            "exploration_ratio",
            ("maze", "cogmap learned", "cogmap complete", "best CSCG", "its steps", "ratio", "ratio in the paper"),
            tuple(_factor_row(factor) for factor in result.factors),
            f"How many times the steps of cogmap the best CSCG needs, with 95 % interval. {LEGEND}.",
        ),
        summary_table("exploration_summary", cells, LEARN, columns),
    ]


def _own(agent: str, steps: Steps) -> str:
    if agent == "oracle" or steps.censored:
        return steps.mean_text()
    return f"{steps.mean_text()} ({steps.count_text()})"


def _compared(world: str, agent: str, cells: Cells) -> tuple[Value, ...]:
    steps = cells.steps(LEARN, world, agent)
    published = (PAPER_LEARN.get(world, {}).get(agent), AUTHORS_LEARN.get(world, {}).get(agent))
    beside = (NONE if figure is None else str(figure) for figure in published)
    count = NONE if agent == "oracle" else steps.count_text()
    return (world, TITLES[agent], steps.mean_text(), steps.interval_text(), count, *beside)


def _factor_row(factor: Factor) -> tuple[Value, ...]:
    learned, completed = (_own("cogmap", steps) for steps in (factor.learned, factor.completed))
    ratio = factor_text(factor.ratio, censored=factor.steps.censored)
    best = _own(factor.best, factor.steps)
    return (factor.world, learned, completed, TITLES[factor.best], best, ratio, factor.paper)
