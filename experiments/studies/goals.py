"""The study `goals`: steps to a preferred sight against the exact shortest path, with a map and without."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ...agent import Settings
from ...views import BLUE, GREEN, GREY, ORANGE, VERMILION, theme_of
from ...worlds import MAZES, Label, Maze
from .. import WEIGHT, NavigateRun, Record, navigate
from .figures import Axes, Figure, Look, panels, plot_bars
from .intervals import Interval, bootstrap
from .study import Findings, Study

ALIASED = {False: "sights differ", True: "sights repeat"}  # mazes without and with rooms that look alike
HOW = {True: "with a map, moved without a word", False: "in an unknown maze"}
DISTANCES = {**{str(length): range(length, length + 1) for length in range(5)}, "5, 6": range(5, 7)}
DISTANCES["7 or more"] = range(7, 10**9)  # lengths of the shortest path that are shown together
MARKS = {
    "shortest": ("_", "shortest path", 14.0, GREY),
    "to_stand": ("o", "agent first there", 6.0, GREEN),
    "frontier": ("D", "nearest-frontier search first there", 6.0, (1.0, 1.0, 1.0)),
}


@dataclass(frozen=True, slots=True)
class GoalRun(Record):
    """One way to a goal."""

    world: str
    aliased: bool  # whether several rooms of the maze look alike
    goal: Label  # to go to, drawn by the seed
    known: bool  # whether the maze was explored before
    run: NavigateRun


class Goals(Study[tuple[str, bool, int], GoalRun]):
    """Steps to a goal

    How many moves to a preferred sight, against the exact shortest path: with a map, after a move without a
    word, and in an unknown maze, against nearest-frontier search?
    """

    name = "goals"
    notes = (
        "A goal is reached when the agent chooses to stay on it; passing through does not count.",
        "The authors' agent is told that it was moved, its belief is reset; ours is not told.",
    )

    def tasks(self, seeds: Sequence[int], settings: Settings) -> list[tuple[str, bool, int]]:
        """Each maze with a map and without, with every seed, which draws start, goal and agent."""
        return [(world, known, seed) for world in MAZES for known in (True, False) for seed in seeds]

    def run(self, task: tuple[str, bool, int], settings: Settings) -> GoalRun:
        world, known, seed = task
        maze = MAZES[world]
        goal, aliased = draw_goal(maze, seed), len(set(maze.sights.values())) < len(maze.rooms)
        return GoalRun(world, aliased, goal, known, navigate(maze, seed, goal=goal, known=known, settings=settings))

    def summarise(self, rows: Sequence[GoalRun]) -> Findings:
        summary = {(world, known): summarised(rows, world=world, known=known) for world in MAZES for known in HOW}
        by_world = [{"world": world, "known": known, **part} for (world, known), part in summary.items()]
        lines, failed = _lines(rows, summary), list[str]()
        for row in rows:
            if not row.run.reached:
                end, how = f"goal {row.goal}, seed {row.run.seed}", "with a map" if row.known else "without a map"
                lines.append(f"failed: {row.world}, {'with a map' if row.known else 'unknown'}, {end}")
                failed.append(f"{row.world}, {how}, {end}: not reached")
        figures = {"goals_by_distance": partial(_by_distance, rows), "goals_by_world": partial(_by_world, summary)}
        return Findings({"weight": WEIGHT, "runs": rows, "summary": by_world}, lines, figures, failed=failed)


def summarised(rows: Sequence[GoalRun], **those: object) -> dict[str, Any]:
    """What the rows come to whose fields are as in `those`.

    Failed are those that never chose to stay on the goal, or never knew the maze; the other figures are of those that
    reached it. The ratio is that of all steps to all shortest paths.
    """
    every = [row.run for row in rows if all(getattr(row, name) == value for name, value in those.items())]
    there = [run for run in every if run.reached]
    steps, shortest = [run.steps or 0 for run in there], [run.shortest or 0 for run in there]
    return {
        "runs": len(every),
        "failed": len(every) - len(there),
        "steps": bootstrap(steps),
        "to_stand": bootstrap([run.steps_to_stand or 0 for run in there]),
        "shortest": bootstrap(shortest),
        "frontier": bootstrap([run.frontier_steps for run in there if run.frontier_steps is not None]),
        "ratio": bootstrap(steps, shortest),
    }


def draw_goal(maze: Maze, seed: int) -> Label:
    """One of the labels of the maze; start and agent of the same seed have streams of their own."""
    labels = sorted(set(maze.sights.values()), key=lambda label: (str(type(label)), label))
    stream = np.random.SeedSequence(seed).spawn(4)[3]  # start, agent and moves have the first three
    return labels[int(np.random.default_rng(stream).integers(len(labels)))]


def _lines(rows: Sequence[GoalRun], summary: dict[tuple[str, bool], dict[str, Any]]) -> list[str]:
    """Steps in every maze, with 95 % intervals."""
    lines: list[str] = []
    for known, title in HOW.items():
        heads = {"to_stand": "first there", "steps": "stays", "frontier": "nearest frontier", "shortest": "shortest"}
        shown = {what: head for what, head in {**heads, "ratio": "ratio"}.items() if not known or what != "frontier"}
        groups = {world: summary[world, known] for world in MAZES}
        groups |= {name: summarised(rows, known=known, aliased=aliased) for aliased, name in ALIASED.items()}
        cells = {"": ["reached", *shown.values()]}
        for name, part in groups.items():
            means = [_text(part[what]) for what in shown]
            cells[name] = [f"{part['runs'] - part['failed']}/{part['runs']}", *means]
        lines.append(f"{title}: steps, mean [95 %]")
        lines += [f"  {name:<14}{x:>9}" + "".join(f"{y:>21}" for y in rest) for name, (x, *rest) in cells.items()]
    return lines


def _text(mean: Interval | None) -> str:
    return "-" if mean is None else f"{mean.value:.2f} [{mean.low:.2f}, {mean.high:.2f}]"


def _by_distance(rows: Sequence[GoalRun]) -> Figure:
    title = "Steps to the goal, by the length of the shortest path (bars: mean, 95 % bootstrap)"
    figure, axes = panels(title, (1, 2), (11.0, 4.6))
    led = [(row.run.shortest, row) for row in rows if row.run.shortest is not None]
    near = [[row for steps, row in led if steps in distance] for distance in DISTANCES.values()]
    for ax, known in zip(axes, HOW, strict=True):
        marks = ("shortest",) if known else ("shortest", "to_stand", "frontier")
        for shift, (aliased, name), colour in zip((-0.2, 0.2), ALIASED.items(), (BLUE, ORANGE), strict=True):
            groups = [summarised(part, known=known, aliased=aliased) for part in near]
            at, steps = [i + shift for i in range(len(groups))], [group["steps"] for group in groups]
            plot_bars(ax, at, steps, width=0.38, color=colour, label=name)
            _draw_marks(ax, shift, groups, marks, named=not aliased)
        ax.set_xticks(range(len(near)), list(DISTANCES))
        ax.set_xlabel("steps of the shortest path")
        _finish(ax, known)
    return figure


def _by_world(summary: dict[tuple[str, bool], dict[str, Any]]) -> Figure:
    figure, axes = panels("Steps to the goal, by maze (bars: mean, 95 % bootstrap)", (1, 2), (11.0, 4.6))
    stays, stands = ("steps", "agent stays", BLUE), ("to_stand", MARKS["to_stand"][1], GREEN)
    series = {True: [stays], False: [stands, stays, ("frontier", MARKS["frontier"][1], GREY)]}
    for ax, known in zip(axes, HOW, strict=True):
        groups, width = [summary[world, known] for world in MAZES], 0.8 / max(len(series[known]), 2)
        for number, (what, name, colour) in enumerate(series[known]):
            at = [i + (number - (len(series[known]) - 1) / 2) * width for i in range(len(groups))]
            plot_bars(ax, at, [group[what] for group in groups], width=width * 0.95, color=colour, label=name)
        _draw_marks(ax, 0.0, groups, ["shortest"])
        ax.set_xticks(range(len(groups)), list(MAZES), rotation=30, ha="right")
        _finish(ax, known)
    return figure


def _draw_marks(
    ax: Axes, shift: float, groups: Sequence[dict[str, Any]], marks: Sequence[str], *, named: bool = True
) -> None:
    """Marks over the bars, and how many failed."""
    for what in marks:
        marker, name, size, colour = MARKS[what]
        values = [value.value if (value := group[what]) else np.nan for group in groups]
        look: Look = {"marker": marker, "markersize": size, "markerfacecolor": colour, "linestyle": "none"}
        look |= {"markeredgecolor": theme_of(ax).ink, "markeredgewidth": size / 7.0, "label": name if named else None}
        ax.plot([i + shift for i in range(len(groups))], values, zorder=4, **look)
    text: Look = {"textcoords": "offset points", "color": VERMILION, "fontsize": 7, "rotation": 90}
    for i, group in enumerate(groups):
        if group["failed"]:
            top = group["steps"].high if group["steps"] else 0.0
            ax.annotate(f"{group['failed']} of {group['runs']} failed", (i + shift, top), (0, 4), ha="center", **text)


def _finish(ax: Axes, known: bool) -> None:
    ax.set_title(HOW[known])
    ax.set_ylabel("steps until the agent stays on the goal" if known else "steps")
    ax.set_ylim(bottom=0.0)
    ax.legend(fontsize=8, frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=3)
