"""The study `goals`: steps to a preferred sight against the exact shortest path, with a map and without."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ...agent import Settings
from ...model.errors import CogmapError
from ...worlds import MAZES, Label, Maze
from ..navigating import WEIGHT, NavigateRun, navigate
from ..pool import map_tasks
from .goals_summary import Summary, summarise_goals
from .intervals import Interval

DIFFER, REPEAT = "sights differ", "sights repeat"
"""Mazes without and with rooms that look alike."""

Task = tuple[str, bool, int]
"""World, whether its map is known, seed."""


@dataclass(frozen=True, slots=True)
class GoalRun:
    """One way to a goal.

    Attributes:
        world: name of the maze.
        aliased: whether several of its rooms look alike.
        goal: the label to go to, drawn by the seed.
        known: whether the maze was explored before.
        run: how it went.
    """

    world: str
    aliased: bool
    goal: Label
    known: bool
    run: NavigateRun

    def to_dict(self) -> dict[str, Any]:
        """The run as plain JSON values."""
        return {
            "world": self.world,
            "aliased": self.aliased,
            "goal": self.goal,
            "known": self.known,
            **self.run.to_dict(),
        }


@dataclass(frozen=True, slots=True)
class GoalsResult:
    """All runs of the study.

    Attributes:
        agents: runs in each maze, with a map and without.
        seed: of the first run in each.
        weight: log preference of the goal, in nats.
        settings: of the agents.
        runs: in the order of the mazes, those with a map first.
    """

    agents: int
    seed: int
    weight: float
    settings: Settings
    runs: tuple[GoalRun, ...]

    @property
    def worlds(self) -> tuple[str, ...]:
        """Names of the mazes, in order."""
        return tuple(dict.fromkeys(row.world for row in self.runs))

    def select(
        self,
        *,
        known: bool,
        world: str | None = None,
        aliased: bool | None = None,
        between: tuple[float, float] | None = None,
    ) -> Summary:
        """What the runs come to that fit; `between` bounds the length of the shortest path, ends included."""
        least, most = between or (0.0, np.inf)
        rows = [
            row.run
            for row in self.runs
            if row.known == known
            and world in (None, row.world)
            and aliased in (None, row.aliased)
            and (between is None or (row.run.shortest is not None and least <= row.run.shortest <= most))
        ]
        return summarise_goals(rows)

    def to_dict(self) -> dict[str, Any]:
        """Arguments, runs and a summary a maze, as plain JSON values."""
        return {
            "study": "goals",
            "agents": self.agents,
            "seed": self.seed,
            "weight": self.weight,
            "settings": self.settings.to_dict(),
            "runs": [row.to_dict() for row in self.runs],
            "summary": [
                {"world": world, "known": known, **self.select(known=known, world=world).to_dict()}
                for world in self.worlds
                for known in (True, False)
            ],
        }


def goals_study(
    *,
    agents: int,
    seed: int = 0,
    settings: Settings | None = None,
    executor: Executor | None = None,
    on_done: Callable[[], None] | None = None,
) -> GoalsResult:
    """Send agents to goals in the eight mazes, each once with a map and once without.

    Args:
        agents: runs in each maze, with the seeds `seed`, `seed + 1`, ...
        seed: of the first run; a run's seed draws start, goal and agent.
        settings: of the agents.
        executor: where the agents run, in this process if None; the result does not depend on it.
        on_done: called after each of the `goals_tasks(agents)` runs.

    Raises:
        CogmapError: `agents` is below 1, or `seed` below 0.
    """
    if agents < 1:
        raise CogmapError(f"goals: agents is {agents}; use 1 or more")
    if seed < 0:
        raise CogmapError(f"goals: seed is {seed}; use 0 or more")
    tasks = [(world, known, seed + i) for world in MAZES for known in (True, False) for i in range(agents)]
    runs = map_tasks(partial(_run, settings), tasks, executor=executor, on_done=on_done)
    return GoalsResult(agents, seed, WEIGHT, settings or Settings(), tuple(runs))


def goals_lines(result: GoalsResult) -> list[str]:
    """Steps in every maze, with 95 % intervals; failed runs are named by their seeds."""
    lines: list[str] = []
    for known in (True, False):
        title = "with a map, moved without a word" if known else "in an unknown maze"
        heads = ("reached", "first there", "stays", *(() if known else ("nearest frontier",)), "shortest", "ratio")
        lines += [f"{title}: steps, mean [95 %]", _columns("", heads)]
        groups = {world: result.select(known=known, world=world) for world in result.worlds}
        groups |= {DIFFER: result.select(known=known, aliased=False), REPEAT: result.select(known=known, aliased=True)}
        lines += [_columns(name, _cells(summary, known)) for name, summary in groups.items()]
    failed = [row for row in result.runs if not row.run.reached]
    return lines + [
        f"failed: {row.world}, {'with a map' if row.known else 'unknown'}, goal {row.goal}, seed {row.run.seed}"
        for row in failed
    ]


def goals_tasks(agents: int) -> int:
    """How many runs the study makes."""
    return 2 * len(MAZES) * agents


def draw_goal(maze: Maze, seed: int) -> Label:
    """One of the labels of the maze; start and agent of the same seed have streams of their own."""
    labels = sorted(set(maze.sights.values()), key=lambda label: (str(type(label)), label))
    stream = np.random.SeedSequence(seed).spawn(4)[3]  # `draw_start` uses the first three
    return labels[int(np.random.default_rng(stream).integers(len(labels)))]


def _run(settings: Settings | None, task: Task) -> GoalRun:
    world, known, seed = task
    maze = MAZES[world]
    goal = draw_goal(maze, seed)
    run = navigate(maze, goal=goal, known=known, settings=settings, seed=seed)
    return GoalRun(world, len(set(maze.sights.values())) < len(maze.rooms), goal, known, run)


def _cells(summary: Summary, known: bool) -> list[str]:
    means = [summary.to_stand, summary.steps, *(() if known else (summary.frontier,)), summary.shortest, summary.ratio]
    return [f"{summary.runs - summary.failed}/{summary.runs}", *(_text(mean) for mean in means)]


def _text(mean: Interval | None) -> str:
    return "-" if mean is None else f"{mean.value:.2f} [{mean.low:.2f}, {mean.high:.2f}]"


def _columns(name: str, cells: Sequence[str]) -> str:
    return f"  {name:<14}{cells[0]:>9}" + "".join(f"{cell:>21}" for cell in cells[1:])
