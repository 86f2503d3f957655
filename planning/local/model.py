"""The local model of a plan: the generative model over the places that policies can lead to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...model import CogmapError, Floats, Ints, Motions
from .frontier import Frontier
from .kept import Kept
from .structure import Structure
from .transitions import Transitions


@dataclass(frozen=True, slots=True)
class LocalModel:
    """The generative model over the `R` places that a policy can lead to.

    Local place `i` stands for place `places[i]` of the map; `-1` is "somewhere never imagined".
    Outcomes that no place in it tells apart are lumped: row `o` of `A` stands for `multiplicity[o]` sights that are
    alike, and holds their mass together.
    """

    motions: Motions  # the `K` actions
    look_ahead: int  # steps that the policy generators may use
    places: Ints  # `[R]` places of the map
    belief: Floats  # `[R]` Q(s) now
    A: Floats  # `[O, R]` P(o | s); columns sum to one
    multiplicity: Floats  # `[O]` sights that each row stands for
    log_C: Floats  # `[O]` log preference of each of the sights in the row, in nats (its weight included)
    log_C_place: Floats  # `[R]` log preference of being in each place, in nats; zero where none is given
    B: Transitions  # P(s' | s, a), the few successors of each place
    blocked: Floats  # `[R, K]` P(blocked | s, a); zero for `stay`
    collision_cost: float  # -log P(c = 1) of the preferred outcomes, in nats
    # for each table that is learned, by name (`sight`, `position`, `transition`), `[R, N + 1]` what `n` visits
    # of a place teach about it, in nats; column 0 is zero; `N` is at least `look_ahead`, and more than `N`
    # visits teach what `N` do
    information: Mapping[str, Floats]
    # `[R, K]` the place each action most probably leads to; `-1` where the map says blocked or knows nothing
    # beyond
    successor: Ints
    entered: NDArray[np.bool_]  # `[R]` whether the agent was ever there
    position: Floats  # `[R, n]` where each place is, relative to the start; NaN where nobody knows
    discount: float = 1.0  # weight of each step of a policy relative to the one before, above 0, at most 1
    information_weight: float = 1.0  # weight of every information gain beside utility and costs, 0 or more
    dropped: float = 0.0  # belief in places that were left out, before `belief` was made to sum to one again
    structure: Structure | None = None  # hypotheses about the map, side by side; None where there is but one
    senses: tuple[Floats, ...] = ()  # of each further sensor that sees labels, `[O', R]` as `A`
    # whether the ways of a place are sensed in it, and places are few enough to compare the ways of all
    looks: bool = False
    # `[K]` what each action is expected to cost, in units of its own; None where that was never said
    costs: Floats | None = None
    frontier: Frontier | None = None  # the options of an agent that explores by them; None for others
    # what was worked out of places, B, blocked, successor and entered alone, for models that share them
    kept: Kept | None = field(default=None, repr=False, compare=False)
    # `[R, K]` nats that the first step along each way teaches, where no visit has told whether it is open; None
    # where that is nothing
    untried: Floats | None = None
    # `[K]` what each action costs as the first of a policy, in usual moves; None where all cost the same
    prices: Floats | None = None

    @property
    def utility(self) -> Floats:
        """`[R]` expected log preference of a visit."""
        return self.log_C @ self.A + self.log_C_place

    @property
    def indifferent(self) -> bool:
        """Whether no sight and no place is preferred over the others."""
        return bool((self.log_C == self.log_C[0]).all() and (self.log_C_place == self.log_C_place[0]).all())

    def within(self, places: Ints) -> LocalModel:
        """The same over some of its places, by local number, ascending; what leads to others stays where it is."""
        number = np.full(len(self.places) + 1, -1)  # the last for -1 itself
        number[places] = np.arange(len(places))
        return replace(
            self,
            kept=None,
            untried=None if self.untried is None else self.untried[places],
            A=self.A[:, places],
            senses=tuple(A[:, places] for A in self.senses),
            B=self.B.within(places),
            successor=number[self.successor[places]],
            information={name: table[places] for name, table in self.information.items()},
            **{name: getattr(self, name)[places] for name in _A_PLACE},
        )

    def check(self) -> None:
        """Raise `CogmapError` naming the first table that is of the wrong shape or no probability."""
        self._check_shapes()
        B = self.B.probability.transpose(2, 0, 1)
        further = ((f"senses[{k}]", A) for k, A in enumerate(self.senses))
        for name, table in (("belief", self.belief), ("A", self.A), ("B", B), *further):
            # a NaN fails every comparison, so these also refuse what is not finite
            sure = table.min() >= 0.0 and abs(table.sum(0) - 1.0).max() <= 1e-6
            _need(sure, f"{name} is no probability", "sums of one")
        wanted = np.concatenate([self.log_C, self.log_C_place, [self.collision_cost]])
        what = "log_C, log_C_place or collision_cost is not finite"
        R, blocked, reached, led = len(self.belief), self.blocked, self.successor, self.B.successors
        _need(blocked.min() >= 0.0 and blocked.max() <= 1.0, "blocked is no probability", "numbers from 0 to 1")
        _need(np.isfinite(wanted).all(), what, "a floor to what is unwanted")
        _need(0.0 < self.discount <= 1.0, f"discount is {self.discount}", "a number above 0, at most 1")
        _need(0.0 <= self.information_weight < np.inf, "information_weight is negative or not finite", "0 or more")
        for name in ("cost", "price"):
            table = getattr(self, f"{name}s")
            fine = table is None or (np.isfinite(table).all() and table.min() >= 0.0)
            _need(fine, f"{name}s has a {name} below 0, or none", "finite numbers")
        _need(0.0 <= self.dropped < 1.0, f"dropped is {self.dropped}", "a probability below 1")
        _need(self.multiplicity.min() >= 1.0, "multiplicity is below one", "each row of A one sight or more")
        _need(reached.min() >= -1 and reached.max() < R, "successor is no place", "-1, or places from 0")
        _need(led.min() >= 0 and led.max() < R, "B leads out of the places", "places from 0")

    def _check_shapes(self) -> None:
        R, K, O = len(self.belief), len(self.motions), len(self.multiplicity)  # noqa: E741
        axes = len(self.motions.displacements[0]) if self.motions.placed else self.position.shape[-1]
        N, slots = max(self.look_ahead, 0), self.B.successors.shape[-1]
        _need(self.look_ahead >= 1, f"look_ahead is {self.look_ahead}", "1 or more steps")
        shapes = {
            "A": (O, R),
            "log_C": (O,),
            "successor": (R, K),
            "position": (R, axes),
            "blocked": (R, K),
            **dict.fromkeys(("places", "log_C_place", "entered"), (R,)),
            **({} if self.untried is None else {"untried": (R, K)}),
        }
        tables: dict[str, NDArray[Any]] = {name: getattr(self, name) for name in shapes}
        for name, table in self.information.items():
            tables[f"information[{name!r}]"] = table[:, : N + 1]
            shapes[f"information[{name!r}]"] = (R, N + 1)
        tables |= {f"senses[{k}]": A for k, A in enumerate(self.senses)}
        shapes |= {f"senses[{k}]": (len(A), R) for k, A in enumerate(self.senses)}
        if self.costs is not None:
            tables["costs"], shapes["costs"] = self.costs, (K,)
        tables |= {"successors of B": self.B.successors, "probability of B": self.B.probability}
        shapes |= dict.fromkeys(("successors of B", "probability of B"), (R, K, slots))
        for name, shape in shapes.items():
            what = f"{name} has shape {tables[name].shape}"
            _need(tables[name].shape == shape and 0 not in shape, what, f"{shape}, by places, actions and outcomes")


def _need(fine: bool | np.bool_, what: str, remedy: str) -> None:
    if not fine:
        raise CogmapError(f"local model: {what}; give {remedy}")


_A_PLACE = ("places", "belief", "log_C_place", "blocked", "entered", "position")  # tables with a row a place
