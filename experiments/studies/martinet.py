"""The training of Tolman and Honzik (1930) as Martinet et al. ran it: forced runs, free runs, A closed, then B closed.

L.-E. Martinet, D. Sheynikhovich, K. Benchenane, A. Arleo, Spatial learning and action planning in a prefrontal cortical
network model, PLoS Comput. Biol. 7(5): e1002045, 2011, section "Tolman & Honzik's detour task".
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
from scipy import stats

from ...agent import Agent, Settings
from ...views import plot_world, theme_of
from ...worlds import Door, Position
from .. import Moment
from . import tolman_maze as maze
from .figures import Axes, Figure, draw_room, panels, plot_bars, shares_axis
from .intervals import Interval, bootstrap
from .study import Findings, Study
from .tolman_maze import BRANCHES, ROUTES, START

DAYS = 7  # of training, 12 runs a day
FREE = 9  # free runs on the first day, after a forced one by each route
BLOCKED = 10  # runs with A closed on each day from the second, and two free runs among them
PROBES = 7  # runs with B closed on the last day
MOST = 60  # steps after which a run is given up; it ends at the goal (the original has no limit)
CONDITIONS = {"free": (1, 2, 3), "A closed": (2, 3), "B closed": (2, 3)}
"""Conditions, and the routes that count in each: route 1 is left out where it is closed, as in the original."""
EXPECTED = (("free", 1, 2), ("free", 1, 3), ("A closed", 2, 3), ("B closed", 3, 2))
"""Under which condition which route was taken more often than which by the animals of Martinet et al., each with
p < 0.0001 (ANOVA)."""
ENTRANCES: dict[int, Door] = {route: (START, room) for room, route in BRANCHES.items()}
BOUNDS = ("0.0001", "0.001", "0.01", "0.05", "1")  # usual ones, of a p

Shares = dict[str, dict[int, Interval | None]]  # by condition and route


@dataclass(frozen=True, slots=True)
class Run:
    """One run."""

    day: int  # from 1
    condition: str  # `forced`, `free`, `A closed` or `B closed`
    route: int | None  # by which the goal was reached; after a block, the one then chosen; None if neither came about
    steps: int | None  # until the goal, None if it was not reached
    path: tuple[Position, ...] = ()  # the rooms it was in, one after the other


@dataclass(frozen=True, slots=True)
class MartinetRow:
    """One agent."""

    seed: int
    counts: dict[str, dict[int, int]]  # by condition and route; of the free runs those of the first day alone
    runs: tuple[Run, ...]

    @classmethod
    def of(cls, seed: int, runs: Sequence[Run]) -> MartinetRow:
        """What these runs come to."""
        counted = [run for run in runs if run.condition != "free" or run.day == 1]
        routes = {name: [run.route for run in counted if run.condition == name] for name in CONDITIONS}
        counts = {name: {route: taken.count(route) for route in ROUTES} for name, taken in routes.items()}
        return cls(seed, counts, tuple(runs))


@dataclass(frozen=True)
class Martinet(Study[int, MartinetRow]):
    """Detours after forced training

    Forced runs, free runs, room A closed, then room B closed, after Martinet et al. (2011). Are the routes
    preferred in the order of their length that is left?
    """

    name = "martinet"
    notes = ("Half of the original's days of training, since nothing changes any more after the second.",)
    agents = 40
    settings = replace(maze.SETTINGS, information_weight=3.0)  # goes and looks whether a door that was shut still is

    days: int = DAYS

    def run(self, task: int, settings: Settings) -> MartinetRow:
        """On the first day force the agent through each route once (the others are shut), then let it run freely.

        From the second day on A is closed, but for two runs among them, and routes 2 and 3 are shut until it has been
        there; on the last day B instead of A. What it knows it keeps; between runs it is put back without a word.
        """
        agent, rng = maze.new_agent(settings, task), np.random.default_rng([task, self.days])
        runs = [_run(agent, 1, "forced", route) for route in ROUTES]
        runs += [_run(agent, 1, "free") for _ in range(FREE)]
        for day in range(2, self.days + 1):
            free = free_runs(rng)
            for number in range(BLOCKED + 2):
                runs.append(_run(agent, day, "free" if number in free else "A closed"))
        runs += [_run(agent, self.days + 1, "B closed") for _ in range(PROBES)]
        return MartinetRow.of(task, runs)

    def summarise(self, rows: Sequence[MartinetRow]) -> Findings:
        runs = [run for row in rows for run in row.runs]
        shares: Shares = {
            name: {route: _of_all(rows, name, [row.counts[name][route] for row in rows]) for route in routes}
            for name, routes in CONDITIONS.items()
        }
        preferences = [_preference(rows, *expected) for expected in EXPECTED]
        reached = sum(run.steps is not None for run in runs)
        runs_a_day = {"forced_runs": 3, "free_runs_first_day": FREE, "runs_with_A_closed_a_day": BLOCKED}
        protocol = {"start": START, "days": self.days, **runs_a_day}
        protocol |= {"runs_with_B_closed": PROBES, "most_steps_a_run": MOST}
        counted = {"agents": len(rows), "runs": len(runs), "reached": reached}
        summary = {**counted, "shares": shares, "preferences": preferences}
        json = {"world": maze.MAZE.name, "protocol": protocol, "rows": rows, "summary": summary}
        whole = f"{len(rows)} agents, {self.days} days of training; the goal reached in {reached}/{len(runs)} runs"
        figures = {
            "martinet_routes": partial(_figure, len(rows), self.days, shares, preferences),
            "martinet_occupancy": partial(_maps, {name: occupancy(rows, name) for name in CONDITIONS}),
        }
        failed = [f"goal reached in {reached} of {len(runs)} runs"] if reached < len(runs) else []
        return Findings(json, [whole, *_lines(shares, preferences)], figures, failed=failed)


def free_runs(rng: np.random.Generator) -> tuple[int, int]:
    """The numbers of a day's two free runs, not one right after the other."""
    while True:
        first, second = sorted(rng.choice(BLOCKED + 2, size=2, replace=False).tolist())
        if second - first > 1:
            return first, second


def _run(agent: Agent, day: int, condition: str, forced: int = 0) -> Run:
    room = {"A closed": maze.A, "B closed": maze.B}.get(condition)
    shut = [door for route, door in ENTRANCES.items() if (forced or (1 if room else route)) != route]
    world = maze.new_world(room, shut)

    def open_when_met(moment: Moment) -> None:
        if room is not None and world.position == maze.BEFORE[room]:
            for door in shut:
                world.open_door(*door)

    path, steps = maze.walk(agent, world, steps=MOST, ends=True, watch=open_when_met)
    if room is None:
        gates = [maze.GATES[place] for place in path if place in maze.GATES]
        return Run(day, condition, None if steps is None else forced or gates[-1], steps, tuple(path))
    later = path[path.index(maze.BEFORE[room]) :] if maze.BEFORE[room] in path else ()
    chosen = [BRANCHES[to] for at, to in pairwise(later) if at == START and to in BRANCHES]
    return Run(day, condition, next((route for route in chosen if route != 1), None), steps, tuple(path))


def occupancy(rows: Sequence[MartinetRow], condition: str) -> dict[Position, float]:
    """Share of all steps that was spent in each room under that condition; of the free runs those of the first day."""
    runs = [run for row in rows for run in row.runs if run.condition == condition]
    steps = Counter(room for run in runs if condition != "free" or run.day == 1 for room in run.path)
    return {room: count / steps.total() for room, count in sorted(steps.items())}


def _of_all(rows: Sequence[MartinetRow], condition: str, values: Sequence[int]) -> Interval | None:
    """Runs of each agent over all its runs that count, with the interval over the agents."""
    return bootstrap(values, [sum(row.counts[condition][route] for route in CONDITIONS[condition]) for row in rows])


def _preference(rows: Sequence[MartinetRow], condition: str, more: int, less: int) -> dict[str, Any]:
    """How much more often one route is taken, mean of the agents; None if neither ever was.

    p is that of Wilcoxon's signed-rank test over the agents, one-sided; None with fewer than two.
    """
    differences = [row.counts[condition][more] - row.counts[condition][less] for row in rows]
    test: Any = stats.wilcoxon(differences, alternative="greater") if any(differences) else None
    p_value = None if len(rows) < 2 else 1.0 if test is None else float(test.pvalue)
    difference = _of_all(rows, condition, differences)
    return {"condition": condition, "more": more, "less": less, "difference": difference, "p_value": p_value}


def _lines(shares: Shares, preferences: Sequence[dict[str, Any]]) -> list[str]:
    lines: list[str] = []
    for name, part in shares.items():
        texts = ", ".join(f"route {route} {_text(share)}" for route, share in part.items())
        lines.append(f"{name}: {texts} (95 % intervals)")
    for part in preferences:
        p, by = "-" if part["p_value"] is None else f"{part['p_value']:.2g}", _text(part["difference"])
        lines.append(f"{part['condition']}: route {part['more']} over {part['less']} by {by}, p = {p}")
    return [*lines, "Martinet et al. 2011, 40 simulated animals: the same order in all four, each p < 0.0001"]


def _text(interval: Interval | None) -> str:
    return "-" if interval is None else f"{interval.value:.0%} ({interval.low:.0%} to {interval.high:.0%})"


def _figure(agents: int, days: int, shares: Shares, preferences: Sequence[dict[str, Any]]) -> Figure:
    who, long = f"{agents} agent{'s' * (agents > 1)}", f"{days} day{'s' * (days > 1)}"
    title = f"Routes chosen by {who} after {long} of training, mean with 95 % intervals (bootstrap over agents)"
    widths = [len(part) for part in shares.values()]
    figure, axes = panels(title, (1, 3), (10.5, 4.4), sharey=True, width_ratios=widths)
    titles = ("first day, nothing closed", "A closed", "last day, B closed")
    for ax, (name, part), heading in zip(axes, shares.items(), titles, strict=True):
        texts, colours = [f"{share.value:.0%}" if share else "" for share in part.values()], maze.COLOURS
        there = [colours[route] for route, share in part.items() if share is not None]
        plot_bars(ax, range(len(part)), list(part.values()), texts=texts, width=0.65, color=there)
        ax.set_xticks(range(len(part)), [f"route {route}" for route in part])
        ax.set_title(heading, fontsize=12)
        for number, one in enumerate(one for one in preferences if one["condition"] == name):
            _bracket(ax, one["more"], one["less"], one["p_value"], CONDITIONS[name], 1.1 + 0.1 * number)
    shares_axis(axes[0], "share of the runs that count", high=1.32)
    return figure


def _maps(shares: dict[str, dict[Position, float]]) -> Figure:
    """The maze, its rooms the darker the more steps were spent in them; after the original's occupancy maps."""
    figure, axes = panels("Where the steps were spent (share of all steps under the condition)", (1, 3), (10.5, 4.6))
    titles = ("first day, nothing closed", "A closed", "last day, B closed")
    for ax, (condition, part), title in zip(axes, shares.items(), titles, strict=True):
        shut = {"A closed": maze.A, "B closed": maze.B}.get(condition)
        plot_world(maze.MAZE, closed=[] if shut is None else [shut], title=title, ax=ax)
        theme, most = theme_of(ax), max(part.values(), default=1.0)
        for room in maze.MAZE.rooms:
            share = part.get(room, 0.0)
            draw_room(ax, room, facecolor=theme.shade(0.9 * share / most), edgecolor=theme.shade(0.5), zorder=5)
            ink = theme.paper if share > 0.5 * most else theme.ink
            text = f"{share:.0%}" if share >= 0.005 else ""
            ax.text(room[1], room[0], text, color=ink, ha="center", va="center", size=8, zorder=6)
    return figure


def _bracket(ax: Axes, more: int, less: int, p_value: float | None, routes: Sequence[int], height: float) -> None:
    left, right = sorted((routes.index(more), routes.index(less)))
    ends = [height - 0.015, height, height, height - 0.015]
    ax.plot([left, left, right, right], ends, color=theme_of(ax).shade(0.7), linewidth=1.0)
    above = next((bound for bound in BOUNDS if p_value is not None and p_value < float(bound)), "1")
    text = f"{more} > {less}" + ("" if p_value is None else f", p < {above}")
    ax.text((left + right) / 2, height + 0.008, text, ha="center", va="bottom", size=9)
