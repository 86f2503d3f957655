"""A place exists once a door to it was seen (figure on internal map layouts, c): the paper's proposal."""

from __future__ import annotations

from collections.abc import Sequence

from ..cognitive_map import CognitiveMap


class PredictedGrowth:
    """Imagines the place behind every open door before it was seen."""

    def begin(self, map_: CognitiveMap, *, places: int | None, step: int) -> list[int]:
        """The place where the agent wakes up."""
        return [map_.new_place((0,) * len(map_.motions.displacements[0]), step=step)]

    def enter(self, map_: CognitiveMap, place: int, action: int, *, step: int) -> list[int]:
        """Nothing: what lies behind an open door was imagined when it was sensed."""
        return []

    def look(self, map_: CognitiveMap, place: int, open_: Sequence[bool], *, step: int) -> list[int]:
        """The places behind all open doors that the map has no place for."""
        here = map_.position(place)
        new: list[int] = []
        if here is None:
            return new
        for action, is_open in enumerate(open_):
            if is_open and action != map_.motions.stay and map_.beyond(place, action) is None:
                there = map_.motions.move(here, action)
                new.append(map_.new_place(there, step=step, source=place, action=action))
        return new
