"""What is carried from one time step to the next, and what was learned from it."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, replace
from functools import cached_property

import numpy as np

from ..model import CogmapError, Floats, Ints, Successors, html_table, is_number


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
    """The filtered joint Q(s, p), over the pairs with mass."""

    places: Ints  # `[n]` place of each pair
    positions: Ints  # `[n]` position (by number) of each pair
    mass: Floats  # `[n]` probability of each pair; sums to one

    @cached_property
    def by_place(self) -> tuple[Ints, Floats]:
        """The places that hold mass, in ascending order, and Q(s)."""
        return _summed(self.places, self.mass)

    @cached_property
    def ranked(self) -> dict[int, float]:
        """Q(s) of the places that hold mass, the most probable first."""
        return _ranked(self.places, self.mass)

    @cached_property
    def place(self) -> int:
        """The most probable place."""
        places, mass = self.by_place
        return int(places[mass.argmax()])

    @cached_property
    def certainty(self) -> float:
        """Q of the most probable place."""
        return float(self.by_place[1].max())

    @classmethod
    def sure(cls, place: int, pose: int) -> Message:
        """That of an agent that knows where it is."""
        return cls(np.array([place]), np.array([pose]), np.ones(1))


@dataclass(frozen=True, slots=True)
class FilterOptions:
    """Options of the forward filter: how it predicts, and how much mass it may drop.

    Attributes:
        displacement: P(moved_t): the agent was put into some visited place without being told.
        slip: P that a motion through an open door does not change the position, or through a blocked one does.
        support: posterior mass below which a place leaves the support.

    Raises:
        CogmapError: one is no number from 0 to 1.
    """

    displacement: float = 1e-4
    slip: float = 1e-4
    support: float = 1e-3

    def __post_init__(self) -> None:
        for name, value in asdict(self).items():
            if not is_number(value, 0.0, 1.0):
                raise CogmapError(f"settings: filter.{name} is {value!r}; use a number from 0 to 1")


def _nothing() -> tuple[Ints, Floats]:
    return np.zeros(0, dtype=np.int64), np.zeros(0)


@dataclass(frozen=True)
class Belief:
    """What the agent believes after one time step."""

    message: Message  # Q(s_t, p_t | o_1..t)
    evidence: float  # log P(o_t | the past), in nats, of what was kept; o_t is all that was sensed
    log_likelihood: Floats  # `[n]` log P(o_t | s_t) for each pair of the message, in nats
    moved: float  # P(moved_t | o_1..t)
    dropped: float  # posterior mass that was left out of the support, at most
    examined: bool  # whether being displaced was examined; if not, all of it would have been dropped
    # pairwise posterior Q(s_t-1, s_t, not moved): previous places, next places, and masses, each `[m]`
    pairwise: tuple[Ints, Ints, Floats]
    # probability of the hypotheses about the map in which the agent is elsewhere than this belief has it
    doubt: float = 0.0
    # `[n, F]` P(reading | s_t) of each sensor that sensed something, all together up to one factor; empty in a
    # belief that was loaded
    likelihoods: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    # places that were dropped from the support, and their mass beside the kept ones'
    pruned: tuple[Ints, Floats] = field(default_factory=_nothing)
    # where the action may have led from each place of the step before; None at first, and if loaded
    ahead: Successors | None = None

    def __repr__(self) -> str:
        ranked, shown = self.places, 5
        places = ", ".join(f"{place}: {q:.3g}" for place, q in list(ranked.items())[:shown])
        more = f", … {len(ranked) - shown} more" if len(ranked) > shown else ""
        return f"Belief({{{places}{more}}}, certainty {self.certainty:.3g}, free energy {self.free_energy:.3g} nats)"

    def _repr_html_(self) -> str:
        rows = [(place, f"{q:.4g}") for place, q in self.places.items()]
        told = f"certainty {self.certainty:.3g}, free energy {self.free_energy:.3g} nats"
        return html_table(("place", "Q(s)"), rows, most=8, caption=told)

    @property
    def accuracy(self) -> float:
        """E_Q[log P(o_t | s_t)], in nats."""
        return float(self.message.mass @ self.log_likelihood)

    @property
    def complexity(self) -> float:
        """KL from the predicted to the filtered Q(s_t, p_t), in nats: Q = predicted x likelihood / evidence."""
        return self.accuracy - self.evidence

    @property
    def free_energy(self) -> float:
        """F = complexity - accuracy = -log evidence (eq. 3, at the exact posterior), in nats."""
        return self.complexity - self.accuracy

    @property
    def places(self) -> dict[int, float]:
        """Q(s_t) of the places that hold mass, the most probable first."""
        return self.message.ranked

    @cached_property
    def positions(self) -> dict[int, float]:
        """Q(p_t) of the positions (by number) that hold mass, the most probable first."""
        return _ranked(self.message.positions, self.message.mass)

    @property
    def place(self) -> int:
        """The most probable place."""
        return self.message.place

    @property
    def certainty(self) -> float:
        """Probability of the most probable place, as far as the hypotheses about the map agree."""
        return self.message.certainty * (1.0 - self.doubt)

    def committed(self) -> Belief:
        """The belief with the most probable place alone in its support; what the others held is dropped.

        A map that is taught a place on the word of one hypothesis must not serve as evidence for the others.
        """
        at = self.message.places == self.place
        kept = float(self.message.mass[at].sum())
        previous, next_, mass = self.pairwise
        there = next_ == self.place
        message = Message(self.message.places[at], self.message.positions[at], self.message.mass[at] / kept)
        pairwise = (previous[there], next_[there], mass[there] / kept)
        return replace(
            self,
            message=message,
            log_likelihood=self.log_likelihood[at],
            likelihoods=self.likelihoods[at],
            evidence=self.evidence + float(np.log(kept)),
            moved=max(0.0, 1.0 - float(pairwise[2].sum())) if self.examined else 0.0,
            dropped=1.0 - kept * (1.0 - self.dropped),
            pairwise=pairwise,
        )
