"""What the study of Tolman's maze notes down, and what it comes to."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ...worlds import Position
from .shares import Share, total_variation, wilson
from .tolman_maze import MISSED, ROUTES, A, B, TolmanRun, choice_after

BLOCKS: dict[str, Position | None] = {"no obstacle": None, "A closed": A, "B closed": B}
"""The three blocks and the room that is closed in each, in their order; the agent keeps its memory."""

PAPER: dict[str, tuple[int, int, int]] = {
    "no obstacle": (48, 27, 28),
    "A closed": (0, 70, 49),
    "B closed": (0, 36, 48),
}
"""Runs of 120 by route, paper's table of path counts; with B closed they are attempts, since B cuts route 2 too."""
PAPER_RUNS = 120


@dataclass(frozen=True, slots=True)
class TolmanRow:
    """One agent.

    Attributes:
        seed: of the agent; the start is the same for all.
        blocks: the runs of each block, in the order of `BLOCKS`.
        places: places of its map at the end; the maze has 23 rooms.
    """

    seed: int
    blocks: tuple[tuple[TolmanRun, ...], ...]
    places: int

    @property
    def after(self) -> tuple[int | None, ...]:
        """By block, route 2 or 3, whichever was tried first after the closed room was first met; None if neither."""
        return tuple(None if (choice := choice_after(runs)) is None else choice.route for runs in self.blocks)

    def to_dict(self) -> dict[str, Any]:
        """The row as plain JSON values."""
        blocks = dict(zip(BLOCKS, self.blocks, strict=True))
        return {
            "seed": self.seed,
            "places": self.places,
            "after_block": dict(zip(BLOCKS, self.after, strict=True)),
            "blocks": {name: [run.to_dict() for run in runs] for name, runs in blocks.items()},
        }


@dataclass(frozen=True, slots=True)
class TolmanCounts:
    """The runs of one block, all agents together.

    Attributes:
        runs: how many.
        attempted: by route, the first set out on.
        reached: by route, the goal reached on it.
        missed: runs that missed the goal, by reason.
        met: runs in which the closed room was met.
        after: agents by the route tried first after the closed room was first met.
    """

    runs: int
    attempted: tuple[int, ...]
    reached: tuple[int, ...]
    missed: dict[str, int]
    met: int
    after: tuple[int, ...]

    @classmethod
    def of(cls, rows: Sequence[TolmanRow], block: int) -> TolmanCounts:
        """The counts of block number `block`."""
        runs = [run for row in rows for run in row.blocks[block]]
        missed = Counter(run.missed for run in runs)
        return cls(
            runs=len(runs),
            attempted=_by_route([run.attempted for run in runs]),
            reached=_by_route([run.route for run in runs]),
            missed={reason: missed[reason] for reason in MISSED},
            met=sum(run.met_at is not None for run in runs),
            after=_by_route([row.after[block] for row in rows]),
        )

    def shares(self, which: str) -> list[Share]:
        """Of `attempted` or `reached`, the share of all runs by route."""
        return [wilson(count, self.runs) for count in getattr(self, which)]

    @property
    def goal(self) -> Share:
        """Runs that reached the goal."""
        return wilson(sum(self.reached), self.runs)

    def to_dict(self) -> dict[str, Any]:
        """The counts as plain JSON values."""
        return {
            "runs": self.runs,
            "attempted": named(self.shares("attempted")),
            "reached": named(self.shares("reached")),
            "goal_reached": self.goal.to_dict(),
            "missed": self.missed,
            "runs_that_met_the_block": self.met,
            "agents_by_first_route_after_the_block": dict(zip(map(str, ROUTES), self.after, strict=True)),
        }


@dataclass(frozen=True, slots=True)
class KnobSetting:
    """All that was found with one value of the knob.

    Attributes:
        value: of the knob.
        agents: how many took part.
        counts: by block.
    """

    value: float
    agents: int
    counts: tuple[TolmanCounts, ...]

    @property
    def distance(self) -> float:
        """From the paper's table: total variation of the shares by route and of missed runs, mean of the blocks."""
        distances = [
            total_variation(compared(counts, name), paper_counts(name))
            for name, counts in zip(BLOCKS, self.counts, strict=True)
        ]
        return sum(distances) / len(distances)

    def to_dict(self) -> dict[str, Any]:
        """The setting as plain JSON values."""
        counts = {name: part.to_dict() for name, part in zip(BLOCKS, self.counts, strict=True)}
        return {"value": self.value, "agents": self.agents, "distance": self.distance, "blocks": counts}


def compared(counts: TolmanCounts, name: str) -> tuple[int, ...]:
    """Runs by route and, last, all others, counted as the paper counts that block."""
    routes = (0, *counts.attempted[1:]) if name == "B closed" else counts.reached
    return (*routes, counts.runs - sum(routes))


def paper_counts(name: str) -> tuple[int, ...]:
    """The paper's runs by route and, last, all others."""
    return (*PAPER[name], PAPER_RUNS - sum(PAPER[name]))


def _by_route(routes: Sequence[int | None]) -> tuple[int, ...]:
    return tuple(sum(taken == route for taken in routes) for route in ROUTES)


def named(shares: Sequence[Share]) -> dict[str, dict[str, float]]:
    """The shares by route, as plain JSON values."""
    return {str(route): share.to_dict() for route, share in zip(ROUTES, shares, strict=True)}
