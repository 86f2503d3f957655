"""Teaches the map what the agent is certain of, and lets it grow."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from ..inference import infer
from ..inference.message import Belief, Evidence
from ..model.changes import STEPS
from ..model.cognitive_map import CognitiveMap
from ..model.growth import growth_named
from ..model.learning import Learner
from ..model.motions import Motions, Position
from ..model.slices import Slice, window_graph
from .settings import Settings


@dataclass(frozen=True, slots=True)
class Moment:
    """A time step that can be taken back.

    Attributes:
        step: the time step.
        mark: of the log of changes, before anything was learned from it.
        visits: number of visited places then.
        evidence: what it brought.
    """

    step: int
    mark: int
    visits: int
    evidence: Evidence


class Mapper:
    """Learning and growth of one map, under one set of settings.

    Attributes:
        learner: teaches the map.
        recent: the steps that can be taken back.
    """

    def __init__(self, map_: CognitiveMap, settings: Settings) -> None:
        self._map = map_
        self._settings = settings
        self._growth = growth_named(settings.growth)
        self.learner = Learner(map_, settings.rates)
        self.recent: deque[Moment] = deque(maxlen=STEPS)

    def wake(self) -> None:
        """The places that exist before anything was seen."""
        self._growth.begin(self._map, places=self._settings.places, step=0)

    def begin(self, step: int, evidence: Evidence) -> None:
        """A time step begins, with this evidence."""
        self.recent.append(Moment(step, self._map.changes.mark(), len(self._map.visited_places), evidence))

    @property
    def remembered(self) -> int:
        """The first time step that can be taken back."""
        return self.recent[0].step

    @property
    def visits_before(self) -> int:
        """How many places were visited before this time step."""
        return self.recent[-1].visits

    def relive(self, since: int, position: Position, *, step: int) -> int:
        """Take back what was taught from time step `since` on, and teach it along the way that ends at `position`.

        Returns:
            The place there. What the present step has to teach is left to `learn`.
        """
        moments = [moment for moment in self.recent if moment.step >= since]
        happened = [moment.evidence for moment in moments]
        self._map.take_back(moments[0].mark, step=step)
        self.recent.pop()
        self.begin(step, happened[-1])
        place = self._place_at(_way_back(self._map.motions, happened, position), step=step)
        for now, then in pairwise(happened):
            self._visit(place, now.sight, now.open, 1.0, step=step)
            place = self._walk(place, then, step=step)
        return place

    def _walk(self, place: int, then: Evidence, *, step: int) -> int:
        """Where the action of `then` led from `place`."""
        action = then.action or 0
        if action == self._map.motions.stay or not then.was_open:
            return place
        self.enter(place, action, step=step)
        there = self._map.beyond(place, action)
        assert there is not None  # an open door was just looked at, or entered
        self.learner.transition(place, action, there, 1.0)
        return there

    def _place_at(self, position: Position, *, step: int) -> int:
        place = self._map.place_at(position)
        return self._map.new_place(position, step=step) if place is None else place

    def enter(self, place: int, action: int, *, step: int) -> None:
        """Before inference: the agent took a door of `place` that was open."""
        self._recall(self._growth.enter(self._map, place, action, step=step))

    def learn(self, belief: Belief, evidence: Evidence, *, step: int) -> None:
        """What a certain belief teaches: transitions, sight, position, doors, and the places behind them."""
        if self._settings.forgetting:
            self.learner.forget(1.0 - self._settings.forgetting)
        if evidence.action is not None:
            for previous, next_, weight in zip(*(part.tolist() for part in belief.walks), strict=True):
                self.learner.transition(previous, evidence.action, next_, weight)
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
                self.learner.transition(previous, at[t].action or 0, next_, float(walked[i, j]))

    def _visit(self, place: int, sight: int, open_: Sequence[bool], weight: float, *, step: int) -> None:
        """The agent is (or was) in `place`: its sight, position and doors, and what lies behind them.

        Only the place that passed the gate learns: the prior of A_o is so small that even a hundredth of a count
        would fix the sight of a place where the agent never was.
        """
        self._map.mark_visited(place)
        self.learner.sight(place, sight, weight)
        self.learner.position(place, int(self._map.position_index[place]), weight)
        self._recall(self._growth.look(self._map, place, open_, step=step))
        self.learner.doors(place, open_, weight)

    def _recall(self, places: Sequence[int]) -> None:
        for place in places:
            self.learner.recall(place)


def _way_back(motions: Motions, happened: Sequence[Evidence], position: Position) -> Position:
    """Where the walk began that ended at `position`."""
    for evidence in happened[:0:-1]:
        if evidence.was_open:
            position = motions.move(position, motions.inverse[evidence.action or 0])
    return position
