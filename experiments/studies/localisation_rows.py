"""What the study of localisation notes down."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from ...worlds import Label, Position
from .imagined import ImaginedPath

CANDIDATE = 0.1
"""A place that holds as much of the belief is one where the agent may be."""


@dataclass(frozen=True, slots=True)
class Condition:
    """What the agent has to go by.

    Attributes:
        name: of the condition.
        told: whether it is told that it was moved: P(moved) = 1 at the first observation after the move. If not,
            it has its displacement prior alone.
        doors: whether the doors it senses are evidence of where it is; they always show which ways are open.
    """

    name: str
    told: bool
    doors: bool

    @property
    def text(self) -> str:
        """The condition in words."""
        return f"{'told' if self.told else 'not told'}, {'sights and doors' if self.doors else 'sights alone'}"


CONDITIONS = (
    Condition("silent_doors", told=False, doors=True),
    Condition("silent_sights", told=False, doors=False),
    Condition("told_doors", told=True, doors=True),
    Condition("told_sights", told=True, doors=False),
)
"""`told_sights` is the paper's case: its agent is told, and its model has no likelihood of doors."""


@dataclass(frozen=True, slots=True)
class LocalisationStep:
    """One observation after the move.

    Attributes:
        room: where the agent is.
        sight: what it sees there.
        posterior: (place, its room, Q) for every visited place.
        entropy: of Q(s), in nats.
        certainty: the greatest Q(s).
        certain: whether that is enough to learn.
        right: whether the most probable place is the true one.
        candidates: places with `CANDIDATE` or more.
        moved: P(moved_t).
        first_action: P(first action) by name.
        paths: what the policies imagine, the most probable path first.
    """

    room: Position
    sight: Label
    posterior: tuple[tuple[int, Position, float], ...]
    entropy: float
    certainty: float
    certain: bool
    right: bool
    candidates: int
    moved: float
    first_action: dict[str, float]
    paths: tuple[ImaginedPath, ...]

    def to_dict(self) -> dict[str, Any]:
        """The step as plain JSON values."""
        posterior = [{"place": place, "room": list(room), "probability": q} for place, room, q in self.posterior]
        paths = [path.to_dict() for path in self.paths]
        return {**asdict(self), "room": list(self.room), "posterior": posterior, "paths": paths}


@dataclass(frozen=True, slots=True)
class LocalisationTrial:
    """The way of one agent from the foot to the goal under one condition.

    Attributes:
        condition: its name.
        steps: every observation after the move.
        reached: whether it chose to stay at the goal.
        steps_to_localise: until it was certain of the true place, 0 at the first observation; None if never.
        steps_certain_but_wrong: observations at which it was certain of another place.
        map_intact: whether at the end every true transition was still believed at 0.6 or more.
    """

    condition: str
    steps: tuple[LocalisationStep, ...]
    reached: bool
    steps_to_localise: int | None
    steps_certain_but_wrong: int
    map_intact: bool

    @property
    def first(self) -> str:
        """What it believed after the first sight: "right", "wrong" or, if not certain, "split"."""
        step = self.steps[0]
        return "split" if not step.certain else "right" if step.right else "wrong"

    def to_dict(self) -> dict[str, Any]:
        """The trial as plain JSON values."""
        steps = [step.to_dict() for step in self.steps]
        return {**asdict(self), "first": self.first, "moves": len(steps) - 1, "steps": steps}


@dataclass(frozen=True, slots=True)
class LocalisationRow:
    """One agent.

    Attributes:
        seed: of its start and of all it does.
        start: the room where it began to explore.
        steps_to_explore: None where it gave up, and was not moved.
        expected: the room in which it would have been, had nobody moved it.
        trials: one a condition, from the same map and the same room.
    """

    seed: int
    start: Position
    steps_to_explore: int | None
    expected: Position
    trials: tuple[LocalisationTrial, ...]

    def to_dict(self) -> dict[str, Any]:
        """The row as plain JSON values."""
        trials = [trial.to_dict() for trial in self.trials]
        return {**asdict(self), "start": list(self.start), "expected": list(self.expected), "trials": trials}
