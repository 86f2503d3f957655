"""Explorations of several mazes by several agents: what the studies `exploration`, `rooms` and `growth` look at.

They share their runs: one that a ledger holds already is not made again, whichever study asked for it first.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass
from typing import Any, ClassVar

from ...agent import Settings
from ...baselines import CscgSettings
from ...views import BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, theme_of
from ...worlds import MAZES
from .. import CSCG, Cell, ExploreRun, Key, Ledger, Row, mean, run_cell, run_cells, std
from .figures import Axes, Figure, Look, panels, plot_line
from .intervals import Interval, bootstrap
from .study import Kept
from .tables import Table, flat

LEDGER = "cells.jsonl"  # in the folder of a study, or of those that share their runs
CAP = 600  # moves after which every agent of these studies gives up
LEAST = 0.5  # steps that stand for none, which has no logarithm
TABLE = tuple(name for name in MAZES if name != "tolman")  # the mazes of the paper's table
LEARN, VISIT, COMPLETE, ORACLE = "steps_to_learn", "steps_to_visit_all", "steps_to_complete", "oracle_steps"
NONE, MARK = "–", "†"  # in a table: nothing; behind a mean over runs of which some did not get there
LEGEND = f"{MARK} lower bound: runs that gave up are counted at the cap"
COUNTED = "A run that gave up is counted and named, never dropped; means over some runs only are marked."

LOOKS = {
    "oracle": ("Oracle", (0.0, 0.0, 0.0), "_"),
    "cogmap": ("cogmap", BLUE, "o"),
    "frontier": ("frontier", GREEN, "P"),
    "random": ("random", GREY, "X"),
    "cscg": ("CSCG", VERMILION, "s"),
    "cscg_pose": ("CSCG pose", ORANGE, "D"),
    "cscg_random": ("CSCG random", PURPLE, "^"),
    "cscg_pose_random": ("CSCG pose random", SKY, "v"),
    "static": ("static", PURPLE, "s"),
    "observed": ("observed", ORANGE, "D"),
    "predicted": ("predicted", BLUE, "o"),
}
"""Models and ways to grow: as the paper calls them, colour and marker."""


@dataclass(frozen=True, slots=True)
class Steps:
    """Steps until something happened, where some runs never got there: none is dropped.

    A run that gave up after the cap would have needed more steps than that. Counted at the cap it makes the mean over
    all runs a lower bound of the true one (the mean is censored).
    """

    values: tuple[int, ...]  # by run, those that gave up at the cap
    runs: int
    got_there: int
    censored: bool  # whether some did not get there
    mean: float | None  # over those that got there; None where none did
    std: float | None  # standard deviation (population) of the same
    bound: float  # mean over all runs; `mean` if all got there
    low: float  # end of its interval
    high: float

    @classmethod
    def of(cls, steps: Sequence[int | None], cap: int) -> Steps:
        """From steps by run, None for one that gave up after `cap`; one run or more."""
        values, got_there = tuple(cap if value is None else value for value in steps), len(steps) - steps.count(None)
        bound = bootstrap(values) or Interval(0.0, 0.0, 0.0, 0)
        ends = bound.value, bound.low, bound.high
        return cls(values, len(steps), got_there, got_there < len(steps), mean(steps), std(steps), *ends)

    def mean_text(self) -> str:
        """`14.7 ± 1.0`, or where some gave up `≥ 412.0† (360.0 ± 12.0 over 5 of 20)`."""
        own = "" if self.mean is None else f"{self.mean:.1f} ± {self.std:.1f}"
        few = f"{own} over " if own else ""
        return f"≥ {self.bound:.1f}{MARK} ({few}{self.got_there} of {self.runs})" if self.censored else own

    def counted_text(self) -> str:
        """The mean, and how many got there of how many."""
        return self.mean_text() + ("" if self.censored else f" ({self.got_there}/{self.runs})")

    def interval_text(self) -> str:
        """The 95 % interval of `bound`."""
        return f"{self.low:.1f} to {self.high:.1f}" + MARK * self.censored

    def text(self) -> str:
        """Mean, count and interval."""
        return f"{self.counted_text()} [{self.low:.1f}, {self.high:.1f}]"

    def to_dict(self) -> dict[str, Any]:
        """The figures without the single runs."""
        return {name: value for name, value in asdict(self).items() if name != "values"}


Grid = dict[tuple[str, str], Steps]  # by maze and by model, or by way to grow


@dataclass(frozen=True)
class Explorations(Kept[Cell, Row]):
    """Every maze is explored by every model, each with every seed; a subclass says which steps count, and of whom."""

    file = LEDGER
    what: ClassVar[str]
    by: ClassVar[str] = "agent"  # or "growth"

    worlds: tuple[str, ...] = TABLE
    models: tuple[str, ...] = ("cogmap", *CSCG)
    growths: tuple[str, ...] = ("predicted",)  # of the agent `cogmap`
    cap: int = CAP  # moves after which a run gives up

    def tasks(self, seeds: Sequence[int], settings: Settings) -> list[Cell]:
        return [
            Cell(MAZES[world], agent, seed, growth)
            for world in self.worlds
            for agent in self.models
            for growth in self.growths
            for seed in seeds
        ]

    def run(self, task: Cell, settings: Settings) -> Row:
        return run_cell(task, settings=settings, max_steps=self.cap)

    def key(self, task: Cell) -> Key:
        return task.key

    def made(
        self, tasks: Sequence[Cell], settings: Settings, executor: Executor | None, ledger: Ledger | None
    ) -> Iterator[Row]:
        return run_cells(tasks, settings=settings, max_steps=self.cap, ledger=ledger, executor=executor)

    def grid(self, rows: Sequence[Row], what: str = "") -> Grid:
        """What the runs come to; the oracle, first in each maze, walks from the starts of the first model."""
        grid: Grid = {}
        for (world, column), runs in self._runs(rows).items():
            if (world, "oracle") not in grid:
                grid[world, "oracle"] = Steps.of([run.oracle_steps for run in runs], self.cap)
            grid[world, column] = Steps.of([getattr(run, what or self.what) for run in runs], self.cap)
        return grid

    def best(self, grid: Grid, world: str) -> str | None:
        """The CSCG with the smallest mean, runs that gave up counted at the cap; None if none took part."""
        found = [agent for agent in self.models if agent in CSCG]
        return min(found, key=lambda agent: grid[world, agent].bound, default=None)

    def found(self, rows: Sequence[Row], grid: Grid, *shown: Table) -> dict[str, Any]:
        """JSON, tables and failures as `Findings` have them: protocol, every run, the figures, and what is `shown`."""
        cscg = CscgSettings().to_dict() if {*self.models} & {*CSCG} else None
        protocol = {"worlds": self.worlds, "agents": self.models, "growths": self.growths}
        protocol |= {"max_steps": self.cap, "cscg_settings": cscg}
        summary = [{"world": key[0], self.by: key[1], **steps.to_dict()} for key, steps in grid.items()]
        caption = f"{self.what}: figures by maze and {'model' if self.by == 'agent' else self.by}"
        runs = Table.of(self.name, [flat(row.to_dict()) for row in rows], "every run", shown=False)
        return {
            "json": {"protocol": protocol, "rows": rows, "summary": summary},
            "tables": [runs, *shown, Table.of(f"{self.name}_summary", summary, caption, shown=False)],
            "failed": [line for key, every in self._runs(rows).items() for line in self._failed(*key, every)],
        }

    def _failed(self, world: str, column: str, runs: Sequence[ExploreRun]) -> list[str]:
        name = LOOKS[column][0] if self.by == "agent" else "cogmap" + f" ({column})" * (column != "predicted")
        seeds = [str(run.seed) for run in runs if getattr(run, self.what) is None]
        which = f"seed{'s' * (len(seeds) > 1)} {', '.join(seeds)}"
        return (
            [f"{world}, {name}: {len(seeds)} of {len(runs)} gave up after {self.cap} moves ({which})"] if seeds else []
        )

    def _runs(self, rows: Sequence[Row]) -> dict[tuple[str, str], list[ExploreRun]]:
        runs: dict[tuple[str, str], list[ExploreRun]] = {}
        for row in rows:
            runs.setdefault((row.world, row.agent if self.by == "agent" else row.growth), []).append(row.run)
        return runs


def factor_text(ratio: Interval | None, form: str, censored: bool) -> str:
    """A ratio and its interval, marked as a lower bound where it is one; `form` is that of a number."""
    if ratio is None:
        return NONE
    value, low, high = (format(part, form) for part in (ratio.value, ratio.low, ratio.high))
    return f"≥ {value}{MARK} [{low}, {high}]" if censored else f"{value} [{low}, {high}]"


def steps_figure(
    title: str, grid: Grid, cap: int, beside: Mapping[tuple[str, str], float] | None = None, published: str = ""
) -> Figure:
    """Means with 95 % intervals, on a logarithmic scale; those that are lower bounds are hollow and point upwards.

    The cap is drawn where some run gave up; `beside` are means of others, called `published`.
    """
    figure, (ax,) = panels("", (1, 1), (11.0, 5.6))
    worlds, columns = (list(dict.fromkeys(key[i] for key in grid)) for i in (0, 1))
    ink, paper, slot = theme_of(ax).shade(0.75), theme_of(ax).paper, 0.84 / len(columns)
    ax.set_title(title, pad=10)
    ax.set_yscale("log")
    for number, column in enumerate(columns):
        for place, world in enumerate(worlds):
            x = place + (number - (len(columns) - 1) / 2) * slot
            _point(ax, x, grid[world, column], column, named=place == 0)
            if beside and (world, column) in beside:
                ax.plot(x + 0.4 * slot, beside[world, column], "x", markersize=5, color=LOOKS[column][1], zorder=4)
    if published:
        ax.plot([], [], "x", color=ink, markersize=5, label=published)
    if some := any(steps.censored for steps in grid.values()):
        ax.plot([], [], "o", color=ink, markerfacecolor=paper, label="some gave up (got there/runs): lower bound")
        ax.axhline(cap, color=ink, linewidth=0.8, linestyle=":", zorder=0, label=f"cap of {cap} moves")
    _finish(ax, worlds, room=some)
    return figure


def _point(ax: Axes, x: float, steps: Steps, column: str, *, named: bool) -> None:
    name, colour, marker = LOOKS[column]
    look: Look = {"color": colour, "marker": marker, "linestyle": "none", "zorder": 3}
    look |= {"markerfacecolor": theme_of(ax).paper if steps.censored else colour, "label": name if named else "_"}
    value, low, high = (max(end, LEAST) for end in (steps.bound, steps.low, steps.high))
    look |= {"markersize": 12.0, "markeredgewidth": 2.0} if column == "oracle" else {"markersize": 6.5}
    ax.plot([x], [value], **look)
    if column != "oracle":
        plot_line(ax, [x], [Interval(value, low, high, steps.runs)], fmt="none", color=colour, elinewidth=1.4)
    if steps.censored:  # an arrow upwards, and how many got there of how many
        arrow = {"arrowstyle": "<-", "color": colour, "linewidth": 1.4, "shrinkA": 2, "shrinkB": 0}
        up: Look = {"textcoords": "offset points", "ha": "center", "va": "bottom"}
        ax.annotate("", (x, high), (0, 20), textcoords="offset points", arrowprops=arrow)
        ax.annotate(f"{steps.got_there}/{steps.runs}", (x, high), (0, 23), fontsize=7, rotation=90, **up)


def _finish(ax: Axes, worlds: Sequence[str], *, room: bool) -> None:
    from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

    low, high = ax.get_ylim()
    ax.set(ylabel="steps", xlim=(-0.5, len(worlds) - 0.5), ylim=(low * 0.9, high * (1.5 if room else 1.1)))
    ax.set_xticks(range(len(worlds)), worlds)
    ticks = (1.0, 2.0, 5.0) if high / low > 10.0 else (1.0, 1.5, 2.0, 3.0, 5.0, 7.0)
    ax.yaxis.set_major_locator(LogLocator(subs=ticks))
    ax.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    ax.yaxis.set_minor_formatter(NullFormatter())
    ax.grid(axis="y", color=theme_of(ax).shade(0.07), linewidth=0.8)
    for edge in range(1, len(worlds)):
        ax.axvline(edge - 0.5, color=theme_of(ax).shade(0.13), linewidth=0.8, zorder=0)
    ax.legend(fontsize=8, frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.08), ncols=6)
