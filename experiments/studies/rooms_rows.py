"""What the study `rooms` comes to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..parts import CSCG
from .grid_rows import VISIT, Cells
from .intervals import Interval
from .published import FASTER
from .steps import Steps


@dataclass(frozen=True, slots=True)
class Faster:
    """How much sooner than the best CSCG `cogmap` has been in every room of a maze.

    Attributes:
        world: the maze.
        own: steps of `cogmap`.
        best: the CSCG with the smallest mean.
        steps: of that one.
        share: of its steps that `cogmap` saves; a lower bound where `steps` is censored, None where `own` is.
    """

    world: str
    own: Steps
    best: str
    steps: Steps
    share: Interval | None

    @property
    def holds(self) -> bool:
        """Whether the paper's claim does, at the lower end of the interval."""
        return self.share is not None and self.share.low >= FASTER

    def to_dict(self) -> dict[str, Any]:
        """The fields as plain JSON values."""
        own = {
            "world": self.world,
            "best": self.best,
            "saved": self.share and self.share.to_dict(),
            "claim_holds": self.holds,
        }
        return {**own, "censored": self.steps.censored}


@dataclass(frozen=True, slots=True)
class RoomsResult:
    """All runs of the study."""

    cells: Cells

    @property
    def faster(self) -> tuple[Faster, ...]:
        """By maze, if a CSCG took part."""
        found: list[Faster] = []
        for world in self.cells.grid.worlds:
            best, own = self.cells.best(VISIT, world, CSCG), self.cells.steps(VISIT, world, "cogmap")
            if best is not None:
                part = None if own.censored else own.over(best[1])
                saved = part and Interval(1.0 - part.value, 1.0 - part.high, 1.0 - part.low, part.count)
                found.append(Faster(world, own, *best, saved))
        return tuple(found)

    def failed(self) -> tuple[str, ...]:
        """Who never came into every room of which maze."""
        return self.cells.failed(VISIT)

    def to_dict(self) -> dict[str, Any]:
        """Protocol, every run, figures by maze and model, and the paper's claim, as plain JSON values."""
        return {
            "protocol": self.cells.protocol(),
            "rows": [row.to_dict() for row in self.cells.rows],
            "summary": [
                {"world": world, "agent": agent, **self.cells.steps(VISIT, world, agent).to_dict()}
                for world in self.cells.grid.worlds
                for agent in self.cells.columns
            ],
            "claim": {"at_least": FASTER, "by_maze": [part.to_dict() for part in self.faster]},
        }
