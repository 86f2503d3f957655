"""Dirichlet updates of A_o, A_p and B_s, weighted by posteriors (appendix, table of transition learning rates)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from .cognitive_map import BLOCKED, OPEN, UNKNOWN, CognitiveMap


@dataclass(frozen=True, slots=True)
class Rates:
    """Counts that one piece of evidence adds; each pair is (forward, reverse).

    Attributes:
        possible: a transition that was walked.
        impossible: a way that was found blocked; negative, taken from the transition, and added to staying.
        imagined: a transition behind a door that was sensed open.
        likelihood: a sight or position met in a place.
        ceiling: counts of one transition at most, however often it was walked: what one look at a closed door takes
            away (ours; docs/decisions).
    """

    possible: tuple[float, float] = (7.0, 5.0)
    impossible: tuple[float, float] = (-7.0, -5.0)
    imagined: tuple[float, float] = (5.0, 3.0)
    likelihood: float = 1.0
    ceiling: float = 7.0


TABLE_RATES = Rates()
"""The paper's table."""

TEXT_RATES = Rates(possible=(10.0, 7.0), impossible=(-10.0, -7.0), ceiling=10.0)
"""The paper's running text, which differs from its table."""


class Learner:
    """Teaches a map.

    Attributes:
        map: the map.
        rates: counts a piece of evidence.
    """

    __slots__ = ("map", "rates")

    def __init__(self, map_: CognitiveMap, rates: Rates) -> None:
        self.map = map_
        self.rates = rates

    def sight(self, place: int, sight: int, weight: float) -> None:
        """`A_o[sight, place]` gains `weight` times the rate."""
        self.map.A_o.add(place, sight, weight * self.rates.likelihood)

    def position(self, place: int, position: int, weight: float) -> None:
        """`A_p[position, place]` gains `weight` times the rate."""
        self.map.A_p.add(place, position, weight * self.rates.likelihood)

    def transition(self, previous: int, action: int, next_: int, weight: float) -> None:
        """A walked transition, weighted by its pairwise posterior; one that went nowhere was blocked (eq. B_up)."""
        if action == self.map.motions.stay:
            return
        if previous == next_:
            self._shut(previous, action, weight, changed=True)
            return
        forward, reverse = self.rates.possible
        self._add(next_, previous, action, weight * forward)
        self._add(previous, next_, self.map.motions.inverse[action], weight * reverse)
        if weight > 0.5:
            self._note_door(previous, action, int(self.map.sensed[previous, action]), walked=True)

    def doors(self, place: int, open_: Sequence[bool], weight: float) -> None:
        """What is sensed of the doors of `place`.

        Each look leaves the counts of one look at least, and takes the contrary away: many looks say no more than one,
        and what has faded comes back. The other side of a door learns of it when it changes.
        """
        for action, is_open in enumerate(open_):
            if action == self.map.motions.stay:
                continue
            before = int(self.map.sensed[place, action])
            if before == (OPEN if is_open else BLOCKED) and self._settled(place, action, weight, is_open=is_open):
                continue
            if not is_open:
                self._shut(place, action, weight, changed=before != BLOCKED)
            else:
                self._open(place, action, weight, before)

    def _settled(self, place: int, action: int, weight: float, *, is_open: bool) -> bool:
        """Whether the counts of a door say what is seen already, and nothing else."""
        counts = self.map.B_s.counts(self.map.row(place, action))
        blocked = counts.pop(place, 0.0)
        if is_open:
            return blocked == 0.0 and sum(counts.values()) >= weight * self.rates.imagined[0]
        return blocked >= -weight * self.rates.impossible[0] and not any(counts.values())

    def recall(self, place: int) -> None:
        """Teach a new place what its neighbours' doors have shown of it already: those that are blocked."""
        for action, inverse in enumerate(self.map.motions.inverse):
            neighbour = self.map.beyond(place, action)
            if neighbour is not None and self.map.sensed[neighbour, inverse] == BLOCKED:
                self._add(place, place, action, -self.rates.impossible[1])

    def forget(self, keep: float) -> None:
        """Let all evidence for transitions fade by the factor `keep`."""
        self.map.B_s.fade(keep)

    def _open(self, place: int, action: int, weight: float, before: int) -> None:
        beyond, inverse = self.map.beyond(place, action), self.map.motions.inverse[action]
        forward, reverse = self.rates.impossible
        self._add(place, place, action, weight * forward)
        if before == BLOCKED and beyond is not None:
            self._add(beyond, beyond, inverse, weight * reverse)
        if beyond is None:  # nothing to imagine there (yet): the door is forgotten, as in observed growth
            self._note_door(place, action, UNKNOWN)
            return
        forward, reverse = self.rates.imagined
        self._raise(beyond, place, action, weight * forward)
        if before != OPEN:
            self._raise(place, beyond, inverse, weight * reverse)
        self._note_door(place, action, OPEN)

    def _shut(self, place: int, action: int, weight: float, *, changed: bool) -> None:
        forward, reverse = self.rates.impossible
        self._raise(place, place, action, -weight * forward)
        self._note_door(place, action, BLOCKED)
        beyond = self.map.beyond(place, action)
        if beyond is None:
            return
        self._add(beyond, place, action, weight * forward)
        if changed:
            inverse = self.map.motions.inverse[action]
            self._raise(beyond, beyond, inverse, -weight * reverse)
            self._add(place, beyond, inverse, weight * reverse)

    def _raise(self, next_: int, previous: int, action: int, level: float) -> None:
        """Counts of `level` at least."""
        self._add(
            next_, previous, action, max(level - self.map.B_s.evidence(self.map.row(previous, action), next_), 0.0)
        )

    def _add(self, next_: int, previous: int, action: int, amount: float) -> None:
        self.map.B_s.add(self.map.row(previous, action), next_, amount, most=self.rates.ceiling)

    def _note_door(self, place: int, action: int, sensed: int, *, walked: bool = False) -> None:
        self.map.note_door(place, action, sensed, walked=walked)
