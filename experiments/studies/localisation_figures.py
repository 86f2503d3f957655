"""Figures of the study of localisation."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ...views import plot_belief, plot_policies, plot_world
from ...worlds import Position
from .localisation import MAZE, SETTINGS, LocalisationResult, by_step
from .localisation_rows import CANDIDATE, CONDITIONS, Condition, LocalisationStep, LocalisationTrial

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SHOWN = ("told_sights", "silent_doors")
"""Conditions of which the first agent is shown step by step."""

MOST_ROWS = 8
_STYLES = (("#0072b2", "-", "o"), ("#56b4e9", "--", "s"), ("#009e73", (0, (1, 1)), "^"), ("#d55e00", "-.", "D"))


def localisation_figures(result: LocalisationResult) -> dict[str, Figure]:
    """The way of the first agent under two conditions, and all agents step by step; none if nobody explored."""
    figures: dict[str, Figure] = {}
    for condition in CONDITIONS:
        if condition.name in SHOWN and (trials := result.trials(condition.name)):
            figures[f"localisation_{condition.name}"] = _way(trials[0], condition)
    if result.trials(CONDITIONS[0].name):
        figures["localisation_by_step"] = _by_step(result)
    return figures


def _way(trial: LocalisationTrial, condition: Condition) -> Figure:
    from matplotlib.figure import Figure

    steps = trial.steps[:MOST_ROWS]
    figure = Figure(figsize=(11.0, 2.35 * len(steps) + 0.9), layout="constrained")
    figure.suptitle(f"The first agent, moved to the foot of the T: {condition.text}", fontsize=13)
    left, right = figure.subfigures(1, 2, squeeze=False, width_ratios=(1.6, 1.0))[
        0
    ]  # two, so that the mazes are not cut to the bars
    beliefs = left.subplots(len(steps), 1, squeeze=False)[:, 0]
    mazes = right.subplots(len(steps), 1, squeeze=False)[:, 0]
    for number, step in enumerate(steps):
        _draw_belief(step, number, beliefs[number])
        _draw_imagined(step, mazes[number])
    left.supxlabel("sight and room of each place (▲: the true one)", fontsize=11)
    right.supxlabel("imagined paths, darker: more probable (✕: the agent)", fontsize=11)
    return figure


def _draw_belief(step: LocalisationStep, number: int, ax: Axes) -> None:
    belief = {_name(room): q for _, room, q in step.posterior}
    title = f"step {number}: sees {step.sight}; entropy {step.entropy:.2f} nats, {_rooms(step.candidates)}"
    plot_belief(belief, true=_name(step.room), threshold=SETTINGS.certainty, ax=ax)
    ax.set_title(title, fontsize=11)
    ax.set_ylabel("Q(s)")


def _name(room: Position) -> str:
    return f"{MAZE.sights[room]}\n{room[0]}, {room[1]}"


def _rooms(count: int) -> str:
    return f"{count} room{'s' if count > 1 else ''} with {CANDIDATE:.0%} or more"


def _draw_imagined(step: LocalisationStep, ax: Axes) -> None:
    plot_world(MAZE, ax=ax)
    plot_policies({path.rooms: path.probability for path in step.paths}, ax=ax)
    row, column = step.room
    ax.scatter(column, row, marker="X", s=130, color="#d55e00", edgecolors="white", linewidths=1.2, zorder=6)


def _by_step(result: LocalisationResult) -> Figure:
    from matplotlib.figure import Figure
    from matplotlib.ticker import MaxNLocator

    figure = Figure(figsize=(11.0, 4.6), layout="constrained")
    count = len(result.trials(CONDITIONS[0].name))
    figure.suptitle(f"Mean over {count} agent{'s' if count > 1 else ''}, with 95 % intervals (bootstrap)", fontsize=13)
    axes = figure.subplots(1, 2)
    for ax, name, label in (
        (axes[0], "entropy", "entropy of Q(s) (nats)"),
        (axes[1], "candidates", f"rooms with {CANDIDATE:.0%} or more"),
    ):
        for index, condition in enumerate(CONDITIONS):
            _draw_line(ax, result.trials(condition.name), name, condition.text, index)
        ax.set_xlabel("moves since it was put at the foot of the T")
        ax.set_ylabel(label)
        ax.set_ylim(bottom=-0.04 * ax.get_ylim()[1])
        ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    handles, names = axes[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncols=4, frameon=False)
    return figure


def _draw_line(ax: Axes, trials: Sequence[LocalisationTrial], name: str, label: str, index: int) -> None:
    values = by_step(trials, name)
    mean = [value.value for value in values]
    errors = [[value.value - value.low for value in values], [value.high - value.value for value in values]]
    colour, style, marker = _STYLES[index]
    shift = 0.05 * (index - 1.5)  # equal values would hide one another
    moves = [step + shift for step in range(len(mean))]
    ax.errorbar(
        moves, mean, yerr=errors, label=label, color=colour, linestyle=style, marker=marker, markersize=5, capsize=2
    )
