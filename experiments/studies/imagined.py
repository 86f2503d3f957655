"""What a plan imagines, as paths through the rooms."""

from __future__ import annotations

from dataclasses import dataclass

from ...model import CognitiveMap
from ...planning import Plan
from ...views import policy_paths
from ...worlds import Position

LEAST = 1e-3
"""Paths that are less probable are left out."""


@dataclass(frozen=True, slots=True)
class ImaginedPath:
    """A path that some policies lead along, from where the agent may be.

    Attributes:
        rooms: one after the other; where a policy stays or bumps, the room is not repeated.
        probability: Q(s) of its first place times P(policy), summed over the policies that lead along it.
    """

    rooms: tuple[Position, ...]
    probability: float


def imagined_paths(plan: Plan, map_: CognitiveMap, start: Position) -> tuple[ImaginedPath, ...]:
    """Where the policies lead if every way is as the map has it, the most probable path first.

    Args:
        plan: of the agent.
        map_: of the agent, in two dimensions.
        start: the room that the agent takes as its origin.
    """
    paths = policy_paths(plan, map_, start=start, least=LEAST)
    return tuple(
        ImaginedPath(tuple((int(row), int(column)) for row, column in path), round(probability, 6))
        for path, probability in paths.items()
    )


def room_of(map_: CognitiveMap, place: int, start: Position) -> Position | None:
    """The room that `place` stands for; None where its position is not known, or there is no such place (-1)."""
    position = None if place < 0 else map_.position(place)
    return None if position is None else (start[0] + position[0], start[1] + position[1])
