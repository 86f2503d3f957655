"""A place exists once it was entered (figure on internal map layouts, b)."""

from ..generative import GenerativeModel
from .base import Growth, Whereabouts, place_beyond


class ObservedGrowth(Growth):
    """Adds a place when the agent enters it. Doors that were not taken add nothing."""

    name = "observed"

    def enter(self, map_: GenerativeModel, belief: Whereabouts, action: int, *, step: int) -> list[int]:
        return place_beyond(map_, belief.place, action, step=step)
