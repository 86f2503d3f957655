"""The append-only log of everything that was ever added to a map."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass
from typing import Literal

GrowthKind = Literal["time", "sight", "position", "place", "bind", "unbind", "retract"]

KINDS: tuple[GrowthKind, ...] = ("time", "sight", "position", "place", "bind", "unbind", "retract")
"""All kinds of growth."""


@dataclass(frozen=True, slots=True)
class GrowthEvent:
    """One addition to the model.

    Attributes:
        step: time step at which it happened.
        kind: `time` (variables and factors of a step), `sight` (a value of o), `position` (a value of p),
            `place` (a value of s), `bind` (a place known before gets its position: static growth), `unbind`
            (it was given by mistake), `retract` (the last places were imagined by mistake, and are gone).
        index: the number that the new step, value or place has from now on; for `retract`, how many places went.
        label: the sight or the position as the agent knows it; for a place, its position or None.
        source: the place from which it was seen or entered, or None.
        action: index of the action that leads there from `source`, or None.
        sensor: for a `sight`, the name of the sensor whose label it is.
    """

    step: int
    kind: GrowthKind
    index: int
    label: Hashable = None
    source: int | None = None
    action: int | None = None
    sensor: str | None = None
