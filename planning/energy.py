"""Expected free energy of policies, term by term."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class ExpectedFreeEnergy:
    """G(policy), term by term; each `[P]`, in nats, summed over the steps of the policy.

    Attributes:
        state_information: what the sights would tell about the place (eq. 5, eq. 8 inference).
        sight_information: what they would teach about A_o (eq. 8 learning).
        position_information: what the positions would teach about A_p (eq. 8 learning).
        transition_information: what their doors would teach about B_s (eq. 8 learning).
        utility: expected log preference of the sights and places (eq. 5).
        collision: expected risk of collision (eq. 8).
    """

    state_information: Floats
    sight_information: Floats
    position_information: Floats
    transition_information: Floats
    utility: Floats
    collision: Floats

    @property
    def information(self) -> Floats:
        """`[P]` all information gains together."""
        learned = self.sight_information + self.position_information + self.transition_information
        return self.state_information + learned

    @property
    def G(self) -> Floats:
        """`[P]` collision - information - utility; the least is best."""
        return self.collision - self.information - self.utility

    def __len__(self) -> int:
        return len(self.utility)

    def row(self, policy: int) -> dict[str, float]:
        """The terms of one policy by name, and `G`."""
        one = ExpectedFreeEnergy(*(getattr(self, name)[[policy]] for name in self.__slots__))
        return {**{name: float(getattr(one, name)[0]) for name in self.__slots__}, "G": float(one.G[0])}
