"""Scoring a map with the truth, which the agent never sees."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..agent import Agent
from ..baselines import CscgAgent
from ..model import CognitiveMap
from ..worlds import GRID, Maze, Position

if TYPE_CHECKING:
    from .walkers import Walker

BELIEVED = 0.6
"""A true transition counts as learned from this probability on."""


class Truth:
    """The transitions of a maze with everything open, to compare maps with.

    The room `r` is the place that a map has at position `r - start`. The true transitions are those of every
    room under every action: walls lead back, `stay` stays.

    Args:
        maze: the layout.
        start: the room that the agent takes as its origin.
    """

    def __init__(self, maze: Maze, start: Position) -> None:
        self._names = [(row - start[0], column - start[1]) for row, column in maze.rooms]
        number = {room: i for i, room in enumerate(maze.rooms)}
        beyond = [[_beyond(maze, room, vector) for vector in GRID.displacements] for room in maze.rooms]
        self._target = np.array([[number[room] for room in row] for row in beyond], dtype=np.int64)  # [R, K]

    def visited(self, map_: CognitiveMap) -> bool:
        """Whether the map has a visited place for every room."""
        places = self._places(map_)
        return places is not None and bool(map_.visited[places].all())

    def least(self, map_: CognitiveMap) -> float:
        """The probability in B_s of the true transition that is believed least; 0 while a room has no place."""
        places = self._places(map_)
        if places is None:
            return 0.0
        actions = self._target.shape[1]
        rows = (places[:, None] * actions + np.arange(actions)).ravel()
        return float(map_.B_s.probability(places[self._target].ravel(), rows).min())

    def learned(self, map_: CognitiveMap) -> bool:
        """Whether every true transition is believed at `BELIEVED` or more."""
        return self.least(map_) >= BELIEVED

    def visited_by(self, walker: Walker, entered: int) -> bool:
        """Whether it has `entered` as many rooms as there are and, if it keeps a map, has them all there as visited."""
        return entered == len(self._names) and (not isinstance(walker, Agent) or self.visited(walker.map))

    def learned_by(self, walker: Walker, rooms: Sequence[int]) -> bool:
        """Whether the walker believes every true transition.

        Args:
            walker: has a map, clones, or `edges` (see `known`); without any of them it knows nothing.
            rooms: the number of the room, in the order of `Maze.rooms`, in which it was at each step.
        """
        if isinstance(walker, Agent):
            return self.learned(walker.map)
        if isinstance(walker, CscgAgent):
            return self.believed(walker.place_transitions(rooms, len(self._names)), walker.tries)
        return self.known(getattr(walker, "edges", {}))

    def believed(self, B: NDArray[np.float64], actions: Sequence[int]) -> bool:
        """Whether `B[next room, room, action]` gives every true transition by these actions `BELIEVED` or more."""
        rooms = np.arange(len(self._names))
        return all(bool((B[self._target[:, action], rooms, action] >= BELIEVED).all()) for action in actions)

    def known(self, edges: Mapping[tuple[tuple[int, ...], int], tuple[int, ...]]) -> bool:
        """Whether `edges`, {(place, action): place} relative to the start, hold every true transition."""
        return all(
            edges.get((name, action)) == self._names[target]
            for name, row in zip(self._names, self._target.tolist(), strict=True)
            for action, target in enumerate(row)
        )

    def _places(self, map_: CognitiveMap) -> np.ndarray[tuple[int], np.dtype[np.int64]] | None:
        """`[R]` the place of each room, once every room has one."""
        places = [map_.place_at(name) for name in self._names]
        return None if None in places else np.array(places, dtype=np.int64)


def _beyond(maze: Maze, room: Position, vector: tuple[int, ...]) -> Position:
    ahead = (room[0] + vector[0], room[1] + vector[1])
    return ahead if ahead in maze.sights else room
