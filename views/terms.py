"""How the terms of expected free energy are drawn and told: from what each says of itself."""

from __future__ import annotations

from typing import Any

from ..planning import Term
from .theme import Theme

NOTHING = 1e-6
"""Nats; a term that is smaller in all that is shown is left out."""

_LINES: tuple[Any, ...] = ("--", "-.", ":", (0, (5, 1)), (0, (3, 1, 1, 1)), (0, (1, 1)))
_HATCHES = ("", "", "...", "///", "\\\\\\", "xxx", "++", "oo")


def signed_label(term: Term) -> str:
    """What a term is called where it is shown with the sign that it has in G."""
    return f"−{term.label}" if term.sign < 0.0 else term.label


def line_look(term: Term, number: int, theme: Theme) -> dict[str, Any]:
    """Of the line of the term of this number."""
    from matplotlib.colors import to_rgb

    return {"color": theme.line(to_rgb(term.colour)), "linestyle": _LINES[number % len(_LINES)]}


def bar_look(term: Term, number: int, theme: Theme) -> dict[str, Any]:
    """Of the bars of the term of this number."""
    hatch = _HATCHES[number % len(_HATCHES)]
    return {"color": term.colour, "hatch": hatch, "edgecolor": theme.paper, "linewidth": 0.6}


def term_json(term: Term) -> dict[str, Any]:
    """What a recording says of a term."""
    return {name: getattr(term, name) for name in ("name", "label", "sign", "kind", "colour", "meaning")}
