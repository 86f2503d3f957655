"""Which way of a place is which way of another, and what follows where that turns out to be otherwise."""

import numpy as np

from ..base import Floats, Ints
from .base import Growing
from .metric import SPARE, MetricPose
from .odometer import direction
from .relaxing import drift
from .ways_between import ROUGH, between

LONG = 2.5
"""Standard deviations of the logarithm of lengths above the mean up to which a way that was not walked may be long."""

SURELY = 2.0  # standard deviations of a position by which a way may miss it
VAGUE = 35.0  # degrees by which it may miss it at most
RADIAN = float(np.pi / 180.0)  # a degree
TOLD = 0.15  # mean lengths of a way by which it may miss what lies as far ahead as it is told to be long


class Joining:
    """Has the ways of a map lead to places that were entered.

    Args:
        pose: where places lie, and which way their ways lead.
        model: what it is part of.
        step: now.
    """

    def __init__(self, pose: MetricPose, model: Growing, step: int) -> None:
        self._pose, self._model, self._step = pose, model, step

    def join(self, place: int) -> None:
        """Have the ways of a place that was just entered lead to places entered before, and theirs to it."""
        pose, ways = self._pose, self._model.transitions
        entered, here = self._model.visits.order.values, pose.where.values
        others = entered[entered != place]
        apart = np.linalg.norm(here[others] - here[place], axis=1)
        leads = others == pose.source.values[place, 0]  # where it was imagined first
        told = pose.lengths.values[place]
        near = (pose.odometer.log_length(apart) <= LONG) | leads | (apart <= told.max() + TOLD * pose.length)
        others, apart = others[near], apart[near]
        if not len(others):
            return
        miss = self._miss(place, others, apart)
        found = between(here[place], pose.bearings.values[place], here[others], pose.bearings.values[others], miss=miss)
        hidden = pose.hidden() if found else None
        taken, met = set[tuple[int, int]](), set[int]()
        for pair in sorted(found, key=lambda pair: ways.beyond(int(others[pair.other]), pair.back) != place):
            mine, its, far = (place, pair.action), (int(others[pair.other]), pair.back), float(apart[pair.other])
            if its[0] in met or not taken.isdisjoint((mine, its)):  # two places share one way at most
                continue
            rough = None if miss.any() else pair.rough
            if told[pair.action] >= 0.0:
                if abs(told[pair.action] - far) > TOLD * pose.length + float(miss[pair.other]) * RADIAN * far:
                    continue
            elif hidden and not ways.walked.values[its] and hidden.likely(far, rough=rough):
                continue  # each leads to a place between the two that nobody has entered, as was thought
            if self._free(mine, place, far) and self._free(its, place, far):
                taken |= {mine, its}
                met.add(its[0])
                self._link(mine, its[0])
                self._link(its, place)

    def meet(self, place: int) -> None:
        """Have ways that are told how long they are lead to what was imagined there behind ways of others."""
        pose, ways = self._pose, self._model.transitions
        told = pose.lengths.values[place]
        if not (told >= 0.0).any():
            return
        fresh = np.flatnonzero((self._model.visits.first.values < 0) & (pose.source.values[:, 0] >= 0))
        where, met = pose.imagined(fresh), set[int]()
        for action in np.flatnonzero(told >= 0.0).tolist():
            if len(fresh) and ways.beyond(place, action) is None:
                at = pose.where.values[place] + told[action] * direction(pose.bearings.values[place, [action]])[0]
                apart = np.linalg.norm(where - at, axis=1)
                there = int(fresh[apart.argmin()])
                if apart.min() <= TOLD * pose.length and there not in met:
                    met.add(there)
                    ways.lead(place, action, there)

    def _miss(self, place: int, others: Ints, apart: Floats) -> Floats:
        """`[n]` degrees by which ways may miss places since nobody knows for sure where these lie."""
        if not self._pose.odometer.errs and self._pose.odometer.noted.values[0]:
            return np.zeros(len(others))
        spread = drift(self._pose.walked(), place, others, len(self._pose.where))
        return np.minimum(np.rad2deg(np.arctan2(SURELY * spread, np.maximum(apart, 1e-9))), VAGUE)

    def forget(self, place: int | None, source: int, action: int) -> None:
        """What was imagined behind a way that leads elsewhere is nowhere."""
        if place is None or self._model.visits.visited.values[place]:
            return
        if self._pose.source.values[place].tolist() == [source, action]:
            alone = (
                self._pose.lengths.values[source, action] < 0.0
            )  # else ways of others may have been told to lead there
            self._pose.source.set((place, 0), SPARE if alone else -1)

    def returns(self, place: int, action: int, there: int) -> None:
        """The way back from a place entered before is the one that points here, whatever was thought of it."""
        bearings = self._pose.bearings.values
        bearing = float(bearings[place, action])
        if bearing < 0.0:
            return
        apart = np.abs((bearings[there] - bearing) % 360.0 - 180.0)
        apart[bearings[there] < 0.0] = np.inf
        back = int(apart.argmin())
        if apart[back] > ROUGH or self._model.transitions.walked.values[there, back]:
            return
        self._link((there, back), place)

    def _free(self, way: tuple[int, int], place: int, apart: float) -> bool:
        """Whether nobody knows where a way leads, or it leads to `place`, or is only thought to lead further."""
        ways, where = self._model.transitions, self._pose.where.values
        target = ways.beyond(*way)
        if target is None or target == place or not self._model.visits.visited.values[target]:
            return True
        known = ways.walked.values
        if known[way] or any(ways.beyond(target, int(a)) == way[0] for a in np.flatnonzero(known[target])):
            return False
        return float(np.linalg.norm(where[target] - where[way[0]])) > 1.001 * apart

    def _link(self, way: tuple[int, int], to: int) -> None:
        before = self._model.transitions.beyond(*way)
        if before == to:
            return
        self._model.transitions.lead(*way, to)
        self.forget(before, *way)
        if before is not None and self._model.visits.visited.values[before]:
            self._free_back(before, way[0])

    def _free_back(self, place: int, there: int) -> None:
        """A way that was only thought to lead from a place to another leads to nobody knows where."""
        ways = self._model.transitions
        for action in np.flatnonzero(self._pose.bearings.values[place] >= 0.0).tolist():
            if ways.beyond(place, action) == there and not ways.walked.values[place, action]:
                new = self._model.new_place(step=self._step)
                ways.lead(place, action, new)
                self._pose.imagine(new, place, action)
