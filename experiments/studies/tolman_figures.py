"""Figures of the study of Tolman's maze."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from .shares import Share, wilson
from .tolman import KNOB, TolmanResult
from .tolman_flow import plot_flow
from .tolman_maze import ROUTES
from .tolman_rows import BLOCKS, PAPER, PAPER_RUNS, TolmanCounts, compared, paper_counts

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = {1: "#0072b2", 2: "#e69f00", 3: "#009e73", None: "#bbbbbb"}
"""Of the routes, and of a missed goal."""


def tolman_figures(result: TolmanResult) -> dict[str, Figure]:
    """Flow through the maze, counts by route beside the paper's, every run, and the knob."""
    return {
        "tolman_flow": _flow(result),
        "tolman_routes": _routes(result),
        "tolman_runs": _runs(result),
        "tolman_knob": _knob(result),
    }


def _flow(result: TolmanResult) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12.0, 5.2), layout="constrained")
    figure.suptitle("Ways to the goal: the wider and darker, the more often (runs that reached it)", fontsize=13)
    axes = figure.subplots(1, len(BLOCKS))
    for block, (ax, (name, closed)) in enumerate(zip(axes, BLOCKS.items(), strict=True)):
        runs = [run for row in result.rows for run in row.blocks[block] if run.reached_at is not None]
        plot_flow([run.path[: (run.reached_at or 0) + 1] for run in runs], closed=closed, ax=ax)
        ax.set_title(f"{name}: {result.counts[block].goal.count} of {result.counts[block].runs} runs", fontsize=12)
    return figure


def _routes(result: TolmanResult) -> Figure:
    from matplotlib.figure import Figure
    from matplotlib.ticker import PercentFormatter

    figure = Figure(figsize=(12.0, 4.6), layout="constrained")
    agents = len(result.rows)
    title = f"Share of all runs by route ({agents} agent{'s' if agents > 1 else ''}), with 95 % intervals (Wilson)"
    figure.suptitle(title, fontsize=13)
    axes = figure.subplots(1, len(BLOCKS), sharey=True)
    for ax, name, counts in zip(axes, BLOCKS, result.counts, strict=True):
        _draw_routes(ax, name, counts)
    axes[0].set_ylabel("share of the runs")
    axes[0].set_ylim(0.0, 1.0)
    axes[0].yaxis.set_major_formatter(PercentFormatter(1.0))
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False)
    return figure


def _draw_routes(ax: Axes, name: str, counts: TolmanCounts) -> None:
    paper = [wilson(count, PAPER_RUNS) for count in PAPER[name]]
    none = wilson(counts.runs - sum(counts.attempted), counts.runs)
    missed = wilson(counts.runs - sum(counts.reached), counts.runs)
    paper_missed = wilson(paper_counts(name)[-1], PAPER_RUNS)
    _bars(ax, -0.27, [*counts.shares("attempted"), none], "first set out on", color="#56b4e9")
    _bars(ax, 0.0, [*counts.shares("reached"), missed], "goal reached on it", color="#0072b2")
    _bars(ax, 0.27, [*paper, paper_missed], "the paper", color="white", edgecolor="0.3", hatch="///")
    ax.set_xticks(range(len(ROUTES) + 1), [*(f"route {route}" for route in ROUTES), "none"])
    ax.set_title(f"{name} (paper: attempts)" if name == "B closed" else name, fontsize=12)
    ax.spines[["top", "right"]].set_visible(False)


def _bars(ax: Axes, shift: float, shares: Sequence[Share], label: str, **style: str) -> None:
    at = [place + shift for place in range(len(shares))]
    errors = [[share.share - share.low for share in shares], [share.high - share.share for share in shares]]
    ax.bar(at, [share.share for share in shares], width=0.25, label=label, **style)  # pyright: ignore[reportArgumentType]
    ax.errorbar(at, [share.share for share in shares], yerr=errors, fmt="none", ecolor="0.2", capsize=2, linewidth=1.0)
    for place, share in zip(at, shares, strict=True):
        ax.text(place, share.high + 0.012, str(share.count), ha="center", va="bottom", size=9)


def _runs(result: TolmanResult) -> Figure:
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch, Rectangle

    length = len(result.rows[0].blocks[0])
    figure = Figure(figsize=(12.0, 1.7 + 0.33 * len(result.rows)), layout="constrained")
    figure.suptitle(
        "Every run: the route on which the goal was reached, and the number of the one first set out on if another"
    )
    ax = figure.subplots()
    for line, row in enumerate(result.rows):
        for number, run in enumerate(run for block in row.blocks for run in block):
            across = number + 0.6 * (number // length)
            ax.add_patch(Rectangle((across, line + 0.08), 1.0, 0.84, facecolor=COLOURS[run.route], edgecolor="white"))
            if run.attempted != run.route:
                ax.text(across + 0.5, line + 0.5, str(run.attempted or "–"), ha="center", va="center", size=9)
    for block, name in enumerate(BLOCKS):
        ax.text(block * (length + 0.6) + length / 2, -0.25, name, ha="center", va="bottom", size=11)
    ax.set_xlim(-0.2, len(BLOCKS) * (length + 0.6))
    ax.set_ylim(len(result.rows), -1.0)
    ax.set_yticks([line + 0.5 for line in range(len(result.rows))], [f"seed {row.seed}" for row in result.rows])
    ax.set_xticks([])
    ax.tick_params(length=0)
    ax.spines[:].set_visible(False)
    named = [(f"route {route}" if route else "missed", colour) for route, colour in COLOURS.items()]
    patches = [Patch(color=colour, label=name) for name, colour in named]
    figure.legend(handles=patches, loc="outside lower center", ncols=len(patches), frameon=False)
    return figure


def _knob(result: TolmanResult) -> Figure:
    from matplotlib.figure import Figure
    from matplotlib.ticker import PercentFormatter

    figure = Figure(figsize=(12.0, 4.8), layout="constrained")
    near = result.nearest
    figure.suptitle(
        f"The balance of exploring and exploiting; nearest to the paper's table: {KNOB} = {near.value:g} "
        f"(total variation {near.distance:.2f})",
        fontsize=13,
    )
    axes = figure.subplots(1, len(BLOCKS), sharey=True)
    for block, (ax, name) in enumerate(zip(axes, BLOCKS, strict=True)):
        _draw_knob(ax, result, block)
        ax.set_title(f"{name} (routes 2, 3: attempts)" if name == "B closed" else name, fontsize=12)
        ax.set_xlabel(KNOB)
    axes[0].set_ylabel("share of the runs")
    axes[0].set_ylim(-0.03, 1.03)
    axes[0].yaxis.set_major_formatter(PercentFormatter(1.0))
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=6, frameon=False)
    return figure


def _draw_knob(ax: Axes, result: TolmanResult, block: int) -> None:
    name = list(BLOCKS)[block]
    places = range(len(result.knob))
    ax.axvline([s.value for s in result.knob].index(result.nearest.value), color="0.88", linewidth=14, zorder=0)
    styles = zip((1, 2, 3, None), ("o", "s", "^", "x"), ("-", "--", "-.", ":"), strict=True)
    for index, (route, marker, line) in enumerate(styles):
        if route == 1 and BLOCKS[name] is not None:
            continue
        values = [wilson(compared(s.counts[block], name)[index], s.counts[block].runs) for s in result.knob]
        colour = COLOURS[route] if route else "0.45"
        errors = [[v.share - v.low for v in values], [v.high - v.share for v in values]]
        shift = 0.06 * (index - 1.5)
        ax.errorbar(
            [place + shift for place in places],
            [v.share for v in values],
            yerr=errors,
            label=f"route {route}" if route else "none of these",
            color=colour,
            marker=marker,
            linestyle=line,
            markersize=6,
            capsize=2,
            elinewidth=0.8,
        )
        paper = paper_counts(name)[index] / PAPER_RUNS
        ax.plot(len(result.knob) - 0.25, paper, marker=marker, color=colour, markersize=10, clip_on=False)
    goal = [s.counts[block].goal.share for s in result.knob]
    ax.plot(places, goal, color="black", linewidth=1.0, label="goal reached")
    ticks = [f"{s.value:g}" for s in result.knob]
    ax.set_xticks([*places, len(result.knob) - 0.25], [*ticks, "paper"])
    ax.spines[["top", "right"]].set_visible(False)
