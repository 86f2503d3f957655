"""Figure of the training after Martinet et al."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..text import count
from .martinet_rows import CONDITIONS, EXPECTED, MartinetResult, Preference
from .tolman_figures import COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def martinet_figures(result: MartinetResult) -> dict[str, Figure]:
    """Route choices under the three conditions."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import PercentFormatter

    agents, days = count(len(result.rows), "agent"), count(result.days, "day")
    figure = Figure(figsize=(10.5, 4.4), layout="constrained")
    title = f"Routes chosen by {agents} after {days} of training, mean with 95 % intervals (bootstrap over agents)"
    figure.suptitle(title, fontsize=13)
    axes = figure.subplots(
        1, len(CONDITIONS), sharey=True, width_ratios=[len(routes) for routes in CONDITIONS.values()]
    )
    for ax, name in zip(axes, CONDITIONS, strict=True):
        _draw(ax, result, name)
    axes[0].set_ylabel("share of the runs that count")
    axes[0].set_ylim(0.0, 1.32)
    axes[0].set_yticks([0.0, 0.25, 0.5, 0.75, 1.0])
    axes[0].yaxis.set_major_formatter(PercentFormatter(1.0))
    return {"martinet_routes": figure}


def _draw(ax: Axes, result: MartinetResult, name: str) -> None:
    routes = CONDITIONS[name]
    for place, route in enumerate(routes):
        share = result.share(name, route)
        if share is None:
            continue
        errors = [[share.value - share.low], [share.high - share.value]]
        ax.bar(place, share.value, width=0.65, color=COLOURS[route])
        ax.errorbar(place, share.value, yerr=errors, fmt="none", ecolor="0.2", capsize=4)
        ax.text(place, share.high + 0.02, f"{share.value:.0%}", ha="center", va="bottom", size=10)
    ax.set_xticks(range(len(routes)), [f"route {route}" for route in routes])
    titles = {"free": "first day, nothing closed", "A closed": "A closed", "B closed": "last day, B closed"}
    ax.set_title(titles[name], fontsize=12)
    ax.spines[["top", "right"]].set_visible(False)
    preferences = [part for part in result.preferences() if part.condition == name]
    for height, part in enumerate(preferences):
        _bracket(ax, part, routes, 1.1 + 0.1 * height)
    assert len(preferences) == len(EXPECTED[name])


def _bracket(ax: Axes, part: Preference, routes: tuple[int, ...], height: float) -> None:
    left, right = sorted((routes.index(part.more), routes.index(part.less)))
    ax.plot([left, left, right, right], [height - 0.015, height, height, height - 0.015], color="0.3", linewidth=1.0)
    p = "" if part.p_value is None else f", p < {_above(part.p_value)}"
    ax.text((left + right) / 2, height + 0.008, f"{part.more} > {part.less}{p}", ha="center", va="bottom", size=9)


def _above(p_value: float) -> str:
    """The next of the usual bounds above p."""
    return next((text for text in ("0.0001", "0.001", "0.01", "0.05") if p_value < float(text)), "1")
