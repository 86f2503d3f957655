"""What a growth strategy answers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from ..cognitive_map import CognitiveMap


class Growth(Protocol):
    """When places, and with them variables' values, are added to a map. Each method returns the new places."""

    def begin(self, map_: CognitiveMap, *, places: int | None, step: int) -> list[int]:
        """Before the first step; `places` is the size of the world where it is known."""
        ...

    def enter(self, map_: CognitiveMap, place: int, action: int, *, step: int) -> list[int]:
        """Before inference: the agent went from `place` through a door that it had sensed open."""
        ...

    def look(self, map_: CognitiveMap, place: int, open_: Sequence[bool], *, step: int) -> list[int]:
        """Before planning: the agent is in `place` and senses its doors."""
        ...
