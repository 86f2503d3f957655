"""What one time step brings."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

Outcome = Literal["arrived", "blocked", "unsure"]
"""What the body says of its last move."""

OUTCOMES: tuple[Outcome, ...] = ("arrived", "blocked", "unsure")


@dataclass(frozen=True, slots=True)
class Percept:
    """One time step: the action, and what was sensed after it.

    Attributes:
        action: index of the action that led here; None at the first step.
        opened: whether the way of that action may have been open by what was sensed before.
        readings: by name of the sensor, as the sensor reads it; a sensor that saw nothing is left out. Of a sensor of
            sights: the number of a label, or likelihoods by number. Of ways: see `open`.
        taken: the action is known to have been carried out; it was not only answered.
        outcome: what the body says of the move; None where it says nothing.
        displacement: what odometry measured of the move, along each axis; None where it did not.
        turn: what it measured of a turn.
        moved: the agent is told that it was moved.
        cost: what the move cost.
        lengths: how far each action leads from here, in the unit of displacements; None as for `costs`.
        costs: what each action is expected to cost from here; None of those of which nobody knows, or of all.
    """

    action: int | None = None
    opened: bool = False
    readings: Mapping[str, Any] = field(default_factory=dict[str, Any])
    taken: bool = False
    outcome: Outcome | None = None
    displacement: tuple[float, ...] | None = None
    turn: float | None = None
    moved: bool = False
    cost: float | None = None
    costs: tuple[float | None, ...] | None = None
    lengths: tuple[float | None, ...] | None = None

    @property
    def open(self) -> tuple[bool | float | None, ...] | None:
        """For each action whether its way is sensed open: true, false, P(open), or None where it was not looked at.

        None where no way was looked at.
        """
        return self.readings.get("open")

    @property
    def passable(self) -> tuple[bool, ...] | None:
        """For each action whether its way may be open: what was not looked at may be. None where nothing was."""
        return None if self.open is None else tuple(way is None or way >= 0.5 for way in self.open)

    def shut(self, action: int) -> bool:
        """Whether the way of the action is surely sensed shut."""
        return self.open is not None and self.open[action] is not None and self.open[action] == 0

    def ways(self, count: int) -> tuple[float | None, ...]:
        """P(open) of each of `count` actions as it was read; None for what was not looked at."""
        return (None,) * count if self.open is None else tuple(None if w is None else float(w) for w in self.open)
