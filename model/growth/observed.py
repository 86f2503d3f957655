"""A place exists once it was entered (figure on internal map layouts, b)."""

from ..generative import GenerativeModel
from .base import Growth, Whereabouts, place_beyond


class ObservedGrowth(Growth):
    """Grows on entering; the doors that were not taken are forgotten."""

    name = "observed"

    def enter(self, map_: GenerativeModel, belief: Whereabouts, action: int, *, step: int) -> list[int]:
        return place_beyond(map_, belief.place, action, step=step)
