"""The moves a world offers, as plain data."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Motions:
    """Named actions, each a displacement in Z^n.

    Attributes:
        names: action names, in the order of the action indices.
        displacements: one vector of `n` integers an action.
    """

    names: tuple[str, ...]
    displacements: tuple[tuple[int, ...], ...]


GRID = Motions(
    names=("up", "down", "left", "right", "stay"),
    displacements=((-1, 0), (1, 0), (0, -1), (0, 1), (0, 0)),
)
