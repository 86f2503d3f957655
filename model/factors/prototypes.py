"""Prototypes of vectors: a mixture of Gaussians of one learned spread that grows as a Chinese restaurant process."""

from collections.abc import Iterable, Mapping
from math import inf, log, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import CogmapError
from .base import Floats
from .clusters import halves, seating, student

CONCENTRATION = 1.0
"""Of the Chinese restaurant process: after n vectors the next shows something new with probability 1 / (n + 1)."""

POSSIBLE = 0.02
"""Probability from which on a vector is taken for something new while little is known of the spread or the prototype.

To unite two that are one is safer than to part them. Where much is known it is a half.
"""

SURE = log(100.0)  # log odds from which on two prototypes are one
WORTH = 4.0  # numbers that the first guess of the spread counts as

RECENT, LEAST = 64, 4
"""The last vectors that are kept, and how many of a prototype are needed to part it."""

GUESSED = 6.0  # numbers that the first guess of how prototypes differ counts as


class Prototypes:
    """What vectors were like so far.

    A prototype is drawn from N(m, τ² I), a vector that shows it from N(prototype, σ² I). σ² has an inverse gamma prior
    about (`noise` τ)², so that a vector is known again by a Student t; and τ² one about the variance of the numbers of
    the first vector, until there are prototypes that tell better. So what all vectors have in common, number by number,
    must not be much more than what tells them apart: subtract it before. Each vector teaches by its posterior. What may
    be new is taken for new, and united with what turns out to be the same when more is known; one of which the last
    vectors are surely of two is parted.

    It is a store of the map, but the log of changes does not speak of it: what was seen stays seen, wherever it was.

    Args:
        name: unique in its map.
        size: numbers of a vector, D.
        noise: a first guess of σ / τ.
    """

    def __init__(self, name: str, *, size: int, noise: float) -> None:
        self.name, self._size, self._noise = name, size, noise
        self._first = np.zeros(2)  # mean and variance of the numbers of the first vector
        self._stray = np.zeros(2)  # sum of squares about prototypes, and how many numbers it is of
        self._counts = np.zeros(0)
        self._sums = np.zeros((0, size))
        self._recent = np.zeros((0, size))
        self._shown = np.zeros(0, dtype=np.int64)  # the prototypes of the last vectors

    @property
    def count(self) -> int:
        """How many there ever were; their numbers stay, also of those that turned out to be another."""
        return len(self._counts)

    @property
    def numbers(self) -> list[int]:
        """`[n]` those that there are."""
        return np.flatnonzero(self._counts).tolist()

    @property
    def means(self) -> Floats:
        """`[n, D]` the mean of what showed each that there is."""
        there = self._counts > 0.0
        return self._sums[there] / self._counts[there, None]

    @property
    def spread(self) -> float:
        """σ, about a prototype."""
        return sqrt(self._variance(self._apart()[1]))

    def log_likelihoods(self, vector: Floats) -> tuple[Floats, float]:
        """`[K]` log P(x | prototype) of each, and the same of one that is new, in nats."""
        mean, apart = self._apart()
        variance = self._variance(apart)
        shrink = variance / apart  # what its prior counts as, in vectors
        centres = (self._sums + shrink * mean) / (self._counts + shrink)[:, None]
        wider = variance * (1.0 + 1.0 / (self._counts + shrink))
        squares = ((vector - centres) ** 2).sum(axis=1)
        known = student(squares, wider, WORTH + self._stray[1].item(), self._size)
        known[self._counts == 0.0] = -inf
        there = int((self._counts > 0.0).sum())
        total = apart * (1.0 + 1.0 / (1.0 + there)) + variance
        degrees = GUESSED + max(there - 1, 0) * self._size
        new = student(np.array([((vector - mean) ** 2).sum()]), np.array([total]), degrees, self._size)
        return known, new.item()

    def take_in(self, vector: Floats) -> Floats:
        """Learn from a vector, as a new prototype where that is possible; and unite prototypes that are the same.

        Returns:
            `[K]` log P(x | prototype) of each, the new one included, in nats; -inf of those that were united.
        """
        if not self.count:
            self._begin(vector)
        told, new = self.log_likelihoods(vector)
        with np.errstate(divide="ignore"):
            weighed = np.append(told + np.log(self._counts), new + log(CONCENTRATION))
        posterior = np.exp(weighed - np.logaddexp.reduce(weighed))
        if posterior[-1] > self._needed(int(posterior[:-1].argmax()) if len(told) else None):
            self._counts = np.append(self._counts, 1.0)
            self._sums = np.vstack([self._sums, vector])
            told = np.append(told, new)
        else:
            self._learn(vector, posterior[:-1] / posterior[:-1].sum())
        number = int(told.argmax())
        self._remember(vector, number)
        while (same := self._same()) is not None:
            self._unite(*same)
            told = self.log_likelihoods(vector)[0]
        if self._part(number):
            told = self.log_likelihoods(vector)[0]
        return told

    def _remember(self, vector: Floats, number: int) -> None:
        self._recent = np.vstack([self._recent, vector])[-RECENT:]
        self._shown = np.append(self._shown, number)[-RECENT:]

    def _needed(self, nearest: int | None) -> float:
        """Probability from which on a vector is taken for something new, the nearest prototype being this one."""
        if nearest is None:
            return 0.0
        spread, count = self._stray[1].item(), self._counts[nearest].item()
        known = spread / (spread + 8.0 * self._size) * count / (count + 4.0)
        return POSSIBLE + known * (0.5 - POSSIBLE)

    def _begin(self, vector: Floats) -> None:
        """What a first vector says of them all."""
        variance = float(vector.var()) if self._size > 1 else float(vector[0] ** 2)
        least = (1e-9 * float(np.abs(vector).max()) or 1e-9) ** 2  # where all its numbers are the same
        self._first = np.array([vector.mean() if self._size > 1 else 0.0, max(variance, least)])

    def _same(self) -> tuple[int, int] | None:
        """The pair of prototypes that is most probably one, the older first; None where all are different."""
        at = np.flatnonzero(self._counts)
        if len(at) < 2:
            return None
        one, other = np.triu_indices(len(at), 1)
        one, other = at[one], at[other]
        squares = (
            (self._sums[one] / self._counts[one, None] - self._sums[other] / self._counts[other, None]) ** 2
        ).sum(1)
        odds = self._odds(squares, self._counts[one], self._counts[other])
        best = int(odds.argmax())
        return (int(one[best]), int(other[best])) if odds[best] > SURE else None

    def _odds(self, squares: Floats, many: Floats, few: Floats) -> Floats:
        """`[n]` log odds that two means are of one prototype, by their squared distance, each of so many vectors."""
        apart = self._apart()[1]
        wide = self._variance(apart) * (1.0 / many + 1.0 / few)
        same = student(squares, wide, WORTH + self._stray[1].item(), self._size)
        there = int((self._counts > 0.0).sum())
        different = student(squares, wide + 2.0 * apart, GUESSED + max(there - 1, 0) * self._size, self._size)
        return same - different + seating(many, few, CONCENTRATION)

    def _part(self, number: int) -> bool:
        """Part a prototype in two, if its last vectors are surely of two; whether it was."""
        own = np.flatnonzero(self._shown == number)
        if len(own) < LEAST or not self._counts[number]:
            return False
        half = halves(self._recent[own])
        half = half if half.sum() <= (~half).sum() else ~half
        few, many = float(half.sum()), float((~half).sum())
        if min(few, many) < 2.0 or few >= self._counts[number]:
            return False
        gone = self._recent[own[half]].sum(axis=0)
        squares = ((gone / few - self._recent[own[~half]].mean(axis=0)) ** 2).sum()
        if self._odds(np.array([squares]), np.array([many]), np.array([few]))[0] > -SURE:
            return False
        self._shown[own[half]] = self.count
        self._stray = np.maximum(self._stray - [float(squares * many * few / (many + few)), self._size], 0.0)
        self._counts, self._sums = np.append(self._counts, few), np.vstack([self._sums, gone])
        self._counts[number] -= few
        self._sums[number] -= gone
        return True

    def _unite(self, kept: int, gone: int) -> None:
        many, few = self._counts[kept], self._counts[gone]
        squares = ((self._sums[kept] / many - self._sums[gone] / few) ** 2).sum()
        self._stray += float(squares * many * few / (many + few)), self._size
        self._counts[kept], self._counts[gone] = many + few, 0.0
        self._sums[kept] += self._sums[gone]
        self._sums[gone] = 0.0
        self._shown[self._shown == gone] = kept

    def _learn(self, vector: Floats, share: Floats) -> None:
        there = self._counts > 0.0
        means = self._sums / np.where(there, self._counts, 1.0)[:, None]
        squares = ((vector - means) ** 2).sum(axis=1) * self._counts / np.where(there, self._counts + share, 1.0)
        self._stray += float(share @ squares), self._size
        self._counts = self._counts + share
        self._sums = self._sums + share[:, None] * vector

    def _apart(self) -> tuple[Floats, float]:
        """m `[D]` and τ²: how prototypes differ from each other."""
        middle, variance = self._first.tolist()
        means = self.means
        most = self._size * max(len(means) - 1, 0)
        centre = (means.sum(axis=0) + middle) / (len(means) + 1.0)
        differ = ((means - means.mean(axis=0)) ** 2).sum() if most else 0.0
        return centre, float(GUESSED * variance + differ) / (GUESSED + most)

    def _variance(self, apart: float) -> float:
        """σ² as learned so far."""
        return (WORTH * self._noise**2 * apart + self._stray[0].item()) / (WORTH + self._stray[1].item())

    # -- as a store of the map ---------------------------------------------------------------------------------

    def put(self, where: Any, value: Any) -> None:
        """Nothing: no change of it is logged."""

    def savepoint(self) -> dict[str, NDArray[Any]]:
        """All that it knows."""
        return self.state()

    def level(self) -> None:
        """Nothing: nobody writes to it from outside."""

    def go_back(self, point: dict[str, NDArray[Any]]) -> None:
        """Know what it knew."""
        self._know(*point.values())

    def touched(self, where: Any) -> Iterable[int]:
        """No place."""
        return ()

    def state(self) -> dict[str, NDArray[Any]]:
        """Copies of all that it knows."""
        parts = {"first": self._first, "stray": self._stray, "counts": self._counts, "sums": self._sums}
        parts |= {"recent": self._recent, "shown": self._shown.astype(np.float64)}
        return {name: part.copy() for name, part in parts.items()}

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Take over what `state` gave. Raises CogmapError: it is of vectors of another size, or no such numbers."""
        first, stray, counts, sums, recent, shown = (state[part] for part in self.state())
        fits = first.shape == stray.shape == (2,) and counts.ndim == shown.ndim == 1
        fits = fits and sums.shape == (len(counts), self._size) and recent.shape == (len(shown), self._size)
        parts = (first, stray, counts, sums, recent, shown)
        if not (fits and all(part.dtype == np.float64 and (np.abs(part) < inf).all() for part in parts)):
            raise CogmapError(f"map: {self.name} do not fit vectors of {self._size} numbers; save it again")
        known = (shown >= 0.0) & (shown < len(counts))
        if not ((counts >= 0.0).all() and (stray >= 0.0).all() and first[1] >= 0.0 and known.all()):
            raise CogmapError(f"map: {self.name} have counts that are none; save it again")
        self._know(*parts)

    def _know(self, first: Floats, stray: Floats, counts: Floats, sums: Floats, recent: Floats, shown: Floats) -> None:
        self._first, self._stray, self._counts, self._sums = first.copy(), stray.copy(), counts.copy(), sums.copy()
        self._recent, self._shown = recent.copy(), shown.astype(np.int64)
