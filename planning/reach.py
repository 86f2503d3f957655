"""What a plan can see: the tables of the map, cut to the places within reach."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..model.errors import CogmapError
from ..model.motions import Motions
from .transitions import Transitions

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Reach:
    """The generative model over the `R` places that a policy can lead to.

    Local place `i` stands for place `places[i]` of the map; `-1` is "somewhere never imagined".
    Outcomes that no place in reach tells apart are lumped: row `o` of `A` stands for
    `multiplicity[o]` sights that are alike, and holds their mass together.

    Attributes:
        motions: the `K` actions.
        look_ahead: steps that the policy generators may use.
        places: `[R]` places of the map.
        belief: `[R]` Q(s) now.
        A: `[O, R]` P(o | s); columns sum to one.
        multiplicity: `[O]` sights that each row stands for.
        log_C: `[O]` log preference of each of the sights in the row, in nats (its weight included).
        log_C_place: `[R]` log preference of being in each place, in nats; zero where none is given.
        B: `[R, R, K]` P(s' | s, a); `B[:, s, a]` sums to one. An array, or `Transitions`, which holds the successors
            alone.
        collision: `[R, K]` P(blocked | s, a); zero for `stay`.
        collision_cost: -log P(c = 1) of the preferred outcomes, in nats.
        sight_information: `[R, N + 1]` what `n` sights of a place teach about its column of A_o, in
            nats; column 0 is zero; `N` is at least `look_ahead`, and more than `N` teach what `N` do.
        position_information: `[R, N + 1]` the same for A_p.
        transition_information: `[R, N + 1]` the same for B_s: what looking at the doors of a place `n` times
            teaches about `B[:, s, a]`, summed over the actions.
        successor: `[R, K]` the place each action most probably leads to on the map; `-1` where the
            map says blocked or knows nothing beyond.
        promise: `[R]` what a first visit is worth, in nats (for generators that look for goals).
        discount: weight of each step of a policy relative to the one before, above 0, at most 1.
        information_weight: weight of every information gain beside utility and collision, 0 or more.
        dropped: belief in places that were left out, before `belief` was made to sum to one again.
        frontier: `[R]` how far out a place lies that was never entered, to choose between near-ties: squared distance
            from the origin of positions; -1 for every other place. Empty where there is none.
    """

    motions: Motions
    look_ahead: int
    places: Ints
    belief: Floats
    A: Floats
    multiplicity: Floats
    log_C: Floats
    log_C_place: Floats
    B: Floats | Transitions
    collision: Floats
    collision_cost: float
    sight_information: Floats
    position_information: Floats
    transition_information: Floats
    successor: Ints
    promise: Floats
    discount: float = 1.0
    information_weight: float = 1.0
    dropped: float = 0.0
    frontier: Floats = field(default_factory=lambda: np.zeros(0))

    @property
    def utility(self) -> Floats:
        """`[R]` expected log preference of a visit."""
        return self.log_C @ self.A + self.log_C_place

    @property
    def indifferent(self) -> bool:
        """Whether no sight and no place is preferred over the others."""
        return bool((self.log_C == self.log_C[0]).all() and (self.log_C_place == self.log_C_place[0]).all())

    def check(self) -> None:
        """Raise `CogmapError` naming the first table that is of the wrong shape or no probability."""
        if self.look_ahead < 1:
            raise CogmapError(f"reach: look_ahead is {self.look_ahead}; give 1 or more steps")
        self._check_shapes()
        for name in ("sight_information", "position_information", "transition_information"):
            if getattr(self, name).shape[-1] <= self.look_ahead:
                raise CogmapError(f"reach: {name} ends before look_ahead; give {self.look_ahead + 1} columns or more")
        p = self.B.probability.transpose(2, 0, 1) if isinstance(self.B, Transitions) else self.B
        for name, table in (("belief", self.belief), ("A", self.A), ("B", p)):
            # a NaN fails every comparison, so these also refuse what is not finite
            if not (table.min() >= 0.0 and abs(table.sum(0) - 1.0).max() <= 1e-6):
                raise CogmapError(f"reach: {name} is no probability; its columns must sum to one")
        if not (self.collision.min() >= 0.0 and self.collision.max() <= 1.0):
            raise CogmapError("reach: collision is no probability; give numbers from 0 to 1")
        wanted = np.concatenate([self.log_C, self.log_C_place, [self.collision_cost]])
        if not np.isfinite(wanted).all():
            raise CogmapError(
                "reach: log_C, log_C_place and collision_cost must be finite; an outcome never wanted needs a floor"
            )
        if not 0.0 < self.discount <= 1.0:
            raise CogmapError(f"reach: discount is {self.discount}; give a number above 0, at most 1")
        if not 0.0 <= self.information_weight < np.inf:
            raise CogmapError(
                f"reach: information_weight is {self.information_weight}; give a finite number, 0 or more"
            )
        if not 0.0 <= self.dropped < 1.0:
            raise CogmapError(f"reach: dropped is {self.dropped}; give a probability below 1")
        if np.isnan(self.frontier).any():
            raise CogmapError("reach: frontier has a NaN; give squared distances, -1 where nothing is new")
        if not self.multiplicity.min() >= 1.0:
            raise CogmapError("reach: multiplicity is below one; each row of A stands for one sight or more")
        if self.successor.min() < -1 or self.successor.max() >= len(self.belief):
            raise CogmapError("reach: successor must be -1 or a place in reach, counted from 0")

    def _check_shapes(self) -> None:
        R, K, O = len(self.belief), len(self.motions), len(self.multiplicity)  # noqa: E741
        shapes = {
            "places": (R,),
            "belief": (R,),
            "A": (O, R),
            "multiplicity": (O,),
            "log_C": (O,),
            "log_C_place": (R,),
            "B": (R, R, K),
            "collision": (R, K),
            "successor": (R, K),
            "promise": (R,),
            "frontier": (R,) if self.frontier.size else self.frontier.shape,
            "sight_information": (R, self.sight_information.shape[-1]),
            "position_information": (R, self.position_information.shape[-1]),
            "transition_information": (R, self.transition_information.shape[-1]),
        }
        for name, shape in shapes.items():
            found = getattr(self, name).shape
            if found != shape or (0 in shape and name != "frontier"):
                raise CogmapError(
                    f"reach: {name} has shape {found}; {R} places, {K} actions, {O} outcomes ask for {shape}"
                )
        if isinstance(self.B, Transitions):
            self._check_successors(self.B)

    def _check_successors(self, B: Transitions) -> None:
        if B.successors.ndim != 3 or B.successors.shape != B.probability.shape:
            raise CogmapError("reach: B has successors and probability of different shapes; give [R, K, n] of both")
        if B.successors.min() < 0 or B.successors.max() >= len(self.belief):
            raise CogmapError("reach: B leads out of reach; its successors must be places counted from 0")
