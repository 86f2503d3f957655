"""Figure of the study of insight."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .insight_rows import RATS, InsightResult, InsightRow, route_3_first
from .shares import Share
from .tolman_figures import COLOURS
from .tolman_flow import plot_flow
from .tolman_maze import FORK, B

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def insight_figures(result: InsightResult) -> dict[str, Figure]:
    """Who tried route 3 first, and where agents and controls went until they had chosen."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12.0, 5.2), layout="constrained")
    figure.suptitle("B closed after training in the open maze", fontsize=13)
    axes = figure.subplots(1, 3, width_ratios=[1.3, 1.0, 1.0])
    _draw_shares(axes[0], result)
    for ax, name, rows in ((axes[1], "agents", result.agents), (axes[2], "controls", result.controls)):
        plot_flow([path for row in rows for path in _after(row)], closed=B, ax=ax)
        ax.set_title(f"{name}, from the block to the choice\nand to the end of that run", fontsize=11)
    return {"insight_choice": figure}


def _draw_shares(ax: Axes, result: InsightResult) -> None:
    from matplotlib.ticker import PercentFormatter

    bars: list[tuple[str, Share]] = [
        ("agents", route_3_first(result.agents)),
        ("habit alone\n(Q-learning)", route_3_first(result.controls)),
        ("rats (Tolman and\nHonzik 1930)", RATS),
    ]
    for place, (_, share) in enumerate(bars):
        rats = place == len(bars) - 1
        style = {"color": "white", "edgecolor": "0.3", "hatch": "///"} if rats else {"color": COLOURS[3]}
        ax.bar(place, share.share, width=0.6, **style)  # pyright: ignore[reportArgumentType]
        errors = [[share.share - share.low], [share.high - share.share]]
        ax.errorbar(place, share.share, yerr=errors, fmt="none", ecolor="0.2", capsize=4)
        ax.text(place, share.high + 0.02, f"{share.count} of {share.of}", ha="center", va="bottom", size=10)
    ax.set_xticks(range(len(bars)), [name for name, _ in bars])
    ax.set_ylim(0.0, 1.12)
    ax.set_yticks([0.0, 0.25, 0.5, 0.75, 1.0])
    ax.yaxis.set_major_formatter(PercentFormatter(1.0))
    ax.set_ylabel("tried route 3 before route 2")
    ax.set_title("95 % intervals (Wilson)", fontsize=11)
    ax.spines[["top", "right"]].set_visible(False)


def _after(row: InsightRow) -> list[Sequence[tuple[int, int]]]:
    """The paths from the first sight of the block on, up to the run in which something was chosen."""
    choice = row.choice
    met = next((number for number, run in enumerate(row.probe) if run.met_at is not None), None)
    if choice is None or met is None:
        return []
    paths: list[Sequence[tuple[int, int]]] = []
    steps = -(row.probe[met].met_at or 0)
    for run in row.probe[met:]:
        paths.append(run.path[run.path.index(FORK) :] if run is row.probe[met] else run.path)
        steps += len(run.path)
        if steps >= choice.steps:
            break
    return paths
