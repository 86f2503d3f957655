"""What one time step brings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True, slots=True)
class Percept:
    """What was done, and then sensed.

    Attributes:
        action: index of the action that led here; None at the first step.
        opened: whether the way of that action had been sensed open before.
        readings: by name of the sensor, as the sensor reads it; a sensor that saw nothing is left out.
    """

    action: int | None = None
    opened: bool = False
    readings: Mapping[str, Any] = field(default_factory=dict[str, Any])

    @property
    def open(self) -> tuple[bool, ...] | None:
        """For each action whether its way is sensed open; None where nothing senses that."""
        return self.readings.get("open")
