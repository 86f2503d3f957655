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

    def _each(self, places: Ints, reading: Looks) -> Floats:
        """`[n, K]` of each door by itself: r P(open) + (1 - r) P(blocked); one where it was not looked at."""
        p = self._transitions.blocked(places)
        if self._learned:
            p[~self.context.visits.visited.values[places]] = self._blocked()
        np.subtract(1.0, p, out=p, where=np.array([way == 1 for way in reading]))
        for action, way in enumerate(reading):
            if way is None:
                p[:, action] = 1.0
            elif 0.0 < way < 1.0:
                p[:, action] = way * (1.0 - p[:, action]) + (1.0 - way) * p[:, action]
        p[:, self._motions.stay] = 1.0
        return p

    def _blocked(self) -> Floats:
        """`[K]` how often each action was found blocked in a new place."""
        sensed = self._transitions.sensed.values[self.context.visits.order.values]
        blocked, opened = (sensed == BLOCKED).sum(axis=0), (sensed == OPEN).sum(axis=0)
        return (blocked + 0.5) / (blocked + opened + 1.0)

    def log_predictive(self, reading: Looks) -> float:
        """A way is as likely open as not, or as often as it was."""
        if self._learned:
            p = self._blocked()
            looked = [(p[a] if way < 0.5 else 1.0 - p[a]) for a, way in enumerate(reading) if way is not None]
            return float(np.log(looked).sum() - np.log(1.0 - p[self._motions.stay]))
        return (sum(way is not None for way in reading) - 1) * log(0.5)

    def learn(self, place: int, reading: Looks, weight: float, *, one_way: Collection[int] = ()) -> None:
        """What is sensed of the doors of `place`; those of the actions `one_way` say nothing of their other side.

        Each look leaves the counts of one look at least, and takes the contrary away: many looks say no more than one,
        and what has faded comes back. The other side of a door learns of it when it changes. A look that is not sure
        leaves the counts of one look, shared by what is then believed.
        """
        for action, way in enumerate(reading):
            if action == self._motions.stay or way is None:
                continue
            if 0.0 < way < 1.0:
                self._weigh(place, action, weight, way)
                continue
            is_open = way == 1
            before = int(self._transitions.sensed.values[place, action])
            if before == (OPEN if is_open else BLOCKED) and self._settled(place, action, weight, is_open=is_open):
                continue
            if is_open:
                self._open(place, action, weight, before, both=action not in one_way)
            else:
                changed = before != BLOCKED and action not in one_way
                self._transitions.shut(place, action, weight, changed=changed)

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
        for action, inverse in enumerate(self._motions.inverse):
            neighbour = ways.beyond(place, action)
            if inverse >= 0 and neighbour is not None and ways.sensed.values[neighbour, inverse] == BLOCKED:
                ways.add(place, place, action, -self._rates.impossible[1])

    def _settled(self, place: int, action: int, weight: float, *, is_open: bool) -> bool:
        """Whether the counts of a door say what is seen already, and nothing else."""
        counts = self._transitions.table.counts(self._transitions.row(place, action))
        blocked = counts.pop(place, 0.0)
        if is_open:
            return blocked == 0.0 and sum(counts.values()) >= weight * self._rates.imagined[0]
        return blocked >= -weight * self._rates.impossible[0] and not any(counts.values())

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
