"""Teaches the map what the agent is certain of, and lets it grow."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from ..inference import Belief, infer
from ..model import CognitiveMap, Growth, Percept, Position, Slice, Whereabouts, window_graph
from .settings import Settings
from .state import Moment


class Mapper:
    """Learning and growth of one map.

    Args:
        map_: the map.
        growth: its growth rule.
        settings: how certain one must be, and how much fades.
    """

    def __init__(self, map_: CognitiveMap, growth: Growth, settings: Settings) -> None:
        self._map = map_
        self._growth = growth
        self._settings = settings

    def moment(self, step: int, percept: Percept) -> Moment:
        """The time step that begins now, to which `relive` may return."""
        return Moment(step, self._map.changes.mark(), len(self._map.visited_places), percept)

    def enter(self, belief: Whereabouts, action: int, *, step: int) -> None:
        """Before inference: the agent took a door that was open."""
        self._map.recall(self._growth.enter(self._map, belief, action, step=step))

    def learn(self, belief: Belief, percept: Percept, *, step: int) -> None:
        """What a certain belief teaches: transitions, what was sensed, and the places behind open doors."""
        if self._settings.forgetting:
            self._map.transitions.forget(1.0 - self._settings.forgetting)
        if percept.action is not None:
            for previous, next_, weight in zip(*(part.tolist() for part in belief.pairwise), strict=True):
                self._map.transitions.learn(previous, percept.action, next_, weight)
        self._visit(Whereabouts(belief.places), percept.readings, belief.certainty, step=step)

    def catch_up(self, window: Sequence[Slice], pending: int, *, step: int) -> None:
        """Learn what was walked in the `pending` steps before the last, where the smoothed window is certain of it."""
        waiting = window[-1 - pending : -1]
        steps = [slice_.step for slice_ in waiting if slice_ is not window[0]]
        graph = window_graph(self._map, window)
        moved = "moved" if self._map.displacement else ""
        walks = {t: [f"{name}{t - back}" for name, back in (("s", 0), ("s", 1), (moved, 0)) if name] for t in steps}
        posterior = infer(graph, pairs=list(walks.values()), engine=self._settings.engine)
        for slice_ in waiting:
            q = posterior.marginal(f"s{slice_.step}")
            if q.max() >= self._settings.certainty:
                ranked = np.argsort(-q, kind="stable")
                belief = Whereabouts(dict(zip(slice_.places[ranked].tolist(), q[ranked].tolist(), strict=True)))
                self._visit(belief, slice_.percept.readings, float(q.max()), step=step)
        at = {slice_.step: slice_ for slice_ in window}
        for t in steps:
            walked = posterior.joint(*walks[t])
            walked = walked[:, :, 0] if walked.ndim > 2 else walked
            i, j = divmod(int(walked.argmax()), walked.shape[1])
            if walked[i, j] >= self._settings.certainty:
                previous, next_ = int(at[t - 1].places[j]), int(at[t].places[i])
                self._map.transitions.learn(previous, at[t].percept.action or 0, next_, float(walked[i, j]))

    def _visit(self, belief: Whereabouts, readings: Mapping[str, Any], weight: float, *, step: int) -> None:
        """The agent is (or was) in the most probable place of `belief`: what is sensed there, and what lies beyond.

        Only the place that passed the gate learns: the prior of A_o is so small that even a hundredth of a count
        would fix the sight of a place where the agent never was.
        """
        self._map.mark_visited(belief.place)
        passable = Percept(readings=readings).passable
        open_ = (True,) * len(self._map.motions) if passable is None else passable  # what nothing senses may be open
        self._map.recall(self._growth.look(self._map, belief, open_, step=step))
        self._map.learn(belief.place, readings, weight)

    def relive(self, moments: Sequence[Moment], position: Position, *, step: int) -> tuple[int, Moment]:
        """Take back what was taught in these last steps, and teach it along the way that ends at `position`.

        Returns:
            The place there, and the present step anew. What that has to teach is left to `learn`.
        """
        happened = [moment.percept for moment in moments]
        self._map.take_back(moments[0].mark, step=step)
        present = self.moment(step, happened[-1])
        place = self._place_at(self._way_back(happened, position), step=step)
        for now, then in pairwise(happened):
            self._visit(Whereabouts({place: 1.0}), now.readings, 1.0, step=step)
            place = self._walk(place, then, step=step)
        return place, present

    def _walk(self, place: int, then: Percept, *, step: int) -> int:
        """Where the action of `then` led from `place`."""
        action = then.action or 0
        if action == self._map.motions.stay or not then.opened:
            return place
        self.enter(Whereabouts({place: 1.0}), action, step=step)
        there = self._map.beyond(place, action)
        assert there is not None  # an open door was just looked at, or entered
        self._map.transitions.learn(place, action, there, 1.0)
        return there

    def _place_at(self, position: Position, *, step: int) -> int:
        place = self._map.place_at(position)
        return self._map.new_place(position, step=step) if place is None else place

    def _way_back(self, happened: Sequence[Percept], position: Position) -> Position:
        """Where the walk began that ended at `position`."""
        motions = self._map.motions
        for percept in happened[:0:-1]:
            if percept.opened:
                position = motions.move(position, motions.inverse[percept.action or 0])
        return position
