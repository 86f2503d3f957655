"""The figure of the study `cost`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .cost import WORLD, CostResult
from .grid_rows import TITLES
from .published import AUTHORS_SECONDS, PAPER_SECONDS
from .steps_figure import LOOKS, plain

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def cost_figures(result: CostResult) -> dict[str, Figure]:
    """`cost_seconds`: median seconds by model, with the range."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import FuncFormatter

    figure = Figure(figsize=(8.0, 0.5 * len(result.times) + 1.9), layout="constrained")
    ax = figure.add_subplot()
    at = range(len(result.times))
    medians = [time.median for time in result.times]
    below = [time.median - min(time.seconds) for time in result.times]
    above = [max(time.seconds) - time.median for time in result.times]
    ax.set_xscale("log")
    ax.barh(at, medians, 0.6, color=[LOOKS[time.agent].colour for time in result.times])
    ax.errorbar(medians, at, xerr=(below, above), fmt="none", ecolor="black", elinewidth=1.2, capsize=3)
    for figures, marker, name in ((PAPER_SECONDS, "x", "the paper"), (AUTHORS_SECONDS, "D", "the authors' code")):
        found = [(figures[time.agent], i) for i, time in enumerate(result.times) if time.agent in figures]
        xs, ys = zip(*found, strict=True)
        ax.plot(xs, ys, linestyle="none", marker=marker, color="black", markerfacecolor="white", label=name)
    ax.set_yticks(at, [TITLES[time.agent] for time in result.times])
    ax.invert_yaxis()
    ax.set_xlim(min(medians) / 3, max(*medians, *PAPER_SECONDS.values()) * 2)
    ax.xaxis.set_major_formatter(FuncFormatter(plain))
    ax.set_xlabel("seconds (bars: median, lines: range)")
    ax.set_title(f"{result.steps} forced exploring steps in {WORLD}", pad=10)
    ax.spines[["top", "right"]].set_visible(False)
    ax.legend(fontsize=8, frameon=False, loc="lower right")
    return {"cost_seconds": figure}
