"""Insight, after Tolman and Honzik (1930): trained in the open maze, then B is closed; is route 3 tried before 2?"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

from scipy import stats

from ...agent import Settings
from ...baselines import HabitAgent
from ...views import theme_of
from ...worlds import GRID, MazeEnv, Position
from .. import mean, number
from .figures import panels, plot_bars, shares_axis
from .intervals import Share, wilson
from .study import Findings, Study, at_least, failed_seeds
from .tolman_maze import (
    COLOURS,
    FORK,
    MAZE,
    ROUTES,
    RUNS,
    SIGHT,
    START,
    STEPS,
    B,
    Choice,
    TolmanRun,
    agent_run,
    choice_after,
    new_agent,
    new_world,
    plot_tolman_flow,
    set_closed,
    walk,
)
from .tolman_maze import SETTINGS as MAZE_SETTINGS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST = 60
"""Runs with B closed after which nobody is waited for any longer."""
WANDER = 5000
"""Steps that the control walks at random before its training, so that it knows what every way pays."""
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
        steps = None if last is None else STEPS * (len(probe) - 1) + last
        return cls(seed, _routes(training), choice_after(probe), steps, tuple(training), tuple(probe))


@dataclass(frozen=True)
class Insight(Study[int, tuple[InsightRow, InsightRow]]):
    """Each agent runs in the open maze, B is closed, and it is seen which way it tries once it has met the block.

    As many controls, which learn by reward and have no map, do the same.

    Attributes:
        runs: without obstacle.
    """

    name = "insight"
    title = "Insight"
    question = (
        "B is closed straight after training in the open maze. Once the block was met, is route 3 tried before "
        "route 2, which leads to the same block? After Tolman and Honzik (1930), with controls that learn by "
        "reward and have no map."
    )
    notes = ("The figures of the rats are from a secondary source.",)
    agents = 40
    settings = replace(MAZE_SETTINGS, forgetting=0.0)  # what was learned is as sure at the test as it was on the way

    runs: int = RUNS

    def __post_init__(self) -> None:
        at_least(self.name, 1, runs=self.runs)

    def run(self, task: int, settings: Settings) -> tuple[InsightRow, InsightRow]:
        """The agent with this seed, and its control."""
        agent = new_agent(settings, task)
        row = _trained(task, self.runs, lambda world: agent_run(agent, world))
        return row, _control(self.runs, task)

    def summarise(self, rows: Sequence[tuple[InsightRow, InsightRow]]) -> Findings:
        """Who tried route 3 before route 2: agents, controls and rats."""
        groups = {"agents": [pair[0] for pair in rows], "controls": [pair[1] for pair in rows]}
        parts = {name: _summary(group) for name, group in groups.items()}
        first = {name: part["route_3_first"] for name, part in parts.items()}
        test: Any = stats.fisher_exact([[s.count, s.of - s.count] for s in first.values()], alternative="greater")
        p_value = float(test.pvalue)  # one-sided: the agents try route 3 first no more often than the controls
        protocol = {
            "start": START,
            "closed": B,
            "training_runs": RUNS,
            "steps_a_run": STEPS,
            "control": f"tabular Q-learning, {WANDER} random steps before its training",
        }
        rats = {"route_3_first": RATS}
        return Findings(
            json={
                "world": MAZE.name,
                "protocol": protocol,
                "rows": groups["agents"],
                "controls": groups["controls"],
                "summary": {**parts, "rats": rats, "p_value": p_value},
            },
            lines=[
                *_lines("agents", parts["agents"]),
                *_lines("controls without a map", parts["controls"]),
                f"rats (Tolman and Honzik 1930): {_text(RATS)}",
                f"agents over controls, Fisher's exact test: p = {p_value:.2g}",
            ],
            figures={"insight_choice": partial(_figure, groups, first)},
            failed=[
                line
                for name, group in groups.items()
                for line in (
                    *failed_seeds(f"{name} never met the block", group, lambda row: row.choice is None),
                    *failed_seeds(f"{name} did not reach the goal again", group, lambda row: row.steps_to_goal is None),
                )
            ],
        )


def _control(runs: int, seed: int) -> InsightRow:
    habit = HabitAgent(GRID, goal=SIGHT, explore=1.0, seed=seed)
    walk(habit, new_world(), steps=WANDER)
    habit.explore = 0.1

    def one_run(world: MazeEnv) -> TolmanRun:
        """From the start; with B closed it does what it is used to."""
        if world.closed_rooms:
            habit.explore = 0.0
        habit.restart()
        path, reached_at = walk(habit, world)
        return TolmanRun.of(path, reached_at, closed=next(iter(world.closed_rooms), None))

    return _trained(seed, runs, one_run)


def _trained(seed: int, runs: int, one_run: Callable[[MazeEnv], TolmanRun]) -> InsightRow:
    world = new_world()
    training = [one_run(world) for _ in range(runs)]
    set_closed(world, room=B)
    probe: list[TolmanRun] = []
    while len(probe) < MOST and not (choice_after(probe) and probe[-1].reached_at is not None):
        probe.append(one_run(world))
    return InsightRow.of(seed, training, probe)


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
    figure, axes = panels(title, 3, (12.0, 5.2), width_ratios=[1.3, 1.0, 1.0])
    theme, names = theme_of(axes[0]), ("agents", "habit alone\n(Q-learning)", "rats (Tolman and\nHonzik 1930)")
    rats = {"color": theme.paper, "edgecolor": theme.shade(0.7), "hatch": "///"}
    for place, (share, style) in enumerate(zip((*first.values(), RATS), ({"color": COLOURS[3]},) * 2 + (rats,))):
        plot_bars(axes[0], [place], [share], texts=[f"{share.count} of {share.of}"], width=0.6, **style)
    axes[0].set_xticks(range(3), names)
    shares_axis(axes[0], "tried route 3 before route 2", 1.12)
    axes[0].set_title("95 % intervals (Wilson)", fontsize=11)
    for ax, (name, rows) in zip(axes[1:], groups.items(), strict=True):
        plot_tolman_flow(ax, [path for row in rows for path in _after(row)], closed=B)
        ax.set_title(f"{name}, from the block to the choice\nand to the end of that run", fontsize=11)
    return figure


def _after(row: InsightRow) -> list[Sequence[Position]]:
    """The paths from the first sight of the block on, up to the run in which something was chosen."""
    met = next((number for number, run in enumerate(row.probe) if run.met_at is not None), None)
    if row.choice is None or met is None:
        return []
    first = row.probe[met]
    paths: list[Sequence[Position]] = [first.path[first.path.index(FORK) :]]
    steps = len(first.path) - (first.met_at or 0)
    for run in row.probe[met + 1 :]:
        if steps >= row.choice.steps:
            break
        paths.append(run.path)
        steps += len(run.path)
    return paths


STUDY = Insight()
