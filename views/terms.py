"""The terms of expected free energy: what each is called, its sign in G, and how it is drawn."""

from __future__ import annotations

from dataclasses import dataclass

from .colours import BLUE, GREEN, ORANGE, PURPLE, RGB, SKY, VERMILION


@dataclass(frozen=True, slots=True)
class Term:
    """One term.

    Attributes:
        name: in legends.
        sign: with which it goes into G.
        colour: of lines and bars.
        style: of lines.
        hatch: of bars.
    """

    name: str
    sign: float
    colour: RGB
    style: str | tuple[int, tuple[int, ...]]
    hatch: str


TERMS = {
    "state_information": Term("−state information", -1.0, BLUE, "--", ""),
    "sight_information": Term("−sight information", -1.0, ORANGE, "-.", ""),
    "transition_information": Term("−transition information", -1.0, GREEN, (0, (5, 1)), "///"),
    "position_information": Term("−position information", -1.0, PURPLE, ":", "..."),
    "utility": Term("−utility", -1.0, SKY, (0, (3, 1, 1, 1)), "\\\\\\"),
    "collision": Term("collision", 1.0, VERMILION, (0, (1, 1)), "xxx"),
}
