"""One change of one count."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Lesson:
    """One change of a count.

    Attributes:
        table: `A_o`, `A_p` or `B_s`.
        outcome: sight, position or next place, by number.
        place: the place in whose column the count changed.
        action: the action, for `B_s`.
        amount: what was added to the count.
    """

    table: str
    outcome: int
    place: int
    action: int | None
    amount: float
