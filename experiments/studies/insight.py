"""Insight, after Tolman and Honzik (1930): trained in the open maze, then B is closed; is route 3 tried before 2?"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from scipy import stats

from ...agent import Settings
from ...baselines import HabitAgent
from ...views import theme_of
from ...worlds import GRID, Position
from .. import mean, number
from . import tolman_maze as maze
from .figures import Figure, Way, panels, plot_bars, shares_axis
from .intervals import Share, wilson
from .study import Findings, Study, failed_seeds
from .tolman_maze import ROUTES, Choice, TolmanRun, choice_after

MOST = 60  # runs with B closed after which nobody is waited for any longer
WANDER = 5000  # steps that the control walks at random before its training, so that it knows what every way pays
RATS = wilson(9, 10)
"""Rats that tried route 3 first: Tolman and Honzik, "Insight" in rats, Univ. Calif. Publ. Psychol. 4:215, 1930, after
secondary sources."""


@dataclass(frozen=True, slots=True)
class InsightRow:
    """One agent, or one control."""

    seed: int
    trained_by_route: dict[int, int]
    choice: Choice | None  # what was tried after B was first met; None if it never was
    steps_to_goal: int | None  # with B closed, until the goal was reached again; None if never
    training: tuple[TolmanRun, ...]  # without obstacle
    probe: tuple[TolmanRun, ...]  # with B closed, until the goal was reached again

    @classmethod
    def of(cls, seed: int, training: Sequence[TolmanRun], probe: Sequence[TolmanRun]) -> InsightRow:
        """What these runs come to."""
        last = probe[-1].reached_at
        steps = None if last is None else maze.STEPS * (len(probe) - 1) + last
        return cls(seed, _routes(training), choice_after(probe), steps, tuple(training), tuple(probe))


@dataclass(frozen=True)
class Insight(Study[int, tuple[InsightRow, InsightRow]]):
    """Insight

    B is closed straight after training in the open maze. Once the block was met, is route 3 tried before
    route 2, which leads to the same block? After Tolman and Honzik (1930), with controls that learn by
    reward and have no map.
    """

    name = "insight"
    notes = ("The figures of the rats are from a secondary source.",)
    agents = 40
    settings = replace(maze.SETTINGS, forgetting=0.0)  # what was learned is as sure at the test as it was on the way

    runs: int = maze.RUNS  # without obstacle

    def run(self, task: int, settings: Settings) -> tuple[InsightRow, InsightRow]:
        agent, control = maze.new_agent(settings, task), _control(task)
        return self._trained(task, partial(maze.agent_run, agent)), self._trained(task, control)

    def _trained(self, seed: int, one_run: Callable[[Position | None], TolmanRun]) -> InsightRow:
        training, probe = [one_run(None) for _ in range(self.runs)], list[TolmanRun]()
        while len(probe) < MOST and not (choice_after(probe) and probe[-1].reached_at is not None):
            probe.append(one_run(maze.B))
        return InsightRow.of(seed, training, probe)

    def summarise(self, rows: Sequence[tuple[InsightRow, InsightRow]]) -> Findings:
        groups = {"agents": [pair[0] for pair in rows], "controls": [pair[1] for pair in rows]}
        parts = {name: _summary(group) for name, group in groups.items()}
        first: dict[str, Share] = {name: part["route_3_first"] for name, part in parts.items()}
        test: Any = stats.fisher_exact([[s.count, s.of - s.count] for s in first.values()], alternative="greater")
        p_value = float(test.pvalue)  # one-sided: the agents try route 3 first no more often than the controls
        control = f"tabular Q-learning, {WANDER} random steps before its training"
        protocol = {"start": maze.START, "closed": maze.B, "training_runs": self.runs, "steps_a_run": maze.STEPS}
        summary = {**parts, "rats": {"route_3_first": RATS}, "p_value": p_value}
        json = {"world": maze.MAZE.name, "protocol": {**protocol, "control": control}, "rows": groups["agents"]}
        lines = [*_lines("agents", parts["agents"]), *_lines("controls without a map", parts["controls"])]
        lines.append(f"rats (Tolman and Honzik 1930): {_text(RATS)}")
        lines.append(f"agents over controls, Fisher's exact test: p = {p_value:.2g}")
        failed: list[str] = []
        for name, group in groups.items():
            failed += failed_seeds(f"{name} never met the block", group, lambda row: row.choice is None)
            failed += failed_seeds(f"{name} did not reach the goal again", group, lambda row: row.steps_to_goal is None)
        figures = {"insight_choice": partial(_figure, groups, first)}
        return Findings({**json, "controls": groups["controls"], "summary": summary}, lines, figures, failed=failed)


def _control(seed: int) -> Callable[[Position | None], TolmanRun]:
    habit = HabitAgent(GRID, goal=maze.SIGHT, explore=1.0, seed=seed)
    maze.walk(habit, maze.new_world(), steps=WANDER)

    def one_run(closed: Position | None) -> TolmanRun:
        """From the start; with B closed it does what it is used to."""
        habit.explore = 0.0 if closed else 0.1
        habit.restart()
        return TolmanRun.of(*maze.walk(habit, maze.new_world(closed)), closed)

    return one_run


def _routes(runs: Sequence[TolmanRun]) -> dict[int, int]:
    return {route: sum(run.route == route for run in runs) for route in ROUTES}


def _summary(rows: Sequence[InsightRow]) -> dict[str, Any]:
    """Counts and means over the rows; who never met the block counts against trying route 3."""
    choices = [row.choice for row in rows if row.choice is not None]
    training = [run for row in rows for run in row.training]
    goals = [row.steps_to_goal for row in rows if row.steps_to_goal is not None]
    return {
        "agents": len(rows),
        "training_runs": len(training),
        "trained_by_route": _routes(training),
        "met_block": len(choices),
        "met_by_route": {route: sum(choice.met_by == route for choice in choices) for route in ROUTES},
        "route_3_first": wilson(sum(choice.route == 3 for choice in choices), len(rows)),
        "route_2_first": wilson(sum(choice.route == 2 for choice in choices), len(rows)),
        "route_2_from_the_fork": sum(choice.at_fork for choice in choices),
        "mean_again": mean([choice.again for choice in choices]),
        "mean_steps_to_choice": mean([choice.steps for choice in choices]),
        "reached_again": len(goals),
        "mean_steps_to_goal": mean(goals),
    }


def _lines(name: str, part: dict[str, Any]) -> list[str]:
    return [
        f"{name}: {_text(part['route_3_first'])} tried route 3 first after meeting B",
        f"  trained by route 1, 2, 3 in {', '.join(map(str, part['trained_by_route'].values()))} runs of "
        f"{part['training_runs']}; means: route 1 set out on again {number(part['mean_again'])} times, "
        f"{number(part['mean_steps_to_choice'])} steps from the block to the choice, "
        f"{number(part['mean_steps_to_goal'])} steps to the goal again",
    ]


def _text(share: Share) -> str:
    return f"{share.count} of {share.of} ({share.share:.0%}, 95 % interval {share.low:.0%} to {share.high:.0%})"


def _figure(groups: dict[str, list[InsightRow]], first: dict[str, Share]) -> Figure:
    title = "B closed after training in the open maze"
    figure, (ax, *flows) = panels(title, (1, 3), (12.0, 5.2), width_ratios=[1.3, 1.0, 1.0])
    shares, theme = [*first.values(), RATS], theme_of(ax)
    look = {"color": [maze.COLOURS[3]] * 2 + [theme.paper], "edgecolor": theme.shade(0.7), "hatch": ["", "", "///"]}
    plot_bars(ax, range(3), shares, texts=[f"{share.count} of {share.of}" for share in shares], width=0.6, **look)
    ax.set_xticks(range(3), ["agents", "habit alone\n(Q-learning)", "rats (Tolman and\nHonzik 1930)"])
    ax.set_title("95 % intervals (Wilson)", fontsize=11)
    shares_axis(ax, "tried route 3 before route 2", high=1.12)
    for ax, (name, rows) in zip(flows, groups.items(), strict=True):
        maze.plot_tolman(ax, [path for row in rows for path in _after(row)], closed=maze.B)
        ax.set_title(f"{name}, from the block to the choice\nand to the end of that run", fontsize=11)
    return figure


def _after(row: InsightRow) -> list[Way]:
    """The paths from the first sight of the block on, up to the run in which something was chosen."""
    paths: list[Way] = []
    steps = 0
    for run in row.probe:
        since = run.met_at if not paths else 0
        if row.choice is not None and since is not None and (not paths or steps < row.choice.steps):
            paths.append(run.path[since:])
            steps += len(paths[-1])
    return paths
