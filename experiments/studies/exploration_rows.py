"""What the study `exploration` comes to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..parts import CSCG
from .grid_rows import COMPLETE, LEARN, Cells
from .intervals import Interval
from .published import AUTHORS_LEARN, PAPER_LEARN
from .steps import Steps


@dataclass(frozen=True, slots=True)
class Factor:
    """How many times the steps of ours the best CSCG needs to learn a maze.

    Attributes:
        world: the maze.
        learned: steps to learn of `cogmap`.
        completed: its steps until it had visited every room as well.
        best: the CSCG with the smallest mean.
        steps: of that one.
        ratio: of the two; a lower bound where `steps` is censored, None where `learned` is.
        paper: the same ratio in the paper's table; None where it has no such maze.
    """

    world: str
    learned: Steps
    completed: Steps
    best: str
    steps: Steps
    ratio: Interval | None
    paper: float | None

    def to_dict(self) -> dict[str, Any]:
        """The fields as plain JSON values."""
        ratio = None if self.ratio is None else self.ratio.to_dict()
        return {"world": self.world, "best": self.best, "ratio": ratio, "censored": self.steps.censored} | {
            "steps_to_learn": self.learned.to_dict(),
            "steps_to_complete": self.completed.to_dict(),
            "best_steps_to_learn": self.steps.to_dict(),
            "paper_ratio": self.paper,
        }


@dataclass(frozen=True, slots=True)
class ExplorationResult:
    """All runs of the study."""

    cells: Cells

    @property
    def factors(self) -> tuple[Factor, ...]:
        """By maze, if a CSCG took part."""
        found: list[Factor] = []
        for world in self.cells.grid.worlds:
            best = self.cells.best(LEARN, world, CSCG)
            if best is not None:
                own, both = self.cells.steps(LEARN, world, "cogmap"), self.cells.steps(COMPLETE, world, "cogmap")
                ratio = None if own.censored else best[1].over(own)
                found.append(Factor(world, own, both, *best, ratio, _paper_factor(world)))
        return tuple(found)

    def failed(self) -> tuple[str, ...]:
        """Who never learned which maze."""
        return self.cells.failed(LEARN)

    def to_dict(self) -> dict[str, Any]:
        """Protocol, every run, figures by maze and model, and the ratios, as plain JSON values."""
        return {
            "protocol": self.cells.protocol(),
            "rows": [row.to_dict() for row in self.cells.rows],
            "summary": [
                {
                    "world": world,
                    "agent": agent,
                    **self.cells.steps(LEARN, world, agent).to_dict(),
                    **_published(world, agent),
                }
                for world in self.cells.grid.worlds
                for agent in self.cells.columns
            ],
            "ratios": [factor.to_dict() for factor in self.factors],
        }


def _published(world: str, agent: str) -> dict[str, float | None]:
    paper, authors = PAPER_LEARN.get(world, {}).get(agent), AUTHORS_LEARN.get(world, {}).get(agent)
    return {
        "paper_mean": None if paper is None else paper.mean,
        "paper_std": None if paper is None else paper.std,
        "authors_mean": None if authors is None else authors.mean,
        "authors_std": None if authors is None else authors.std,
        "authors_learned": None if authors is None else authors.got,
        "authors_runs": None if authors is None else authors.of,
    }


def _paper_factor(world: str) -> float | None:
    row = PAPER_LEARN.get(world)
    return None if row is None else round(min(row[model].mean for model in CSCG) / row["cogmap"].mean, 1)
