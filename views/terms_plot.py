"""What the best policies are worth, term by term."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np

from ..model import CogmapError
from ..planning import Plan
from .axes import axes_or_new, legend_below
from .terms import NOTHING, bar_look, signed_label
from .theme import Theme, theme_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LONGEST = 34  # signs of a policy's name


def plot_terms(plan: Plan, *, most: int = 8, title: str | None = None, ax: Axes | None = None) -> Axes:
    """The policies with the least G, best on top, each as bars of its terms in nats; their sum is the diamond, G.

    Information and utility count against G and go to the left, the risk of collision to the right. The chosen policy
    is marked by ▶; it comes last where others are better.

    Args:
        plan: what the agent considered.
        most: policies that are shown, 1 or more.
        title: above the plot.
        ax: axes to draw on; new ones unless given.

    Raises:
        CogmapError: `most` is below 1.
    """
    if most < 1:
        raise CogmapError(f"plot_terms: most is {most}; use 1 or more")
    shown = best_policies(plan, most)
    ax = axes_or_new(ax, title, size=(8.0, 1.9 + 0.36 * len(shown)))
    theme = theme_of(ax)
    _draw_terms(ax, plan, shown, theme)
    _draw_sums(ax, plan, shown, theme)
    names = [f"▶ {policy_name(plan, i)}" if i == plan.chosen else policy_name(plan, i) for i in shown]
    ax.set_yticks(range(len(shown)), names, parse_math=False)
    ax.get_yticklabels()[shown.index(plan.chosen)].set_fontweight("bold")
    ax.set_ylim(len(shown) - 0.4, -0.6)
    ax.set_xlabel("expected free energy (nats)")
    legend_below(ax)
    return ax


def best_policies(plan: Plan, most: int) -> list[int]:
    """Indices of the policies with the least G, in that order, the chosen one among them."""
    G = plan.expected_free_energy.G
    order = sorted(np.argsort(G, kind="stable").tolist(), key=lambda i: (round(float(G[i]), 9), i != plan.chosen))
    return order[:most] if plan.chosen in order[:most] else [*order[: most - 1], plan.chosen]


def policy_name(plan: Plan, policy: int) -> str:
    """The actions in order, repeats counted, such as "3 up, left"."""
    names = [plan.model.motions.names[action] for action in plan.policies[policy].tolist()]
    runs = [(name, len(list(group))) for name, group in groupby(names)]
    text = ", ".join(name if count == 1 else f"{count} {name}" for name, count in runs)
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 1]}…"


def _draw_terms(ax: Axes, plan: Plan, shown: Sequence[int], theme: Theme) -> None:
    """Bars one beside the other from zero: to the left what lowers G, to the right what raises it."""
    rows = np.arange(len(shown))
    ends = {-1.0: np.zeros(len(shown)), 1.0: np.zeros(len(shown))}
    energy = plan.expected_free_energy
    for number, term in enumerate(energy.terms):
        values = term.sign * energy[term.name][shown]
        if np.abs(values).max() <= NOTHING:
            continue
        left = np.where(values < 0.0, ends[-1.0], ends[1.0])
        ax.barh(rows, values, left=left, height=0.7, label=signed_label(term), **bar_look(term, number, theme))
        ends[-1.0] += np.minimum(values, 0.0)
        ends[1.0] += np.maximum(values, 0.0)


def _draw_sums(ax: Axes, plan: Plan, shown: Sequence[int], theme: Theme) -> None:
    G = plan.expected_free_energy.G[list(shown)]
    look: dict[str, Any] = {"s": 42, "marker": "D", "color": theme.ink, "edgecolors": theme.paper, "zorder": 4}
    ax.scatter(G, range(len(shown)), label="G", **look)
    ax.axvline(0.0, color=theme.ink, linewidth=0.8)
    low, high = ax.get_xlim()
    high = max(high, 0.05 * (high - low))
    ax.set_xlim(low - 0.02 * (high - low), high + 0.16 * (high - low))
    for row, value in enumerate(G.tolist()):
        at: dict[str, Any] = {"transform": ax.get_yaxis_transform(), "ha": "right", "va": "center", "size": "small"}
        ax.text(0.99, row, _number(value), color=theme.ink, **at)


def _number(value: float) -> str:
    return (f"{value:.2f}" if abs(value) >= 0.1 or not value else f"{value:.1e}").replace("-", "−")
