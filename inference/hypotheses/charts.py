"""Where places are when charts are laid over each other, or close on themselves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ...model import Periods, reduced, with_period
from .hypothesis import Hypothesis, Key
from .records import NOWHERE, Place, Position

Pair = tuple[int, int]


class Charts:
    """The charts of a hypothesis as they would be; the hypothesis is not changed.

    Attributes:
        charted: (frame, position) of the places whose chart has changed.
        periods: of the chart that closes on itself by this, and its frame.
        joined: number of places of a chart that was laid onto another.
    """

    def __init__(self, h: Hypothesis) -> None:
        self.h = h
        self.charted: dict[int, Key] = {}
        self.periods: tuple[int, Periods] | None = None
        self.joined = 0
        self._placed: dict[Key, int] = {}

    def key(self, number: int) -> Key:
        """Frame and position of a place."""
        place = self.h.places[number]
        return self.charted.get(number) or (place.frame, place.position)

    def canonical(self, frame: int, position: Sequence[int]) -> Key:
        """The one key of a position."""
        if self.periods is not None and self.periods[0] == frame:
            return frame, reduced(position, self.periods[1])
        return self.h.canonical(frame, position)

    def ahead(self, number: int, way: int) -> Key | None:
        """The key that a way leads to as far as poses say; None without poses."""
        if self.h.scheme.displacements is None:
            return None
        frame, position = self.key(number)
        step = self.h.scheme.displacements[way]
        return self.canonical(frame, [x + d for x, d in zip(position, step, strict=True)])

    def beside(self, number: int, way: int) -> int:
        """The place that poses say is beyond a way."""
        key = self.ahead(number, way)
        if key is None:
            return NOWHERE
        if len(self._placed) != len(self.charted):
            self._placed = {key: number for number, key in self.charted.items()}
        found = self._placed.get(key)
        if found is not None:
            return found
        found = self.h.at.get(key)
        return NOWHERE if found is None or found in self.charted else found

    def overlay(self, one: int, other: int, *, period: bool) -> Iterator[Pair]:
        """Lay the charts of two places over each other, so that the two coincide.

        Args:
            one, other: the places.
            period: if they are in one chart, it closes on itself; otherwise it stays as it is.

        Returns:
            Pairs of places that coincide by this, found as they are asked for. Charts are as said once all were.
        """
        a, b = self.h.places[one], self.h.places[other]
        if a.frame != b.frame:
            return reversed(self._join(a, b) if a.frame < b.frame else self._join(b, a))
        if not period or a.position == b.position:
            return iter(())
        vector = [x - y for x, y in zip(a.position, b.position, strict=True)]
        return self._close(a.frame, [vector])

    def _join(self, a: Place, b: Place) -> list[Pair]:
        """Lay the chart of `b` onto that of `a`."""
        periods, pairs = self.h.periods.get(a.frame, ()), list[Pair]()
        if more := self.h.periods.get(b.frame):
            pairs = list(self._close(a.frame, more))
            periods = self.periods[1] if self.periods else periods
        shift = tuple(x - y for x, y in zip(a.position, b.position, strict=True))
        moved = [number for number in self.h.places if self.h.places[number].frame == b.frame]
        self.joined = len(moved)
        there = {key[1]: number for number, key in self.charted.items() if key[0] == a.frame}
        for number in moved:
            place = self.h.places[number]
            position = reduced([x + d for x, d in zip(place.position, shift, strict=True)], periods)
            self.charted[number] = (a.frame, position)
            pairs += self._met(a.frame, position, number, there)
        return pairs

    def _close(self, frame: int, vectors: Sequence[Sequence[int]]) -> Iterator[Pair]:
        """Let a chart close on itself.

        Places one vector apart come first: they are found at once, and the first few of them refuse most closings,
        whereas to lay out the whole chart anew takes as long as it is large.
        """
        periods = self.h.periods.get(frame, ())
        for vector in vectors:
            periods = with_period(periods, vector)
        self.periods = (frame, periods)
        yield from self._apart(frame, vectors)
        there: dict[Position, int] = {}
        for number in self.h.places:
            place = self.h.places[number]
            if place.frame == frame:
                position = reduced(place.position, periods)
                if position != place.position:
                    self.charted[number] = (frame, position)
                if (other := there.setdefault(position, number)) != number:
                    yield other, number

    def _apart(self, frame: int, vectors: Sequence[Sequence[int]]) -> Iterator[Pair]:
        """Pairs of places of a chart that are one of the vectors apart, those found last first."""
        for number in reversed(self.h.places):
            place = self.h.places[number]
            for vector in vectors if place.frame == frame else ():
                key = self.h.canonical(frame, [x + d for x, d in zip(place.position, vector, strict=True)])
                found = self.h.at.get(key)
                if found is not None:
                    yield number, found

    def _met(self, frame: int, position: Position, number: int, there: dict[Position, int]) -> list[Pair]:
        other = there.setdefault(position, number)
        if other == number:
            found = self.h.at.get((frame, position))
            if found is None or found in self.charted:
                return []
            other = found
        return [(other, number)]
