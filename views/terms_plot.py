"""What the best policies are worth, term by term; terms are drawn and told as each says of itself."""

from itertools import groupby
from typing import Any, Unpack

import numpy as np

from ..model import CogmapError
from ..planning import Plan, Term
from .axes import Axes, Where, axes_or_new, legend_below
from .theme import Theme, theme_of

NOTHING = 1e-6  # nats; a term that is smaller in all that is shown is left out
LONGEST = 34  # signs of a policy's name

_LINES: tuple[Any, ...] = ("--", "-.", ":", (0, (5, 1)), (0, (3, 1, 1, 1)), (0, (1, 1)))
_HATCHES = ("", "", "...", "///", "\\\\\\", "xxx", "++", "oo")


def plot_terms(plan: Plan, *, most: int = 8, **where: Unpack[Where]) -> Axes:
    """The policies with the least G, best at the top, as bars of their terms in nats. The diamond is their sum, G.

    What counts against G, such as information and utility, goes to the left, costs go to the right. The chosen policy
    is marked by ▶; it comes last where others are better.

    Args:
        plan: what the agent considered.
        most: policies that are shown, 1 or more.

    Raises:
        CogmapError: `most` is below 1.
    """
    if most < 1:
        raise CogmapError(f"plot_terms: most is {most}; use 1 or more")
    energy, others = plan.expected_free_energy, np.arange(len(plan.policies)) != plan.chosen
    order = np.lexsort((others, energy.G.round(9))).tolist()
    shown = order[:most] if plan.chosen in order[:most] else [*order[: most - 1], plan.chosen]
    ax = axes_or_new(size=(8.0, 1.9 + 0.36 * len(shown)), **where)
    theme, rows = theme_of(ax), np.arange(len(shown))
    look: dict[str, Any]
    ends = {-1.0: np.zeros(len(shown)), 1.0: np.zeros(len(shown))}  # bars stand side by side from zero
    for number, term in enumerate(energy.terms):
        values = term.sign * energy[term.name][shown]
        if np.abs(values).max() > NOTHING:
            left = np.where(values < 0.0, ends[-1.0], ends[1.0])
            look = {"color": term.colour, "hatch": _HATCHES[number % len(_HATCHES)]}
            look |= {"edgecolor": theme.paper, "linewidth": 0.6, "height": 0.7}
            ax.barh(rows, values, left=left, label=signed_label(term), **look)
            ends[-1.0] += np.minimum(values, 0.0)
            ends[1.0] += np.maximum(values, 0.0)
    look = {"s": 42, "marker": "D", "color": theme.ink, "edgecolors": theme.paper, "zorder": 4}
    ax.scatter(energy.G[shown], rows, label="G", **look)
    ax.axvline(0.0, color=theme.ink, linewidth=0.8)
    low, high = ax.get_xlim()
    high = max(high, 0.05 * (high - low))
    ax.set_xlim(low - 0.02 * (high - low), high + 0.16 * (high - low))
    look = {"transform": ax.get_yaxis_transform(), "ha": "right", "va": "center", "size": "small", "color": theme.ink}
    for row, value in enumerate(energy.G[shown].tolist()):
        number = f"{value:.2f}" if abs(value) >= 0.1 or not value else f"{value:.1e}"
        ax.text(0.99, row, number.replace("-", "−"), **look)
    ax.set_yticks(rows, [("▶ " if i == plan.chosen else "") + _name(plan, i) for i in shown], parse_math=False)
    ax.get_yticklabels()[shown.index(plan.chosen)].set_fontweight("bold")
    ax.set_ylim(len(shown) - 0.4, -0.6)
    ax.set_xlabel("expected free energy (nats)")
    legend_below(ax)
    return ax


def signed_label(term: Term) -> str:
    """What a term is called where it is shown with the sign that it has in G."""
    return f"−{term.label}" if term.sign < 0.0 else term.label


def line_look(term: Term, number: int, theme: Theme) -> dict[str, Any]:
    """How the line of the term of this number is drawn."""
    from matplotlib.colors import to_rgb

    return {"color": theme.line(to_rgb(term.colour)), "linestyle": _LINES[number % len(_LINES)]}


def _name(plan: Plan, policy: int) -> str:
    """The actions in order, repeats counted, such as "3 up, left"."""
    names = [plan.model.motions.names[action] for action in plan.policies[policy].tolist()]
    runs = [(name, len(list(group))) for name, group in groupby(names)]
    text = ", ".join(name if count == 1 else f"{count} {name}" for name, count in runs)
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 1]}…"
