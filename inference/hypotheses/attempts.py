"""Which foldings were tried in vain, and when they are tried again."""

from __future__ import annotations

from typing import NamedTuple

from .hypothesis import Hypothesis

AGAIN, SELDOM = 16, 512
"""Steps after which a folding that was too improbable is tried again: at first, and at most."""

Attempt = tuple[int, int, bool, int]
"""The places, whether their chart closes on itself, and how the one lies to the other."""


class Tried(NamedTuple):
    """A folding that was too improbable.

    Attributes:
        time: when it was tried last.
        wait: steps after which it is tried again; it doubles with each try in vain.
        size, links: of the map; if they have changed it is tried at once, unless it was contradicted.
        contradicted: what was read contradicts it.
    """

    time: int
    wait: int
    size: int
    links: int
    contradicted: bool

    def blocks(self, h: Hypothesis, time: int) -> bool:
        """Whether it is too early to try it again."""
        same = self.contradicted or (self.size, self.links) == (h.size, h.links)
        return same and time < self.time + self.wait

    def again(self, h: Hypothesis, time: int, *, contradicted: bool) -> Tried:
        """It was tried in vain once more."""
        longer = self.contradicted and contradicted
        wait = min(2 * self.wait, SELDOM) if longer else AGAIN
        return Tried(time, wait, h.size, h.links, contradicted)


NEVER = Tried(-SELDOM - 1, 0, -1, -1, False)
"""What was not tried yet."""


def attempt(h: Hypothesis, one: int, other: int, *, period: bool) -> Attempt:
    """What names a folding, in hypotheses that agree on how the two places lie to each other."""
    a, b = h.places[one], h.places[other]
    apart = hash(tuple([x - y for x, y in zip(a.position, b.position, strict=True)])) if a.frame == b.frame else 1
    return one, other, period, apart
