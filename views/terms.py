"""How the terms of expected free energy are drawn, whichever they are."""

from __future__ import annotations

from ..planning import Term
from .colours import RGB

STYLES: tuple[str | tuple[int, tuple[int, ...]], ...] = ("--", "-.", ":", (0, (5, 1)), (0, (3, 1, 1, 1)), (0, (1, 1)))
HATCHES = ("", "", "...", "///", "\\\\\\", "xxx")
"""Of lines and of bars, by the place of a term in its list."""


def signed_label(term: Term) -> str:
    """What the curve of a term is called, with the sign it has in G."""
    return term.label if term.sign > 0.0 else f"−{term.label}"


def colour_of(term: Term) -> RGB:
    """Red, green and blue of its colour."""
    red, green, blue = (int(term.colour[i : i + 2], 16) / 255 for i in (1, 3, 5))
    return red, green, blue
