"""Teaches the map what the agent is certain of, and lets it grow."""

from __future__ import annotations

from collections.abc import Sequence

from ..inference.message import Belief, Evidence
from ..inference.query import infer
from ..model.cognitive_map import CognitiveMap
from ..model.growth import growth_named
from ..model.learning import Learner, Lesson
from ..model.slices import Slice, window_graph
from .settings import Settings


class Mapper:
    """Learning and growth of one map, under one set of settings."""

    def __init__(self, map_: CognitiveMap, settings: Settings) -> None:
        self._map = map_
        self._settings = settings
        self._growth = growth_named(settings.growth)
        self._learner = Learner(map_, settings.rates)

    def begin(self) -> None:
        """The places that exist before anything was seen."""
        self._growth.begin(self._map, places=self._settings.places, step=0)

    def take_lessons(self) -> tuple[Lesson, ...]:
        """Which counts changed since the last call."""
        return self._learner.take_lessons()

    def enter(self, place: int, action: int, *, step: int) -> None:
        """Before inference: the agent took a door of `place` that was open."""
        self._recall(self._growth.enter(self._map, place, action, step=step))

    def learn(self, belief: Belief, evidence: Evidence, *, step: int) -> None:
        """What a certain belief teaches: transitions, sight, position, doors, and the places behind them."""
        if self._settings.forgetting:
            self._learner.forget(1.0 - self._settings.forgetting)
        if evidence.action is not None:
            for previous, next_, weight in zip(*(part.tolist() for part in belief.walks), strict=True):
                self._learner.transition(previous, evidence.action, next_, weight)
        self._visit(belief.place, evidence.sight, evidence.open, belief.certainty, step=step)

    def catch_up(self, window: Sequence[Slice], pending: int, *, step: int) -> None:
        """Learn what was walked in the `pending` steps before the last, where the smoothed window is certain of it."""
        waiting = window[-1 - pending : -1]
        steps = [slice_.step for slice_ in waiting if slice_ is not window[0]]
        walks = [(f"s{t}", f"s{t - 1}", f"moved{t}") for t in steps]
        posterior = infer(window_graph(self._map, window), pairs=walks, engine=self._settings.engine)
        for slice_ in waiting:
            q = posterior.marginal(f"s{slice_.step}")
            if q.max() < self._settings.certainty:
                continue
            place, weight = int(slice_.places[q.argmax()]), float(q.max())
            self._visit(place, self._map.sights.index(slice_.sight), slice_.open, weight, step=step)
        at = {slice_.step: slice_ for slice_ in window}
        for t in steps:
            walked = posterior.joint(f"s{t}", f"s{t - 1}", f"moved{t}")[:, :, 0]
            i, j = divmod(int(walked.argmax()), walked.shape[1])
            if walked[i, j] >= self._settings.certainty:
                previous, next_ = int(at[t - 1].places[j]), int(at[t].places[i])
                self._learner.transition(previous, at[t].action or 0, next_, float(walked[i, j]))

    def _visit(self, place: int, sight: int, open_: Sequence[bool], weight: float, *, step: int) -> None:
        """The agent is (or was) in `place`: its sight, position and doors, and what lies behind them.

        Only the place that passed the gate learns: the prior of A_o is so small that even a hundredth of a count
        would fix the sight of a place where the agent never was.
        """
        self._map.mark_visited(place)
        self._learner.sight(place, sight, weight)
        self._learner.position(place, int(self._map.position_index[place]), weight)
        self._recall(self._growth.look(self._map, place, open_, step=step))
        self._learner.doors(place, open_, weight)

    def _recall(self, places: Sequence[int]) -> None:
        for place in places:
            self._learner.recall(place)
