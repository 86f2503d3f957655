"""The short way of a step that leaves no doubt: one branch, where bounds show that no other can survive."""

from math import exp, inf, log

from .branches import Alternative, Lead, Walker, leads, look_alikes
from .evidence import log_predictive, new_sight_probability, readings_probability, sight_probability
from .hypothesis import Hypothesis
from .records import NOWHERE
from .scheme import Sensed

LEAST = 1e-300


def calm_branches(h: Hypothesis, sensed: Sensed, *, drop: float) -> list[Alternative]:
    """What has happened, if every alternative but those `apart` is less probable by `drop` nats or more.

    It is followed by those that are apart from it only, as far as they are within `drop`; nothing if it is not sure.
    """
    if sensed.told:
        return []
    return _Calm(h, sensed).alone(drop)


class _Calm:
    """The expected branch of one hypothesis, and bounds of the others: ways are taken to fit as well as any can."""

    def __init__(self, h: Hypothesis, sensed: Sensed) -> None:
        self.h, self.sensed, self.chances = h, sensed, h.chances
        self.walker = Walker(h, sensed)
        self.ways = self._best_ways()
        self.best = self._best()
        self.astray = self.walker.astray
        self.stayed = h.weight + log(1.0 - h.chances.moved)
        self.put_there = h.weight + self.walker.put_there
        self.new: float | None = None

    def alone(self, drop: float) -> list[Alternative]:
        action = self.sensed.action
        lead = None if action is None else leads(self.h, self.h.here, self.walker.place, action)
        main = self._main(lead)
        floor = main.weight - drop
        if not (self._others_fail(main, lead, floor) and self._astray_fails(main, floor)):
            return []
        if not self._moved_fails(main, floor):
            return []
        return [main, *(branch for branch in self._apart(main, lead) if branch.weight > floor)]

    def _apart(self, main: Alternative, lead: Lead | None) -> list[Alternative]:
        """The branches that are apart from the main one, where that founds a new place."""
        if not main.charted or lead is None or self.sensed.action is None:
            return []
        action = self.sensed.action
        before = self.stayed + log(1.0 - self.astray) + log(self.walker.open(action)) + self.sensed.of_taking(action)
        found = [self.walker.put_elsewhere()]
        if lead.off > 0.0:
            found.append(self.walker.off(action, lead, before + log(1.0 - self.walker.fails), 0.0))
        return found

    def _main(self, lead: Lead | None) -> Alternative:
        h, action, walker = self.h, self.sensed.action, self.walker
        if action is None or lead is None or walker.open(action) < 0.5:
            staying = walker.stay(self.stayed)
            assert staying is not None  # its floor is below everything
            return staying
        before = self.stayed + log(1.0 - self.astray) + log(walker.open(action) * (1.0 - walker.fails))
        before += self.sensed.of_taking(action)
        if lead.to != NOWHERE:
            return walker.along(action, lead, before, 0.0)
        back = None if h.scheme.inverse is None else h.scheme.inverse[action]
        key = h.beyond(walker.place, action)
        weight = before + log(lead.new) + log_predictive(h, self.sensed, key, back, h.here)
        return Alternative(weight, h, action, NOWHERE, True, 0.0, 0.0, 0.0)

    def _others_fail(self, main: Alternative, lead: Lead | None, floor: float) -> bool:
        """Staying (or, for a move that fails, walking), and the same way leading elsewhere."""
        h, action = self.h, self.sensed.action
        if action is None or lead is None:
            return True
        given = 1.0 - self.astray
        ahead = self.stayed + log(given)
        if main.to == h.here and main.way == NOWHERE:
            ahead += log(self.walker.open(action))
            if lead.to != NOWHERE and ahead + log(lead.sure + exp(self.put_there - ahead)) + self._at(lead.to) > floor:
                return False
            left = lead.new + lead.off
        else:
            stays = given * (1.0 - self.walker.open(action) * (1.0 - self.walker.fails)) + self.astray
            if log(stays * exp(self.stayed) + exp(self.put_there)) + self._at(h.here) > floor:
                return False
            left = 0.0 if main.charted else lead.new + lead.off
        return left <= 0.0 or ahead + log(left) + self._new() <= floor

    def _astray_fails(self, main: Alternative, floor: float) -> bool:
        h, action = self.h, self.sensed.action
        if not self.astray:
            return True
        if log(self.astray * exp(self.stayed) + exp(self.put_there)) + self.best <= floor:
            return True
        for way in h.awake:
            if way == action:
                continue
            each = log(self.walker.each(way)) + self.stayed
            lead = leads(h, h.here, self.walker.place, way)
            if lead.to != NOWHERE and log(exp(each) + exp(self.put_there)) + self._at(lead.to) > floor:
                return False
            left = lead.new + lead.off
            if left > 0.0 and each + log(left * self.walker.open(way)) + self._new() > floor:
                return False
        return True

    def _moved_fails(self, main: Alternative, floor: float) -> bool:
        if not main.charted and self.put_there + log(self.walker.unseen) + self._new() > floor:
            return False
        if self.put_there + self.best <= floor:
            return True
        return all(
            self.put_there + self._at(number) <= floor
            for number in look_alikes(self.h, self.sensed)
            if number not in (main.to, self.h.here)
        )

    def _at(self, number: int) -> float:
        """At most log P(sensed | that place)."""
        total, place, others = self.ways, self.h.places[number], self.sensed.others
        for sensor, reading in enumerate(self.sensed.sights):
            if reading is not None:
                total += log(max(sight_probability(self.chances, sensor, place.sights[sensor], reading), LEAST))
        return total if others is None else total + others(number)

    def _new(self) -> float:
        """At most log P(sensed | a place never seen)."""
        if self.new is None:
            self.new = self._best_new()
        return self.new

    def _best(self) -> float:
        """At most log P(sensed | any place)."""
        if self.sensed.others is not None:
            return inf
        read = zip(self.chances.right, self.sensed.sights, strict=True)
        return self.ways + sum([log(right) for right, reading in read if reading is not None])

    def _best_new(self) -> float:
        total, others = self.ways, self.sensed.others
        for sensor, reading in enumerate(self.sensed.sights):
            if reading is not None:
                total += log(max(new_sight_probability(self.h, sensor, reading), LEAST))
        return total if others is None else total + others(None)

    def _best_ways(self) -> float:
        looks = [look for way in self.h.awake if (look := self.sensed.ways[way]) is not None]
        return log(readings_probability(self.chances, [(1.0, max(look, 1.0 - look)) for look in looks]))
