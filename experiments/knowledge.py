"""Scoring a map with the truth, which the agent never sees."""

from collections.abc import Mapping, Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..agent import Agent
from ..baselines import ChartFrontier, CscgAgent
from ..model import CognitiveMap
from ..worlds import Chart, Maze, Place
from .judging import BELIEVED, Trail
from .running import Moment, Walker, Watch

Offset = tuple[int, ...]


class Truth:
    """The transitions of a world with all doors open, to compare maps with.

    A true place stands for the place that a map has where the displacements of the actions lead from `start`. Where
    these do not fit into a lattice no place of a map stands for any, and nothing is learned. The true transitions are
    those of every place under every action: walls lead back, `stay` stays.

    Args:
        chart: the true map, such as a maze.
        start: the place that the agent takes as its origin.

    Attributes:
        chart: as given.
        number: of each place, in the order of the chart.
    """

    def __init__(self, chart: Chart, start: Place) -> None:
        self.number = {place: i for i, place in enumerate(chart.places)}
        self.chart, self._start = chart, start

    @cached_property
    def _ahead(self) -> list[list[int]]:
        """Where each action leads from each place."""
        successors = map(self.chart.successors, self.chart.places)
        return [[self.number[other] for other in row.values()] for row in successors]

    @cached_property
    def _target(self) -> NDArray[np.int64]:
        """`[R, K]` the same; an action that a place has not leads back."""
        most = max(map(len, self._ahead))
        return np.array([[*row, *[i] * (most - len(row))] for i, row in enumerate(self._ahead)])

    @cached_property
    def _offset(self) -> dict[int, Offset]:
        """Where each place lies from the start, by its number; empty where the moves do not fit into a lattice."""
        if isinstance(self.chart, Maze):  # it always does
            return {i: (r - self._start[0], c - self._start[1]) for i, (r, c) in enumerate(self.chart.places)}
        return _offsets(self._ahead, self.number[self._start], self.chart.motions.displacements)

    def place(self, map_: CognitiveMap, place: Place) -> int | None:
        """The place of a map that stands for a true one; None if there is none."""
        offset = self._offset.get(self.number[place])
        return None if offset is None else map_.place_at(offset)

    def right(self, agent: Agent, place: Place, trail: Trail) -> bool:
        """Whether an agent takes itself to be in the place that stands for `place`, or was visited there."""
        stands = self.place(agent.map, place)
        return stands == agent.belief.place if stands is not None else trail.room(agent, agent.belief.place) == place

    def visited(self, map_: CognitiveMap) -> bool:
        """Whether the map has a visited place for every true one."""
        places = self._places(map_)
        return places is not None and bool(map_.visited[places].all())

    def least(self, map_: CognitiveMap) -> float:
        """The probability in B_s of the true transition that is believed least; 0 while one has no place."""
        places = self._places(map_)
        if places is None:
            return 0.0
        actions = self._target.shape[1]
        rows = (places[:, None] * actions + np.arange(actions)).ravel()
        return float(map_.B_s.probability(places[self._target].ravel(), rows).min())

    def learned(self, map_: CognitiveMap) -> bool:
        """Whether every true transition is believed at `BELIEVED` or more."""
        return self.least(map_) >= BELIEVED

    def learned_by(self, walker: Walker, path: Sequence[int]) -> bool:
        """Whether the walker believes every true transition.

        Args:
            walker: has a map, clones, or `edges` (see `known`); without any of them it knows nothing.
            path: the number of the place in which it was at each step.
        """
        if isinstance(walker, Agent):
            return self.learned(walker.map)
        if isinstance(walker, ChartFrontier):  # it is told where ways lead when it enters a place
            return len(walker.entered) == len(self.number)
        if isinstance(walker, CscgAgent):
            B, places = walker.place_transitions(path, len(self.number)), np.arange(len(self.number))
            return all(bool((B[self._target[:, a], places, a] >= BELIEVED).all()) for a in walker.tries)
        return self.known(getattr(walker, "edges", {}))

    def known(self, edges: Mapping[tuple[Offset, int], Offset]) -> bool:
        """Whether `edges`, {(place, action): place} relative to the start, hold every true transition."""
        if len(edges) < len(self.number) or not self._offset:
            return False
        return all(
            edges.get((self._offset[number], action)) == self._offset[target]
            for number, row in enumerate(self._target.tolist())
            for action, target in enumerate(row)
        )

    def _places(self, map_: CognitiveMap) -> NDArray[np.int64] | None:
        """`[R]` the place of each true one, once every one has one."""
        if len(map_.places) < len(self.number):
            return None
        places = [map_.place_at(self._offset[number]) for number in range(len(self._offset))]
        return None if None in places or not places else np.array(places, dtype=np.int64)


class Knowledge:
    """Looks on at an exploration, with `watch` beside it, and ends it once everything is known.

    A true place stands for the place of the map that is where its position says, or else for the one that was visited
    there: on a torus positions say nothing, and an agent may have none.

    Attributes:
        trail: where it was.
        visit_all: steps until every place had been entered, and is visited in the map of an agent that keeps one.
        learn: steps until every true transition was believed.
        complete: steps until both held at once. None of what never was, as with the others.
    """

    def __init__(self, truth: Truth, trail: Trail, watch: Watch | None = None, *, on: bool = False) -> None:
        self._truth, self.trail, self._watch, self._on = truth, trail, watch, on
        self._path, self._left = list[int](), set(truth.number.values())
        self.visit_all: int | None = None
        self.learn: int | None = None
        self.complete: int | None = None

    def __call__(self, moment: Moment) -> bool:
        """Look at a choice."""
        self.trail(moment)
        self._path.append(self._truth.number[self.trail.rooms[-1]])
        self._left.discard(self._path[-1])
        if self.complete is None:
            visited, learned = self._known(moment.agent)
            self.visit_all = moment.step if visited and self.visit_all is None else self.visit_all
            self.learn = moment.step if learned and self.learn is None else self.learn
            self.complete = moment.step if visited and learned else None
        stop = self._watch is not None and self._watch(moment) is True
        return stop or (self.complete is not None and not self._on)

    def _known(self, walker: Walker) -> tuple[bool, bool]:
        """Whether every place is visited, and whether every transition is believed."""
        learned = self._truth.learned_by(walker, self._path)
        if not isinstance(walker, Agent):
            return not self._left, learned
        if self._left or self._truth.visited(walker.map):
            return not self._left, learned
        right = self.trail.verdict(walker, self._truth.chart).map_right
        visited = walker.map.pose.settles and int(walker.map.visited.sum()) >= len(self._truth.number)
        return right or visited, learned or right


def _offsets(ahead: Sequence[Sequence[int]], start: int, displacements: Sequence[Offset]) -> dict[int, Offset]:
    """Where each place lies from the start, by its number; empty where the moves do not fit into a lattice."""
    if not displacements:
        return {}
    found, order = {start: tuple(0 for _ in displacements[0])}, [start]
    for place in order:  # grows while it is read
        for other, vector in zip(ahead[place], displacements, strict=True):
            offset = tuple(x + dx for x, dx in zip(found[place], vector, strict=True))
            if other != place and other not in found:
                found[other] = offset
                order.append(other)
            elif other != place and found[other] != offset:
                return {}
    return found if len(set(found.values())) == len(ahead) else {}
