"""Positions in the plane, or in space, by what is measured of each move, and relaxed when loops close."""

from collections.abc import Sequence

import numpy as np

from ...percept import Percept
from ..base import Floats
from ..transition import Transition
from .base import Growing
from .joining import Joining
from .metric import RECENT, UNKNOWN, MetricPose, fill, seen_bearings
from .recognising import NEAR, recognised
from .relaxing import AXES
from .roaming import Roaming
from .ways_between import ROUGH

LEAST = 1e-6
"""P(ways as sensed) of a new place, at least, where it is taken out again."""

STILL = 1e-3  # A move that is shorter than this, in mean lengths of a way, was none
DOUBTED = 4.0  # nats against a place hidden on a way from which on nobody doubts it


class Plane(MetricPose):
    """Positions in the plane, in metres, relative to the start, with uncertain displacements.

    Observations have `displacement`, what was measured of the last move, or `bearings` (see `Bearings`), or both. How
    far measurements err is learned (see `Odometer`). What they say of a loop that closes is more than is needed, and
    positions are those that go best with all of it.

    A way that was never walked leads to an imagined place, in the direction of its bearing and as far as ways are long
    on average; where a place that was entered lies there, and has a way that leads back, the two have one way.
    Where a way that is walked leads to a place that was entered before, that follows from where it lies and from
    what is sensed; so no hypotheses are weighed.
    """

    # -- growing -------------------------------------------------------------------------------------------

    def arrive(self, model: Growing, place: int, percept: Percept, *, step: int) -> None:
        """Before inference: a way was walked; have it lead to the place that lies there and looks like that."""
        action = percept.action
        if action is None or action == model.motions.stay or self.position(place) is None:
            return
        if not (self.bearings.values[place] >= 0.0).any():
            Roaming(self, model, step).arrive(place, percept)
            return
        ways, entered = model.transitions, model.visits.visited.values
        bearing = float(self.bearings.values[place, action])
        move = self.odometer.moved(percept.displacement, bearing)
        if move is None or self._stayed(model, place, percept, move.moved):
            return
        self.odometer.learn_direction(percept.displacement, bearing)
        target = ways.beyond(place, action)
        if ways.walked.values[place, action]:
            self.note(place, action, ways.beyond(place, action), move.raw)
            return
        at = self.where.values[place] + move.moved
        joining = Joining(self, model, step)
        exact = not self.odometer.errs and percept.displacement is not None
        if exact and target is not None and entered[target] and self.apart(target, at) <= NEAR:
            there: int | None = target  # as was thought; if it looks otherwise, the agent was put elsewhere
        else:
            there = recognised(self, model, percept, place, at, move)
            if there is None and (target is None or entered[target]):
                there = model.new_place(step=step)
        if there is not None and there != target:
            ways.lead(place, action, there)
            joining.forget(target, place, action)
        there = target if there is None else there
        assert there is not None
        new = not model.visits.visited.values[there]
        self.note(place, action, there, move.raw, measured=percept.displacement is not None)
        if percept.displacement is not None:
            self.odometer.measure(float(np.linalg.norm(move.moved)))
        self.led = percept, there, self._told_twice(model, there, percept) if new else 1.0
        if new:
            fill(self.where, there, at.tolist())
        else:
            joining.returns(place, action, there)
            self.loop(place, there, at)

    def look(self, model: Growing, place: int, percept: Percept, *, step: int) -> None:
        """The agent is in a place, as far as it is certain, and sees its ways."""
        fill(self.been, place, [*((-1,) * RECENT), *self.steps_in(place), step][-RECENT:])
        if self.where.values[place, 0] >= UNKNOWN:
            first = len(model.visits.order) <= 1
            fill(self.where, place, [0.0] * AXES if first else self.position(place) or [UNKNOWN] * AXES)
        seen = seen_bearings(model, percept)
        if seen is not None and not (self.bearings.values[place] >= 0.0).any():
            fill(self.bearings, place, seen.tolist())
            if percept.lengths is not None:
                fill(self.lengths, place, [-1.0 if each is None else each for each in percept.lengths])
            joining = Joining(self, model, step)
            joining.join(place)
            joining.meet(place)

    def guessed(self, ways: Transition, places: Sequence[int] | None = None) -> Sequence[tuple[int, int, float]]:
        """Ways between places entered, walked in neither direction; doubted if a place may be hidden on them."""
        first = self.context.visits.first.values
        at = self.context.visits.order.values if places is None else np.array(places, dtype=np.int64)
        at = at[(at < len(first)) & (first[np.minimum(at, len(first) - 1)] >= 0)] if len(at) else at
        if not len(at):
            return ()
        targets, walked = ways.targets(at), ways.walked.values
        hidden, found = self.hidden(), list[tuple[int, int, float]]()
        known = (targets >= 0) & (first[targets] >= 0) & (self.bearings.values[at] >= 0.0) & ~walked[at]
        for row, action in np.argwhere(known).tolist():
            place, there = int(at[row]), int(targets[row, action])
            twice = np.count_nonzero(targets[row] == there) > 1  # one of the two leads elsewhere
            if twice or self._beside(place, action):
                found.append((place, action, DOUBTED))
            elif self.lengths.values[place, action] < 0.0 and not self._walked_back(ways, there, place):
                apart = float(np.linalg.norm(self.where.values[there] - self.where.values[place]))
                found.append((place, action, max(hidden.odds(apart, rough=None) + DOUBTED, 0.0)))
        return found

    def _beside(self, place: int, action: int) -> bool:
        """Whether another way leads in nearly the same direction, so that one may be taken for the other."""
        theirs = self.bearings.values[place]
        apart = np.abs((theirs - theirs[action] + 180.0) % 360.0 - 180.0)
        return bool(np.count_nonzero((apart <= 2.0 * ROUGH) & (theirs >= 0.0)) > 1)

    def _walked_back(self, ways: Transition, place: int, to: int) -> bool:
        return any(ways.beyond(place, action) == to for action in np.flatnonzero(ways.walked.values[place]).tolist())

    def _told_twice(self, model: Growing, place: int, percept: Percept) -> float:
        """One over P(ways as sensed | place): bearings that are seen tell already which ways there are."""
        if percept.open is None or "bearings" not in percept.readings:
            return 1.0
        return 1.0 / max(float(model.sensors["open"].likelihood(np.array([place]), percept.open)[0]), LEAST)

    def _stayed(self, model: Growing, place: int, percept: Percept, moved: Floats) -> bool:
        """Whether a move led nowhere; places that look different may have one position."""
        if np.linalg.norm(moved) > STILL * self.length:
            return False
        seen = seen_bearings(model, percept)
        return seen is None or np.array_equal(seen, self.bearings.values[place])
