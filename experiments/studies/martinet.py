"""The training of Tolman and Honzik (1930) as Martinet et al. ran it: forced runs, free runs, A closed, then B closed.

L.-E. Martinet, D. Sheynikhovich, K. Benchenane, A. Arleo, Spatial learning and action planning in a prefrontal cortical
network model, PLoS Comput. Biol. 7(5): e1002045, 2011, section "Tolman & Honzik's detour task".
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy import stats

from ...agent import Agent, Settings
from ...views import theme_of
from ...worlds import Door, MazeEnv, Position
from .. import count
from .figures import panels, plot_bars, shares_axis
from .intervals import Interval, bootstrap
from .study import Findings, Study, at_least, short
from .tolman_maze import (
    BEFORE,
    BRANCHES,
    COLOURS,
    GATES,
    MAZE,
    ROUTES,
    START,
    A,
    B,
    new_agent,
    new_world,
    set_closed,
    walk,
)
from .tolman_maze import SETTINGS as MAZE_SETTINGS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

DAYS = 7
"""Of training, 12 runs a day; half of the original's, since nothing changes any more after the second."""
FREE = 9
"""Free runs on the first day, after a forced one by each route."""
BLOCKED = 10
"""Runs with A closed on each day from the second, and two free runs among them."""
PROBES = 7
"""Runs with B closed on the last day."""
MOST = 60
"""Steps after which a run is given up; it ends at the goal (the original has no limit)."""
CONDITIONS = {"free": (1, 2, 3), "A closed": (2, 3), "B closed": (2, 3)}
"""Conditions, and the routes that count in each: route 1 is left out where it is closed, as in the original."""
EXPECTED = {"free": ((1, 2), (1, 3)), "A closed": ((2, 3),), "B closed": ((3, 2),)}
"""Which route was taken more often than which by the animals of Martinet et al., each with p < 0.0001 (ANOVA)."""
ENTRANCES: dict[int, Door] = {route: (START, room) for room, route in BRANCHES.items()}


@dataclass(frozen=True, slots=True)
class Run:
    """One run."""

    day: int  # from 1
    condition: str  # `forced`, `free`, `A closed` or `B closed`
    route: int | None  # by which the goal was reached; after a block, the one then chosen; None if neither came about
    steps: int | None  # until the goal, None if it was not reached


@dataclass(frozen=True, slots=True)
class MartinetRow:
    """One agent."""

    seed: int
    counts: dict[str, dict[int, int]]  # by condition, runs by route; of the free runs those of the first day alone
    runs: tuple[Run, ...]

    @classmethod
    def of(cls, seed: int, runs: Sequence[Run]) -> MartinetRow:
        """What these runs come to."""
        taken = {
            name: [run.route for run in runs if run.condition == name and (name != "free" or run.day == 1)]
            for name in CONDITIONS
        }
        return cls(seed, {name: {r: routes.count(r) for r in ROUTES} for name, routes in taken.items()}, tuple(runs))


@dataclass(frozen=True, slots=True)
class Preference:
    """Whether one route is taken more often than another."""

    condition: str
    more: int  # the route that is expected more often
    less: int
    difference: Interval | None  # of their shares, mean of the agents; None if neither was ever taken
    p_value: float | None  # one-sided Wilcoxon signed-rank test over the agents; None with fewer than two


@dataclass(frozen=True)
class Martinet(Study[int, MartinetRow]):
    """Each agent is trained for some days, then B is closed.

    On the first day it is forced through routes 1, 2 and 3 once each (the other two are shut), then it runs freely.
    From the second day on A is closed, but for two runs among them, and routes 2 and 3 are shut until it has been
    there. On the last day B is closed instead of A. What it knows it keeps; between runs it is put back without a word.
    """

    name = "martinet"
    title = "Detours after forced training"
    question = (
        "Forced runs, free runs, room A closed, then room B closed, after Martinet et al. (2011). Are the routes "
        "preferred in the order of their length that is left?"
    )
    notes = ("Half of the original's days of training, since nothing changes any more after the second.",)
    agents = 40
    settings = replace(MAZE_SETTINGS, information_weight=3.0)  # goes and looks whether a door that was shut still is

    days: int = DAYS

    def __post_init__(self) -> None:
        at_least(self.name, 1, days=self.days)

    def run(self, task: int, settings: Settings) -> MartinetRow:
        """The agent with this seed."""
        agent, world, rng = new_agent(settings, task), new_world(), np.random.default_rng([task, self.days])
        runs = [_forced(agent, world, route) for route in ROUTES]
        runs += [_free(agent, world, 1) for _ in range(FREE)]
        for day in range(2, self.days + 1):
            free = free_runs(rng)
            for number in range(BLOCKED + 2):
                runs.append(_free(agent, world, day) if number in free else _blocked(agent, world, day, A))
        return MartinetRow.of(task, [*runs, *(_blocked(agent, world, self.days + 1, B) for _ in range(PROBES))])

    def summarise(self, rows: Sequence[MartinetRow]) -> Findings:
        """Shares of the routes that count, and the comparisons of the original."""
        runs = [run for row in rows for run in row.runs]
        shares = {name: {route: _share(rows, name, route) for route in routes} for name, routes in CONDITIONS.items()}
        preferences = [_preference(rows, name, *pair) for name, pairs in EXPECTED.items() for pair in pairs]
        reached = sum(run.steps is not None for run in runs)
        protocol = {
            "start": START,
            "days": self.days,
            "forced_runs": len(ROUTES),
            "free_runs_first_day": FREE,
            "runs_with_A_closed_a_day": BLOCKED,
            "runs_with_B_closed": PROBES,
            "most_steps_a_run": MOST,
        }
        summary = {"agents": len(rows), "runs": len(runs), "reached": reached, "shares": shares}
        whole = f"{len(rows)} agents, {self.days} days of training; the goal reached in {reached}/{len(runs)} runs"
        return Findings(
            json={
                "world": MAZE.name,
                "protocol": protocol,
                "rows": rows,
                "summary": {**summary, "preferences": preferences},
            },
            lines=[whole, *_lines(shares, preferences)],
            figures={"martinet_routes": partial(_routes, len(rows), self.days, shares, preferences)},
            failed=short("goal reached in", reached, len(runs), "runs"),
        )


def free_runs(rng: np.random.Generator) -> tuple[int, int]:
    """The numbers of a day's two free runs, not one right after the other."""
    while True:
        first, second = sorted(rng.choice(BLOCKED + 2, size=2, replace=False).tolist())
        if second - first > 1:
            return first, second


def _forced(agent: Agent, world: MazeEnv, route: int) -> Run:
    set_closed(world, doors=[door for other, door in ENTRANCES.items() if other != route])
    _, steps = walk(agent, world, steps=MOST, ends=True)
    return Run(1, "forced", None if steps is None else route, steps)


def _free(agent: Agent, world: MazeEnv, day: int) -> Run:
    set_closed(world)
    path, steps = walk(agent, world, steps=MOST, ends=True)
    route = None if steps is None else next((GATES[room] for room in reversed(path) if room in GATES), None)
    return Run(day, "free", route, steps)


def _blocked(agent: Agent, world: MazeEnv, day: int, room: Position) -> Run:
    shut, before = [ENTRANCES[2], ENTRANCES[3]], BEFORE[room]
    set_closed(world, room=room, doors=shut)

    def open_when_met() -> None:
        if world.position == before:
            for door in shut:
                world.open_door(*door)

    path, steps = walk(agent, world, steps=MOST, ends=True, before=open_when_met)
    later = path[path.index(before) :] if before in path else ()
    chosen = [BRANCHES[to] for at, to in pairwise(later) if at == START and to in BRANCHES]
    name = "A closed" if room == A else "B closed"
    return Run(day, name, next((route for route in chosen if route != 1), None), steps)


def _share(rows: Sequence[MartinetRow], condition: str, route: int) -> Interval | None:
    """The share of a route among those that count, with its interval over the agents."""
    counts = [row.counts[condition] for row in rows]
    return bootstrap([count[route] for count in counts], _totals(counts, condition))


def _preference(rows: Sequence[MartinetRow], condition: str, more: int, less: int) -> Preference:
    counts = [row.counts[condition] for row in rows]
    differences = [count[more] - count[less] for count in counts]
    p_value = None
    if len(rows) > 1:
        test: Any = stats.wilcoxon(differences, alternative="greater") if any(differences) else None
        p_value = 1.0 if test is None else float(test.pvalue)
    return Preference(condition, more, less, bootstrap(differences, _totals(counts, condition)), p_value)


def _totals(counts: Sequence[dict[int, int]], condition: str) -> list[int]:
    return [sum(count[route] for route in CONDITIONS[condition]) for count in counts]


def _lines(shares: dict[str, dict[int, Interval | None]], preferences: Sequence[Preference]) -> list[str]:
    lines = [
        f"{name}: {', '.join(f'route {route} {_text(share)}' for route, share in part.items())} (95 % intervals)"
        for name, part in shares.items()
    ]
    for part in preferences:
        p = "-" if part.p_value is None else f"{part.p_value:.2g}"
        lines.append(f"{part.condition}: route {part.more} over {part.less} by {_text(part.difference)}, p = {p}")
    return [*lines, "Martinet et al. 2011, 40 simulated animals: the same order in all four, each p < 0.0001"]


def _text(interval: Interval | None) -> str:
    return "-" if interval is None else f"{interval.value:.0%} ({interval.low:.0%} to {interval.high:.0%})"


def _routes(
    agents: int, days: int, shares: dict[str, dict[int, Interval | None]], preferences: Sequence[Preference]
) -> Figure:
    title = (
        f"Routes chosen by {count(agents, 'agent')} after {count(days, 'day')} of training, "
        "mean with 95 % intervals (bootstrap over agents)"
    )
    figure, axes = panels(title, 3, (10.5, 4.4), sharey=True, width_ratios=[len(part) for part in shares.values()])
    titles = ("first day, nothing closed", "A closed", "last day, B closed")
    for ax, (name, part), above in zip(axes, shares.items(), titles, strict=True):
        for place, (route, share) in enumerate(part.items()):
            plot_bars(
                ax, [place], [share], texts=[f"{share.value:.0%}" if share else ""], width=0.65, color=COLOURS[route]
            )
        ax.set_xticks(range(len(part)), [f"route {route}" for route in part])
        ax.set_title(above, fontsize=12)
        brackets = [preference for preference in preferences if preference.condition == name]
        for number, preference in enumerate(brackets):
            _bracket(ax, preference, list(part), 1.1 + 0.1 * number)
    shares_axis(axes[0], "share of the runs that count", 1.32)
    return figure


def _bracket(ax: Axes, part: Preference, routes: Sequence[int], height: float) -> None:
    left, right = sorted((routes.index(part.more), routes.index(part.less)))
    ends = [height - 0.015, height, height, height - 0.015]
    ax.plot([left, left, right, right], ends, color=theme_of(ax).shade(0.7), linewidth=1.0)
    bounds = (bound for bound in ("0.0001", "0.001", "0.01", "0.05", "1") if (part.p_value or 0.0) < float(bound))
    p = "" if part.p_value is None else f", p < {next(bounds, '1')}"
    ax.text((left + right) / 2, height + 0.008, f"{part.more} > {part.less}{p}", ha="center", va="bottom", size=9)


STUDY = Martinet()
