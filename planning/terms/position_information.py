"""What visits teach about A_p."""

from dataclasses import dataclass

from .learned import Learned


@dataclass(frozen=True, slots=True)
class PositionInformation(Learned):
    """Information gain about A_p (eq. 8, learning)."""

    name = "position_information"
    label = "position information"
    colour = "#cc79a7"
    table = "position"
    equation = "sum_s C_s(t) - C_s(t-1), C_s = q_s I_s(v_s / q_s)"
    meaning = "information about positions (A_p)"
