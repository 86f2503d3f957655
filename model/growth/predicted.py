"""A place exists once a door to it was seen (figure on internal map layouts, c): the paper's proposal."""

from collections.abc import Sequence

from ..generative import GenerativeModel
from .base import Growth, Whereabouts, place_beyond


class PredictedGrowth(Growth):
    """Adds an imagined place behind every open door before the agent has seen it."""

    name = "predicted"

    def look(self, map_: GenerativeModel, belief: Whereabouts, open_: Sequence[bool], *, step: int) -> list[int]:
        here = belief.place
        return [
            place
            for action, is_open in enumerate(open_)
            if is_open
            for place in place_beyond(map_, here, action, step=step)
        ]
