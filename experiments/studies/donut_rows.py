"""What the study of the donut notes down."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from itertools import pairwise
from typing import Any

from ...worlds import MAZES, Label, Position
from .imagined import ImaginedPath

MAZE = MAZES["donut"]
CORNER: Position = (0, 0)
GOAL_ROOM: Position = (2, 4)
GOAL: Label = MAZE.sights[GOAL_ROOM]
CLOSED: Position = (0, 2)
DOORS: dict[str, tuple[Position, str]] = {"from the left": ((0, 1), "right"), "from the right": ((0, 3), "left")}
"""The doors of the closed room: from where, and the action that leads in."""


@dataclass(frozen=True, slots=True)
class DonutStep:
    """One observation after the move.

    Attributes:
        room: where the agent is.
        action: what it chose, by name.
        probability: P(policy) of the chosen one.
        first_action: P(first action) by name.
        paths: what the policies imagine, the most probable path first.
        way_open: P(way open) of each door in `DOORS`, after this observation.
    """

    room: Position
    action: str
    probability: float
    first_action: dict[str, float]
    paths: tuple[ImaginedPath, ...]
    way_open: dict[str, float]

    def to_dict(self) -> dict[str, Any]:
        """The step as plain JSON values."""
        return {**asdict(self), "room": list(self.room), "paths": [path.to_dict() for path in self.paths]}


@dataclass(frozen=True, slots=True)
class DonutRow:
    """One agent.

    Attributes:
        seed: of its start and of all it does.
        start: the room where it began to explore.
        steps_to_explore: None where it gave up, and was not moved.
        steps: every observation after the move.
        reached: whether it chose to stay at the goal.
    """

    seed: int
    start: Position
    steps_to_explore: int | None
    steps: tuple[DonutStep, ...]
    reached: bool

    @property
    def path(self) -> list[Position]:
        """The rooms, from the corner on."""
        return [step.room for step in self.steps]

    @property
    def moves(self) -> int | None:
        """Actions until it chose to stay at the goal; None if it never did."""
        return len(self.steps) - 1 if self.reached else None

    @property
    def met(self) -> bool:
        """Whether it came to a door of the closed room."""
        return any(step.room in {room for room, _ in DOORS.values()} for step in self.steps)

    @property
    def bumps(self) -> int:
        """How often it tried to enter the closed room."""
        return sum((step.room, step.action) in DOORS.values() for step in self.steps)

    @property
    def second_tries(self) -> int:
        """How often it took the closed way again from the corner, or tried to enter the closed room."""
        again = sum(way == (CORNER, DOORS["from the left"][0]) for way in pairwise(self.path)) - 1
        return max(again, 0) + self.bumps

    def to_dict(self) -> dict[str, Any]:
        """The row as plain JSON values."""
        return {
            "seed": self.seed,
            "start": list(self.start),
            "steps_to_explore": self.steps_to_explore,
            "reached": self.reached,
            "moves": self.moves,
            "met_closed_room": self.met,
            "second_tries": self.second_tries,
            "bumps": self.bumps,
            "path": [list(room) for room in self.path],
            "steps": [step.to_dict() for step in self.steps],
        }
