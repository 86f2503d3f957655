"""What a growth rule answers."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..generative import GenerativeModel


@dataclass(frozen=True, slots=True)
class Whereabouts:
    """What is believed about the agent's place."""

    places: Mapping[int, float]  # Q(s_t) of the places that hold mass, the most probable first

    @property
    def place(self) -> int:
        """The most probable place."""
        return next(iter(self.places))

    @property
    def certainty(self) -> float:
        """Q of the most probable place."""
        return next(iter(self.places.values()))


class Growth:
    """A growth rule: it decides when places are added to a map. Each method returns the new places; override what
    differs.

    Attributes:
        name: what it is called at the command line and in files.
    """

    name = "growth"

    @property
    def options(self) -> dict[str, Any]:
        """What it was made with, as plain JSON values: its class called with them makes another."""
        return {}

    def begin(self, map_: GenerativeModel, *, step: int) -> list[int]:
        """Before the first step: the place where the agent wakes up."""
        return [map_.new_place(map_.pose.origin, step=step)]

    def enter(self, map_: GenerativeModel, belief: Whereabouts, action: int, *, step: int) -> list[int]:
        """Before inference: the agent went through a door that it had sensed open, from where it believes to be."""
        return []

    def look(self, map_: GenerativeModel, belief: Whereabouts, open_: Sequence[bool], *, step: int) -> list[int]:
        """Before planning: the agent senses the doors of where it believes to be."""
        return []


def place_beyond(map_: GenerativeModel, place: int, action: int, *, step: int) -> list[int]:
    """The place that lies beyond a door, appended where the map has none there and can tell where that is."""
    if action == map_.motions.stay or not map_.pose.known(place) or map_.transitions.beyond(place, action) is not None:
        return []
    position, there = map_.pose.ahead(place, action)
    return [] if there is not None else [map_.new_place(position, step=step, source=place, action=action)]
