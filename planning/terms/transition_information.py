"""What visits teach about B_s."""

from __future__ import annotations

from dataclasses import dataclass

from .learned import Learned


@dataclass(frozen=True, slots=True)
class TransitionInformation(Learned):
    """Information gain about B_s (eq. 8, learning)."""

    name = "transition_information"
    label = "transition information"
    colour = "#009e73"
    table = "transition"
    equation = "sum_s C_s(t) - C_s(t-1), C_s = q_s I_s(v_s / q_s)"
    meaning = "information about transitions (B_s)"
