"""The study `goals`: steps to a preferred sight against the exact shortest path, with a map and without."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import partial
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np

from ...agent import Settings
from ...views import BLUE, GREEN, GREY, ORANGE, VERMILION, theme_of
from ...worlds import MAZES, Label, Maze
from .. import NavigateRun, navigate
from ..navigating import WEIGHT as GOAL_WEIGHT
from .figures import panels, plot_bars
from .intervals import Interval, bootstrap
from .study import Findings, Study

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

DIFFER, REPEAT = "sights differ", "sights repeat"
"""Mazes without and with rooms that look alike."""
DISTANCES: tuple[tuple[float, float], ...] = ((0, 0), (1, 1), (2, 2), (3, 3), (4, 4), (5, 6), (7, inf))
"""Lengths of the shortest path that are shown together, ends included."""

Task = tuple[str, bool, int]
"""World, whether its map is known, seed."""


@dataclass(frozen=True, slots=True)
class GoalRun:
    """One way to a goal."""

    world: str
    aliased: bool  # whether several rooms of the maze look alike
    goal: Label  # to go to, drawn by the seed
    known: bool  # whether the maze was explored before
    run: NavigateRun

    def to_dict(self) -> dict[str, Any]:
        """The run as plain JSON values."""
        own = {"world": self.world, "aliased": self.aliased, "goal": self.goal, "known": self.known}
        return {**own, **self.run.to_dict()}


@dataclass(frozen=True, slots=True)
class Summary:
    """What some runs come to; steps and ratio are of those that reached the goal."""

    runs: int
    failed: int  # never chose to stay on the goal, or never knew the maze
    steps: Interval | None  # until the agent chose to stay on the goal
    to_stand: Interval | None  # until it first stood there
    shortest: Interval | None  # of the shortest path
    frontier: Interval | None  # of nearest-frontier search until it first stood there; None with a map
    ratio: Interval | None  # total of `steps` over the total of `shortest`; None where that is 0

    @classmethod
    def of(cls, rows: Sequence[GoalRun]) -> Summary:
        """What these runs come to."""
        there = [row.run for row in rows if row.run.reached]
        steps, shortest = [run.steps or 0 for run in there], [run.shortest or 0 for run in there]
        return cls(
            runs=len(rows),
            failed=len(rows) - len(there),
            steps=bootstrap(steps),
            to_stand=bootstrap([run.steps_to_stand or 0 for run in there]),
            shortest=bootstrap(shortest),
            frontier=bootstrap([run.frontier_steps for run in there if run.frontier_steps is not None]),
            ratio=bootstrap(steps, shortest),
        )


class Goals(Study[Task, GoalRun]):
    """Agents are sent to goals in the eight mazes, each once with a map and once without."""

    name = "goals"
    title = "Steps to a goal"
    question = (
        "How many moves to a preferred sight, against the exact shortest path: with a map, after a move without a"
        " word, and in an unknown maze, against nearest-frontier search?"
    )
    notes = (
        "A goal is reached when the agent chooses to stay on it; passing through does not count.",
        "The authors' agent is told that it was moved, its belief is reset; ours is not told.",
    )

    def tasks(self, seeds: Sequence[int], settings: Settings) -> list[Task]:
        """Each maze with a map and without, with every seed, which draws start, goal and agent."""
        return [(world, known, seed) for world in MAZES for known in (True, False) for seed in seeds]

    def run(self, task: Task, settings: Settings) -> GoalRun:
        """One way to a goal."""
        world, known, seed = task
        maze = MAZES[world]
        goal = draw_goal(maze, seed)
        run = navigate(maze, goal=goal, known=known, settings=settings, seed=seed)
        return GoalRun(world, len(set(maze.sights.values())) < len(maze.rooms), goal, known, run)

    def summarise(self, rows: Sequence[GoalRun]) -> Findings:
        """Means by maze and by distance."""
        groups = {(world, known): _select(rows, known, world=world) for world in MAZES for known in (True, False)}
        lost = [row for row in rows if not row.run.reached]
        how = {True: "with a map", False: "without a map"}
        return Findings(
            json={
                "weight": GOAL_WEIGHT,
                "runs": [row.to_dict() for row in rows],
                "summary": [
                    {"world": world, "known": known, **asdict(Summary.of(part))}
                    for (world, known), part in groups.items()
                ],
            },
            lines=_lines(rows, lost),
            figures={"goals_by_distance": partial(_by_distance, rows), "goals_by_world": partial(_by_world, groups)},
            failed=[
                f"{row.world}, {how[row.known]}, goal {row.goal}, seed {row.run.seed}: not reached" for row in lost
            ],
        )


def draw_goal(maze: Maze, seed: int) -> Label:
    """One of the labels of the maze; start and agent of the same seed have streams of their own."""
    labels = sorted(set(maze.sights.values()), key=lambda label: (str(type(label)), label))
    stream = np.random.SeedSequence(seed).spawn(4)[3]  # start, agent and moves have the first three
    return labels[int(np.random.default_rng(stream).integers(len(labels)))]


def _select(
    rows: Sequence[GoalRun], known: bool, *, world: str | None = None, aliased: bool | None = None
) -> list[GoalRun]:
    return [row for row in rows if row.known == known and world in (None, row.world) and aliased in (None, row.aliased)]


def _lines(rows: Sequence[GoalRun], lost: Sequence[GoalRun]) -> list[str]:
    """Steps in every maze, with 95 % intervals; failed runs are named by their seeds."""
    lines: list[str] = []
    for known in (True, False):
        title = "with a map, moved without a word" if known else "in an unknown maze"
        heads = ("reached", "first there", "stays", *(() if known else ("nearest frontier",)), "shortest", "ratio")
        lines += [f"{title}: steps, mean [95 %]", _columns("", heads)]
        groups = {world: _select(rows, known, world=world) for world in MAZES}
        groups |= {DIFFER: _select(rows, known, aliased=False), REPEAT: _select(rows, known, aliased=True)}
        lines += [_columns(name, _cells(Summary.of(part), known)) for name, part in groups.items()]
    return lines + [
        f"failed: {row.world}, {'with a map' if row.known else 'unknown'}, goal {row.goal}, seed {row.run.seed}"
        for row in lost
    ]


def _cells(summary: Summary, known: bool) -> list[str]:
    means = [summary.to_stand, summary.steps, *(() if known else (summary.frontier,)), summary.shortest, summary.ratio]
    texts = ["-" if mean is None else f"{mean.value:.2f} [{mean.low:.2f}, {mean.high:.2f}]" for mean in means]
    return [f"{summary.runs - summary.failed}/{summary.runs}", *texts]


def _columns(name: str, cells: Sequence[str]) -> str:
    return f"  {name:<14}{cells[0]:>9}" + "".join(f"{cell:>21}" for cell in cells[1:])


def _by_distance(rows: Sequence[GoalRun]) -> Figure:
    title = "Steps to the goal, by the length of the shortest path (bars: mean, 95 % bootstrap)"
    figure, axes = panels(title, 2, (11.0, 4.6))
    for ax, known in zip(axes, (True, False), strict=True):
        for shift, aliased, colour in ((-0.2, False, BLUE), (0.2, True, ORANGE)):
            part = _select(rows, known, aliased=aliased)
            groups = [Summary.of([row for row in part if _within(row, distance)]) for distance in DISTANCES]
            at = [i + shift for i in range(len(groups))]
            steps, name = [group.steps for group in groups], REPEAT if aliased else DIFFER
            plot_bars(ax, at, steps, width=0.38, color=colour, label=name)
            _marks(ax, at, [group.shortest for group in groups], "_", "shortest path", named=not aliased)
            if not known:
                stood, frontier = [group.to_stand for group in groups], [group.frontier for group in groups]
                _marks(ax, at, stood, "o", "agent first there", named=not aliased)
                _marks(ax, at, frontier, "D", "nearest-frontier search first there", named=not aliased)
            _failures(ax, at, groups)
        ax.set_xticks(range(len(DISTANCES)), [_distance(*distance) for distance in DISTANCES])
        ax.set_xlabel("steps of the shortest path")
        _finish(ax, known)
    return figure


def _by_world(by_world: dict[tuple[str, bool], list[GoalRun]]) -> Figure:
    figure, axes = panels("Steps to the goal, by maze (bars: mean, 95 % bootstrap)", 2, (11.0, 4.6))
    for ax, known in zip(axes, (True, False), strict=True):
        groups = [Summary.of(by_world[world, known]) for world in MAZES]
        series = [("agent stays", BLUE, [group.steps for group in groups])]
        if not known:
            series.insert(0, ("agent first there", GREEN, [group.to_stand for group in groups]))
            series.append(("nearest-frontier search first there", GREY, [group.frontier for group in groups]))
        width = 0.8 / max(len(series), 2)
        for number, (name, colour, bars) in enumerate(series):
            at = [i + (number - (len(series) - 1) / 2) * width for i in range(len(groups))]
            plot_bars(ax, at, bars, width=width * 0.95, color=colour, label=name)
        _marks(ax, range(len(groups)), [group.shortest for group in groups], "_", "shortest path")
        _failures(ax, range(len(groups)), groups)
        ax.set_xticks(range(len(groups)), list(MAZES), rotation=30, ha="right")
        _finish(ax, known)
    return figure


def _within(row: GoalRun, distance: tuple[float, float]) -> bool:
    return row.run.shortest is not None and distance[0] <= row.run.shortest <= distance[1]


def _marks(
    ax: Axes, at: Sequence[float], means: Sequence[Interval | None], marker: str, name: str, *, named: bool = True
) -> None:
    shown = [(x, mean.value) for x, mean in zip(at, means, strict=True) if mean is not None]
    ink, paper = theme_of(ax).ink, theme_of(ax).paper
    look: dict[str, Any] = {
        "markersize": 6,
        "markerfacecolor": GREEN if marker == "o" else paper,
        "markeredgewidth": 0.8,
    }
    if marker == "_":
        look = {"markersize": 14, "markeredgewidth": 2}
    xs, ys = [x for x, _ in shown], [y for _, y in shown]
    label = name if named else None
    ax.plot(xs, ys, linestyle="none", marker=marker, markeredgecolor=ink, label=label, zorder=4, **look)


def _failures(ax: Axes, at: Sequence[float], groups: Sequence[Summary]) -> None:
    look: dict[str, Any] = {"textcoords": "offset points", "color": VERMILION, "fontsize": 7, "rotation": 90}
    for x, group in zip(at, groups, strict=True):
        if group.failed:
            top = 0.0 if group.steps is None else group.steps.high
            ax.annotate(f"{group.failed} of {group.runs} failed", (x, top), (0, 4), ha="center", **look)


def _distance(least: float, most: float) -> str:
    return f"{least:g}" if least == most else f"{least:g} or more" if most == inf else f"{least:g}, {most:g}"


def _finish(ax: Axes, known: bool) -> None:
    ax.set_title("with a map, moved without a word" if known else "in an unknown maze")
    ax.set_ylabel("steps until the agent stays on the goal" if known else "steps")
    ax.set_ylim(bottom=0.0)
    ax.legend(fontsize=8, frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=3)


STUDY = Goals()
