"""Which foldings were tried in vain, and when they are tried again."""

from __future__ import annotations

from math import ceil
from typing import NamedTuple

from .hypothesis import Hypothesis

AGAIN, SELDOM = 16, 512  # steps after which a folding that was too improbable is tried again: at first, and at most
CONTRADICTED = -16  # nats below which a folding is contradicted by what was read, and not only by how large the map is

Attempt = tuple[int, int, bool, int]
"""The places, whether their chart closes on itself, and how the one lies to the other."""


class Tried(NamedTuple):
    """A folding that was too improbable.

    Attributes:
        time: when it was tried last.
        wait: steps after which it is tried again; it doubles with each try in vain.
        size, links: of the map; if they have changed it is tried at once, unless it was contradicted.
        worth: nats, rounded up, that it gained at most: a more probable hypothesis may try it nevertheless.
    """

    time: int
    wait: int
    size: int
    links: int
    worth: int

    def blocks(self, h: Hypothesis, time: int, floor: float) -> bool:
        """Whether it is too early to try it again, or too improbable to reach `floor`."""
        same = self.worth < CONTRADICTED or (self.size, self.links) == (h.size, h.links)
        return same and time < self.time + self.wait and h.weight + self.worth < floor

    def again(self, h: Hypothesis, time: int, worth: float) -> Tried:
        """It was tried in vain once more."""
        longer = max(self.worth, worth) < CONTRADICTED
        wait = min(2 * self.wait, SELDOM) if longer else AGAIN
        return Tried(time, wait, h.size, h.links, ceil(worth))


NEVER = Tried(-SELDOM - 1, 0, -1, -1, 0)  # what was not tried yet


def attempt(h: Hypothesis, one: int, other: int, *, period: bool) -> Attempt:
    """What names a folding, in hypotheses that agree on how the two places lie to each other."""
    a, b = h.places[one], h.places[other]
    if a.frame != b.frame:  # charts that begin elsewhere hold other places
        return one, other, period, hash((a.frame, a.position, b.frame, b.position))
    return one, other, period, hash(tuple([x - y for x, y in zip(a.position, b.position, strict=True)]))
