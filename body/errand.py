"""What an environment of MiniGrid wants done, read from its mission: its goal, or something to go to, fetch or open."""

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .vocabulary import BALL, BOX, DOOR, GOAL, KEY, vocabulary

_COLOURS = ("red", "green", "blue", "purple", "yellow", "grey")
_THINGS = {"ball": (BALL,), "box": (BOX,), "key": (KEY,), "door": (DOOR,), "object": (BALL, BOX, KEY)}
_ORDER = re.compile(
    rf"(go to|pick up|open|fetch|get) (?:the|a|an) (?:({'|'.join(_COLOURS)}) )?({'|'.join(_THINGS)})(?! behind| next)"
)
_OTHER = re.compile(r" then |after you| and (?!then get to the goal)|next to|behind|avoid|press")


@dataclass(frozen=True, eq=False)
class Errand:
    """Something to be done at a tile."""

    wanted: NDArray[np.bool_]  # `[K]` the tiles that will do
    upon: bool  # whether to stand on it; else before it
    action: str | None = None  # what is done there at last; None of nothing


def errand_of(mission: str) -> Errand | None:
    """The goal of a mission, if it asks for a goal or for one object; None otherwise.

    Of a mission with a key to be used, the goal is what counts.
    """
    words = vocabulary().codes
    mission = re.sub(r"avoid the lava and ", "", mission)  # which a body does by itself
    if re.search(r"\bgoal\b", mission) and "avoid" not in mission:
        return Errand(words[:, 0] == GOAL, True)
    found = _ORDER.search(mission)
    if found is None or _OTHER.search(mission):
        return None
    verb, colour, thing = found.groups()
    wanted = np.isin(words[:, 0], _THINGS[thing])
    if colour is not None:
        wanted &= words[:, 1] == _COLOURS.index(colour)
    return Errand(wanted, False, {"pick up": "pickup", "fetch": "pickup", "get": "pickup", "open": "toggle"}.get(verb))
