"""P(c | s): which ways are sensed open; learned as transitions are."""

from collections.abc import Collection, Sequence
from math import log
from typing import Any

import numpy as np

from ..unseen import UNSEEN
from .base import Context, Floats, Ints
from .readings import WayReading, checked_ways
from .sensor import Sensor
from .transition import BLOCKED, ELSEWHERE, OPEN, UNKNOWN, Transition

Looks = Sequence[WayReading]  # A reading an action

FEW_WAYS = 8
"""Ways up to which all of a list are thought of."""


class Ways(Sensor):
    """A sensor of whether the way of each action is open: `open` in observations.

    That is one reading an action, in a list, an array (masked where not looked at) or a mapping by name: true, false,
    P(open), or None where it was not looked at.

    Args:
        learned: whether a way of a place never entered is as often open as that action was in the others; else it is
            as likely open as not, however many ways a place may have.

    c(s) = product over the actions of P(blocked | s, a), or one minus it; P(blocked | s, a) is B_s[s, s, a].
    """

    kind = "walls"

    def __init__(self, *, learned: bool = False) -> None:
        super().__init__("open")
        self.symbol = self.variable = "c"
        self._learned = learned

    @property
    def options(self) -> dict[str, Any]:
        return {"learned": True} if self._learned else {}

    def join(self, context: Context, transitions: Transition) -> None:
        """Make it part of a model; what is sensed of its ways is learned by its transitions."""
        super().join(context, transitions)
        self._transitions, self._motions, self._rates = transitions, context.motions, context.rates

    def check(self, value: Any) -> Any:
        """A reading an action, staying always open; `UNSEEN` where no way was looked at."""
        ways = checked_ways(value, self._motions)
        return UNSEEN if ways is None else ways

    def log_likelihood(self, places: Ints, reading: Looks) -> Floats:
        return np.log(self._each(places, reading)).sum(axis=1)

    def likelihood(self, places: Ints, reading: Looks) -> Floats:
        return np.multiply.reduce(self._each(places, reading), axis=1)

    def _told(self, reading: Looks) -> tuple[Ints, Floats]:
        """The actions whose ways tell places apart, and the reading of each: those that were looked at.

        Of a long list only those that were ever read as anything but blocked: the others are the same everywhere, and
        each that was weighed would have a place never entered be half as probable.
        """
        read = np.array(reading, dtype=np.float64)  # NaN of None
        told = ~np.isnan(read)
        told[self._motions.stay] = False
        if len(read) > FEW_WAYS + 1:
            known = self.context.visits.order.values
            told &= (read > 0.0) | (self._transitions.sensed.values[known] != BLOCKED).any(axis=0)
        actions = np.flatnonzero(told)
        return actions, read[actions]

    def _each(self, places: Ints, reading: Looks) -> Floats:
        """`[n, k]` of each door that tells something: r P(open) + (1 - r) P(blocked)."""
        actions, read = self._told(reading)
        p = self._transitions.blocked(places, actions)
        if self._learned:
            p[~self.context.visits.visited.values[places]] = self._blocked()[actions]
        return read * (1.0 - p) + (1.0 - read) * p

    def _blocked(self) -> Floats:
        """`[K]` how often each action was found blocked in a new place."""
        sensed = self._transitions.sensed.values[self.context.visits.order.values]
        blocked, opened = (sensed == BLOCKED).sum(axis=0), (sensed == OPEN).sum(axis=0)
        return (blocked + 0.5) / (blocked + opened + 1.0)

    def log_predictive(self, reading: Looks) -> float:
        """A way is as likely open as not, or as often as it was."""
        actions, read = self._told(reading)
        if not self._learned:
            return len(actions) * log(0.5)
        p = self._blocked()[actions]
        return float(np.log(np.where(read < 0.5, p, 1.0 - p)).sum())

    def learn(self, place: int, reading: Looks, weight: float, *, one_way: Collection[int] = ()) -> None:
        """What is sensed of the doors of `place`; those of the actions `one_way` say nothing of their other side.

        Each look leaves the counts of one look at least, and takes the contrary away: many looks say no more than one,
        and what has faded comes back. The other side of a door learns of it when it changes. A look that is not sure
        leaves the counts of one look, shared by what is then believed.
        """
        shut, others = self._news(place, reading, weight)
        if len(shut):
            self._transitions.shut_all(place, shut, weight)
        for action in others.tolist():
            way, before = reading[action], int(self._transitions.sensed.values[place, action])
            if way is not None and 0.0 < way < 1.0:
                self._weigh(place, action, weight, way)
            elif way:
                self._open(place, action, weight, before, both=action not in one_way)
            else:
                changed = before != BLOCKED and action not in one_way
                self._transitions.shut(place, action, weight, changed=changed)

    def _news(self, place: int, reading: Looks, weight: float) -> tuple[Ints, Ints]:
        """The actions whose counts do not say yet what is read: those shut that lead to no known place, and others."""
        ways, read = self._transitions, np.array(reading, dtype=np.float64)
        read[self._motions.stay] = np.nan
        keys, _, counts = ways.table.slots(ways.rows(np.array([place])))
        here, sensed = keys == place, ways.sensed.values[place]
        stays, leads = np.where(here, counts, 0.0).sum(axis=1), np.where(here, 0.0, counts).sum(axis=1)
        shut = (sensed == BLOCKED) & (stays >= -weight * self._rates.impossible[0]) & (leads == 0.0)
        open_ = (sensed == OPEN) & (stays == 0.0) & (leads >= weight * self._rates.imagined[0])
        news = ~np.isnan(read) & ~np.where(read == 0.0, shut, (read == 1.0) & open_)
        alone = news & (read == 0.0) & ~((keys >= 0) & ~here).any(axis=1)
        return np.flatnonzero(alone), np.flatnonzero(news & ~alone)

    def _weigh(self, place: int, action: int, weight: float, way: float) -> None:
        """Share the counts of one look between open and blocked, as is believed after a reading P(open) = `way`."""
        ways = self._transitions
        blocked = ways.blocked(np.array([place]))[0, action]
        is_open = way * (1.0 - blocked) / (way * (1.0 - blocked) + (1.0 - way) * blocked)
        beyond, counts = ways.beyond(place, action), self._rates.imagined[0] * weight
        ways.level(place, place, action, counts * (1.0 - is_open))
        ways.level(ELSEWHERE if beyond is None else beyond, place, action, counts * is_open)
        ways.sensed.set((place, action), BLOCKED if is_open < 0.5 else UNKNOWN if beyond is None else OPEN)

    def recall(self, place: int) -> None:
        """Teach a new place what its neighbours' doors have shown of it already: those that are blocked."""
        ways = self._transitions
        keys = ways.table.keys(ways.rows(np.array([place])))
        for action in np.flatnonzero(((keys >= 0) & (keys != place)).any(axis=1)).tolist():
            inverse, neighbour = self._motions.inverse[action], ways.beyond(place, action)
            if inverse >= 0 and neighbour is not None and ways.sensed.values[neighbour, inverse] == BLOCKED:
                ways.add(place, place, action, -self._rates.impossible[1])

    def _open(self, place: int, action: int, weight: float, before: int, *, both: bool) -> None:
        ways = self._transitions
        beyond, inverse = ways.beyond(place, action), self._motions.inverse[action] if both else -1
        forward, reverse = self._rates.impossible
        ways.add(place, place, action, weight * forward)
        if before == BLOCKED and beyond is not None and inverse >= 0:
            ways.add(beyond, beyond, inverse, weight * reverse)
        if beyond is None:  # nothing to imagine there (yet): the door is forgotten, as in observed growth
            ways.sensed.set((place, action), UNKNOWN)
            return
        forward, reverse = self._rates.imagined
        ways.raise_to(beyond, place, action, weight * forward)
        if before != OPEN and inverse >= 0:  # else nobody knows what leads back
            ways.raise_to(place, beyond, inverse, weight * reverse)
        ways.sensed.set((place, action), OPEN)
