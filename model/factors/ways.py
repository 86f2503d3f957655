"""P(c | s): which ways are sensed open; learned as transitions are."""

from __future__ import annotations

from collections.abc import Sequence
from math import log
from typing import Any

import numpy as np

from ..errors import CogmapError
from .base import Context, Floats, Ints
from .sensor import Sensor
from .transition import BLOCKED, OPEN, UNKNOWN, Transition


class Ways(Sensor):
    """Senses of each action whether its way is open: `open` in observations, one truth value an action.

    c(s) = product over the actions of P(blocked | s, a), or one minus it; P(blocked | s, a) is B_s[s, s, a].
    """

    kind = "walls"

    def __init__(self) -> None:
        super().__init__("open")
        self.symbol = self.variable = "c"

    @property
    def options(self) -> dict[str, Any]:
        """None."""
        return {}

    def join(self, context: Context, transitions: Transition) -> None:
        """Make it part of a model; what is sensed of its ways is learned by its transitions."""
        super().join(context, transitions)
        self._transitions, self._motions, self._rates = transitions, context.motions, context.rates

    def check(self, value: Any) -> tuple[bool, ...]:
        """One truth value an action; staying is always open."""
        try:
            doors = np.asarray(value)
        except ValueError as error:
            raise CogmapError(
                "observation: 'open' holds lists of different lengths; give one truth value an action"
            ) from error
        if doors.shape != (len(self._motions),):
            names = ", ".join(self._motions.names)
            raise CogmapError(f"observation: 'open' has shape {doors.shape}; give one truth value an action: {names}")
        if doors.dtype != np.bool_ and not (np.issubdtype(doors.dtype, np.integer) and set(doors.tolist()) <= {0, 1}):
            raise CogmapError(f"observation: 'open' holds {doors.dtype}; give truth values")
        return tuple(bool(is_open) or action == self._motions.stay for action, is_open in enumerate(doors.tolist()))

    def log_likelihood(self, places: Ints, reading: Sequence[bool]) -> Floats:
        """`[n]` log P(doors as sensed | s)."""
        return np.log(self._each(places, reading)).sum(axis=1)

    def likelihood(self, places: Ints, reading: Sequence[bool]) -> Floats:
        """`[n]` P(doors as sensed | s)."""
        return np.multiply.reduce(self._each(places, reading), axis=1)

    def _each(self, places: Ints, reading: Sequence[bool]) -> Floats:
        """`[n, K]` of each door by itself."""
        p = self._transitions.blocked(places)
        np.subtract(1.0, p, out=p, where=np.array(reading, dtype=np.bool_))
        p[:, self._motions.stay] = 1.0
        return p

    def log_predictive(self, reading: Sequence[bool]) -> float:
        """A way is as likely open as not."""
        return (len(self._motions) - 1) * log(0.5)

    def learn(self, place: int, reading: Sequence[bool | None], weight: float) -> None:
        """What is sensed of the doors of `place`.

        Each look leaves the counts of one look at least, and takes the contrary away: many looks say no more than one,
        and what has faded comes back. The other side of a door learns of it when it changes.
        """
        for action, is_open in enumerate(reading):
            if action == self._motions.stay or is_open is None:
                continue
            before = int(self._transitions.sensed.values[place, action])
            if before == (OPEN if is_open else BLOCKED) and self._settled(place, action, weight, is_open=is_open):
                continue
            if is_open:
                self._open(place, action, weight, before)
            else:
                self._transitions.shut(place, action, weight, changed=before != BLOCKED)

    def recall(self, place: int) -> None:
        """Teach a new place what its neighbours' doors have shown of it already: those that are blocked."""
        ways = self._transitions
        for action, inverse in enumerate(self._motions.inverse):
            neighbour = ways.beyond(place, action)
            if neighbour is not None and ways.sensed.values[neighbour, inverse] == BLOCKED:
                ways.add(place, place, action, -self._rates.impossible[1])

    def _settled(self, place: int, action: int, weight: float, *, is_open: bool) -> bool:
        """Whether the counts of a door say what is seen already, and nothing else."""
        counts = self._transitions.table.counts(self._transitions.row(place, action))
        blocked = counts.pop(place, 0.0)
        if is_open:
            return blocked == 0.0 and sum(counts.values()) >= weight * self._rates.imagined[0]
        return blocked >= -weight * self._rates.impossible[0] and not any(counts.values())

    def _open(self, place: int, action: int, weight: float, before: int) -> None:
        ways = self._transitions
        beyond, inverse = ways.beyond(place, action), self._motions.inverse[action]
        forward, reverse = self._rates.impossible
        ways.add(place, place, action, weight * forward)
        if before == BLOCKED and beyond is not None:
            ways.add(beyond, beyond, inverse, weight * reverse)
        if beyond is None:  # nothing to imagine there (yet): the door is forgotten, as in observed growth
            ways.sensed.set((place, action), UNKNOWN)
            return
        forward, reverse = self._rates.imagined
        ways.raise_to(beyond, place, action, weight * forward)
        if before != OPEN:
            ways.raise_to(place, beyond, inverse, weight * reverse)
        ways.sensed.set((place, action), OPEN)
