"""The study `cost`: the paper's table of the computation time of 100 forced exploring steps."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import partial
from statistics import median
from time import perf_counter
from typing import Any

from ...agent import Settings
from ...views import theme_of
from ...worlds import MAZES, MazeEnv
from .. import CSCG, Parts, draw_start, run
from .figures import Figure, Look, errors, panels
from .grid import LOOKS
from .intervals import Interval
from .study import Findings, Study
from .tables import Table, Value

MODELS = ("cogmap", *CSCG, "random")
WORLD = "4x4"
STEPS = 100
WARM = 6  # steps that each agent walks untimed before: what is imported late is not counted
PAPER = {"cogmap": 14.95, "cscg": 48.35}
"""For 100 forced exploring steps, look-ahead 6; mean of 5 runs. Maze and variant of CSCG are not said."""
AUTHORS = {"cogmap": 31.3, "cscg": 1.9}
"""The same of the authors' code as measured in the 4x4 maze; CSCG compiled by numba, compilation left out."""


@dataclass(frozen=True, slots=True)
class Time:
    """How long the steps of one run took."""

    agent: str
    seed: int
    seconds: float


@dataclass(frozen=True)
class Cost(Study[tuple[str, int], Time]):
    """Seconds for a hundred steps

    How long do 100 forced exploring steps take in the 4x4 maze? The agent goes on when there is nothing
    left to explore. The paper's table of computation time; look-ahead 6.
    """

    name = "cost"
    notes = (
        "Runs are timed in one process, one after the other, whatever --jobs or --dask say, and the models take turns.",
        "Each model walks a few steps untimed first, so that late imports are not counted; the world's part is.",
        "The paper's machine, maze and variant of CSCG are not known; its 48.35 s stand beside CSCG on sights alone.",
        "The authors' CSCG is compiled by numba, compilation left out. Ours is numpy, and ends a training as soon "
        "as an iteration gains less than the tolerance of its settings.",
    )
    agents = 5
    settings = Settings(look_ahead=6)
    alone = True

    steps: int = STEPS  # that are timed

    def tasks(self, seeds: Sequence[int], settings: Settings) -> list[tuple[str, int]]:
        """The agents take turns, so that a machine that is slow for a while is slow for all."""
        return [(agent, seed) for seed in seeds for agent in MODELS]

    def run(self, task: tuple[str, int], settings: Settings) -> Time:
        """From an agent that knows nothing to its last action, the world's part included."""
        _seconds(*task, settings, min(WARM, self.steps))
        return Time(*task, round(_seconds(*task, settings, self.steps), 5))

    def summarise(self, rows: Sequence[Time]) -> Findings:
        whole, runs = f"{self.steps} forced exploring steps in {WORLD}", len(rows) // len(MODELS)
        by_agent = sorted(rows, key=lambda row: MODELS.index(row.agent))
        times, summary, lines, table = dict[str, Interval](), list[Any](), list[str](), list[list[Value]]()
        for agent, name in ((agent, LOOKS[agent][0]) for agent in MODELS):
            paper, authors = PAPER.get(agent), AUTHORS.get(agent)
            seconds = [row.seconds for row in rows if row.agent == agent]
            low, middle, high = min(seconds), round(median(seconds), 5), max(seconds)
            times[agent] = Interval(middle, low, high, runs)
            figures = {"agent": agent, "median": middle, "fastest": low, "slowest": high, "seconds": seconds}
            summary.append({**figures, "paper": paper, "authors": authors})
            table.append([name, *(float(f"{value:.3g}") for value in (middle, low, high)), paper, authors])
            beside = [f"{who} {value:g}" for who, value in (("paper", paper), ("authors' code", authors)) if value]
            spread = f"({low:.3g} to {high:.3g})"
            lines.append(f"  {name:<17}{middle:>8.3g} {spread:<20}{', '.join(beside)}".rstrip())
        heads = ("model", "median", "fastest", "slowest", "paper", "authors' code")
        tables = [
            Table.of("cost", [asdict(row) for row in by_agent], "every run", shown=False),
            Table("cost_table", heads, table, f"Seconds for {whole}, of {runs} runs."),
        ]
        protocol = {"world": WORLD, "steps": self.steps, "warm_up_steps": WARM, "processes": 1}
        json = {"protocol": protocol, "rows": by_agent, "summary": summary}
        lines.insert(0, f"seconds for {whole}, median (range) of {runs}")
        return Findings(json, lines, {"cost_seconds": partial(_figure, whole, times)}, tables)


def _seconds(agent: str, seed: int, settings: Settings, steps: int) -> float:
    start, for_agent, _ = draw_start("cost", MAZES[WORLD], seed)
    world = MazeEnv(MAZES[WORLD])
    begin = perf_counter()
    run(world, Parts(agent, settings).make(world, for_agent), steps=steps, options={"start": start})
    return perf_counter() - begin


def _figure(title: str, times: dict[str, Interval]) -> Figure:
    from matplotlib.ticker import StrMethodFormatter

    figure, (ax,) = panels("", (1, 1), (8.0, 0.5 * len(times) + 1.9))
    at, medians, theme = range(len(times)), [time.value for time in times.values()], theme_of(ax)
    ax.barh(at, medians, 0.6, color=[LOOKS[agent][1] for agent in times])
    ax.errorbar(medians, at, xerr=errors([*times.values()]), fmt="none", ecolor=theme.ink, elinewidth=1.2, capsize=3)
    look: Look = {"color": theme.ink, "markerfacecolor": theme.paper}
    for figures, marker, name in ((PAPER, "x", "the paper"), (AUTHORS, "D", "the authors' code")):
        ax.plot([*figures.values()], [[*times].index(agent) for agent in figures], marker, label=name, **look)
    ax.set(xscale="log", xlim=(min(medians) / 3, max(*medians, *PAPER.values()) * 2))
    ax.set_yticks(at, [LOOKS[agent][0] for agent in times])
    ax.invert_yaxis()
    ax.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    ax.set_xlabel("seconds (bars: median, lines: range)")
    ax.set_title(title, pad=10)
    ax.legend(fontsize=8, frameon=False, loc="lower right")
    return figure
