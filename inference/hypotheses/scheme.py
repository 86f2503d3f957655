"""What is known beforehand of the ways of a world, and what one step brings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from .records import Position

Reading = int | Mapping[int, float] | None
"""A label, by number; likelihoods of labels; or None: not seen."""


@dataclass(frozen=True, slots=True)
class WayScheme:
    """The ways that a place may have.

    Attributes:
        count: how many; a way is an action.
        inverse: the action that undoes each; None where that is not known.
        displacements: of each way, in Z^n; None without poses. They need `inverse`.
        sensors: how many sensors of sights there are.
    """

    count: int
    inverse: tuple[int, ...] | None = None
    displacements: tuple[Position, ...] | None = None
    sensors: int = 1

    @property
    def origin(self) -> Position:
        """The position that a chart starts from."""
        return (0,) * len(self.displacements[0]) if self.displacements else ()


@dataclass(frozen=True, slots=True)
class Sensed:
    """What one step brings.

    Attributes:
        sights: a reading of each sensor.
        ways: P(open) of each way as it was read, or None where it was not looked at.
        action: the way that was to be taken; None for staying where it is.
        certain: the action is known to have been carried out (`taken`), so none went astray.
        told: the agent is told that it was moved.
    """

    sights: tuple[Reading, ...]
    ways: tuple[float | None, ...]
    action: int | None = None
    certain: bool = False
    told: bool = False
