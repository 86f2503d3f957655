"""What is carried from one time step to the next, and what was learned from it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def _summed(values: Ints, mass: Floats) -> tuple[Ints, Floats]:
    if len(values) == 1:
        return values, mass
    distinct, inverse = np.unique(values, return_inverse=True)
    return distinct, np.bincount(inverse, weights=mass, minlength=len(distinct)).astype(np.float64)


def _ranked(values: Ints, mass: Floats) -> dict[int, float]:
    distinct, total = _summed(values, mass)
    order = np.argsort(-total, kind="stable")
    return dict(zip(distinct[order].tolist(), total[order].tolist(), strict=True))


@dataclass(frozen=True)
class Message:
    """A filtered joint Q(s, p) over the pairs that hold mass.

    Attributes:
        places: `[n]` place of each pair.
        positions: `[n]` position (by number) of each pair.
        mass: `[n]` probability of each pair; sums to one.
    """

    places: Ints
    positions: Ints
    mass: Floats

    @cached_property
    def by_place(self) -> tuple[Ints, Floats]:
        """The places that hold mass, in ascending order, and Q(s)."""
        return _summed(self.places, self.mass)


@dataclass(frozen=True, slots=True)
class Evidence:
    """What was done and then sensed at one time step.

    Attributes:
        action: the action that led here; None at the first step.
        was_open: whether its door had been sensed open before.
        sight: number of the sight.
        open: for each action, whether its way is open here.
    """

    action: int | None
    was_open: bool
    sight: int
    open: Sequence[bool]


@dataclass(frozen=True, slots=True)
class FilterOptions:
    """How the filter predicts and what it may drop.

    Attributes:
        displacement: P(moved_t): the agent was put into some visited place without being told.
        slip: P that a motion through an open door does not change the position, or through a blocked one does.
        support: posterior mass below which a place leaves the support.
    """

    displacement: float = 1e-4
    slip: float = 1e-4
    support: float = 1e-3


def _nothing() -> tuple[Ints, Floats]:
    return np.zeros(0, dtype=np.int64), np.zeros(0)


@dataclass(frozen=True)
class Belief:
    """What the agent believes after one time step.

    Attributes:
        message: Q(s_t, p_t | o_1..t).
        evidence: log P(o_t, c_t | the past), in nats, of what was kept.
        log_likelihood: `[n]` log P(o_t, c_t | s_t) for each pair of the message, in nats.
        moved: P(moved_t | o_1..t).
        dropped: posterior mass that was left out of the support, at most.
        examined: whether being displaced was examined; if not, all of it would have been dropped.
        walks: pairwise posterior Q(s_t-1, s_t, not moved): previous places, next places, and masses, each `[m]`.
        doubt: probability that the belief went astray at an earlier step; see `rivals`.
        factors: `[n, 2]` P(o_t | s_t) and P(c_t | s_t) for each pair of the message; empty in a belief that was loaded.
        faint: places that were dropped from the support, and their mass beside the kept ones'.
    """

    message: Message
    evidence: float
    log_likelihood: Floats
    moved: float
    dropped: float
    examined: bool
    walks: tuple[Ints, Ints, Floats]
    doubt: float = 0.0
    factors: Floats = field(default_factory=lambda: np.zeros((0, 2)))
    faint: tuple[Ints, Floats] = field(default_factory=_nothing)

    @property
    def accuracy(self) -> float:
        """E_Q[log P(o_t, c_t | s_t)], in nats."""
        return float(self.message.mass @ self.log_likelihood)

    @property
    def complexity(self) -> float:
        """KL from the predicted to the filtered Q(s_t, p_t), in nats: Q = predicted x likelihood / evidence."""
        return self.accuracy - self.evidence

    @property
    def free_energy(self) -> float:
        """F = complexity - accuracy = -log evidence (eq. 3, at the exact posterior), in nats."""
        return self.complexity - self.accuracy

    @cached_property
    def places(self) -> dict[int, float]:
        """Q(s_t) of the places that hold mass, the most probable first."""
        return _ranked(self.message.places, self.message.mass)

    @property
    def positions(self) -> dict[int, float]:
        """Q(p_t) of the positions (by number) that hold mass, the most probable first."""
        return _ranked(self.message.positions, self.message.mass)

    def committed(self) -> Belief:
        """The belief with the most probable place alone in its support; what the others held is dropped.

        A map that is taught a place on the word of one hypothesis must not serve as evidence for the others.
        """
        at = self.message.places == self.place
        kept = float(self.message.mass[at].sum())
        previous, next_, mass = self.walks
        there = next_ == self.place
        message = Message(self.message.places[at], self.message.positions[at], self.message.mass[at] / kept)
        walks = (previous[there], next_[there], mass[there] / kept)
        return replace(
            self,
            message=message,
            log_likelihood=self.log_likelihood[at],
            factors=self.factors[at],
            evidence=self.evidence + float(np.log(kept)),
            moved=max(0.0, 1.0 - float(walks[2].sum())) if self.examined else 0.0,
            dropped=1.0 - kept * (1.0 - self.dropped),
            walks=walks,
        )

    @cached_property
    def place(self) -> int:
        """The most probable place."""
        places, mass = self.message.by_place
        return int(places[mass.argmax()])

    @cached_property
    def certainty(self) -> float:
        """Q of the most probable place."""
        return float(self.message.by_place[1].max())
