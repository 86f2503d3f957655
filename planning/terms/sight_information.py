"""What visits teach about A_o."""

from dataclasses import dataclass

from .learned import Learned


@dataclass(frozen=True, slots=True)
class SightInformation(Learned):
    """Information gain about A_o (eq. 8, learning)."""

    name = "sight_information"
    label = "sight information"
    colour = "#e69f00"
    table = "sight"
    equation = "sum_s C_s(t) - C_s(t-1), C_s = q_s I_s(v_s / q_s)"
    meaning = "information about sights (A_o)"
