"""A place exists once it was entered (figure on internal map layouts, b)."""

from __future__ import annotations

from collections.abc import Sequence

from ..cognitive_map import CognitiveMap


class ObservedGrowth:
    """Grows on entering; the doors that were not taken are forgotten."""

    def begin(self, map_: CognitiveMap, *, places: int | None, step: int) -> list[int]:
        """The place where the agent wakes up."""
        return [map_.new_place((0,) * len(map_.motions.displacements[0]), step=step)]

    def enter(self, map_: CognitiveMap, place: int, action: int, *, step: int) -> list[int]:
        """The place behind the door that was taken."""
        here = map_.position(place)
        if here is None or map_.beyond(place, action) is not None:
            return []
        there = map_.motions.move(here, action)
        if map_.place_at(there) is not None:
            return []
        return [map_.new_place(there, step=step, source=place, action=action)]

    def look(self, map_: CognitiveMap, place: int, open_: Sequence[bool], *, step: int) -> list[int]:
        """Nothing: only what was entered exists."""
        return []
