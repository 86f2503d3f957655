"""Who plays the T maze with a cue as well as can be."""

from collections.abc import Mapping
from typing import Any

from ..worlds import CueMaze, best_cue_action


class CueOptimum:
    """The Bayes-optimal agent of `CueMaze`: it maximises the expected reward of the remaining moves, exactly.

    It is told how often the cue is right and how many moves a trial has.
    """

    def __init__(self, world: CueMaze) -> None:
        self._right, self._moves, self._names = world.right, world.moves, world.motions.names
        self._seen, self._place = 0, "centre"

    def step(self, observation: Mapping[str, Any]) -> int:
        """The next action."""
        self._seen += {"points left": 1, "points right": -1}.get(observation["sight"], 0)
        name = best_cue_action(self._place, self._seen, right=self._right, moves=self._moves)
        self._moves -= 1
        if self._place not in ("left", "right") and name != "stay":
            self._place = name
        return self._names.index(name)
