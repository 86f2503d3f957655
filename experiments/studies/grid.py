"""Explorations of several mazes by several agents: what the studies `exploration`, `rooms` and `growth` look at.

They share their runs: one that a ledger holds already is not made again, whichever study asked for it first.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from ...agent import Settings
from ...baselines import CscgSettings
from ...views import BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, theme_of
from ...worlds import MAZES
from .. import CSCG, Cell, Ledger, Row, run_cell, run_cells
from .figures import errors, panels
from .intervals import Interval, bootstrap
from .saving import make_folder
from .study import Study
from .tables import Table, flat

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LEDGER = "cells.jsonl"
"""In the folder of a study, or of those that share their runs."""
LEAST = 0.5
"""Steps that stand for none, which has no logarithm."""
CAP = 600
"""Moves after which every agent of these studies gives up."""
PREDICTED = "predicted"
TABLE = tuple(name for name in MAZES if name != "tolman")
"""The mazes of the paper's table."""
LEARN, VISIT, COMPLETE, ORACLE = "steps_to_learn", "steps_to_visit_all", "steps_to_complete", "oracle_steps"
NONE, MARK = "–", "†"
"""In a table: nothing; behind a mean over runs of which some did not get there."""
LEGEND = f"{MARK} lower bound: runs that gave up are counted at the cap"
TITLES = {
    "oracle": "Oracle",
    "cogmap": "cogmap",
    "frontier": "frontier",
    "random": "random",
    "cscg": "CSCG",
    "cscg_pose": "CSCG pose",
    "cscg_random": "CSCG random",
    "cscg_pose_random": "CSCG pose random",
}
"""Names of the models as the paper has them."""
LOOKS = {
    "oracle": ((0.0, 0.0, 0.0), "_"),
    "cogmap": (BLUE, "o"),
    "frontier": (GREEN, "P"),
    "random": (GREY, "X"),
    "cscg": (VERMILION, "s"),
    "cscg_pose": (ORANGE, "D"),
    "cscg_random": (PURPLE, "^"),
    "cscg_pose_random": (SKY, "v"),
    "static": (PURPLE, "s"),
    "observed": (ORANGE, "D"),
    "predicted": (BLUE, "o"),
}
"""Colour and marker of a model, or of a way to grow."""
STARTS = "Run i has the seed S + i, which draws start and agent; every model sets out from the same starts."
COUNTED = "A run that gave up is counted and named, never dropped; means over some runs only are marked."


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
        there = [value for value in steps if value is not None]
        values = tuple(cap if value is None else value for value in steps)
        mean, std = (float(np.mean(there)), float(np.std(there))) if there else (None, None)
        bound = bootstrap(values)
        assert bound is not None
        return cls(
            values, len(values), len(there), len(there) < len(values), mean, std, bound.value, bound.low, bound.high
        )

    @property
    def value(self) -> float:
        """The bound."""
        return self.bound

    def over(self, other: Steps) -> Interval | None:
        """Total of these steps over that of the other's, run by run with the same seeds."""
        return bootstrap(self.values, other.values)

    def mean_text(self) -> str:
        """`14.7 ± 1.0`, or where some gave up `≥ 412.0† (360.0 ± 12.0 over 5 of 20)`."""
        own = "" if self.mean is None else f"{self.mean:.1f} ± {self.std:.1f}"
        if not self.censored:
            return own
        return f"≥ {self.bound:.1f}{MARK} ({f'{own} over ' if own else ''}{self.got_there} of {self.runs})"

    def counted_text(self) -> str:
        """The mean, and how many got there of how many."""
        return self.mean_text() + ("" if self.censored else f" ({self.got_there}/{self.runs})")

    def text(self) -> str:
        """Mean, count and interval."""
        return f"{self.counted_text()} [{self.low:.1f}, {self.high:.1f}]"

    def to_dict(self) -> dict[str, Any]:
        """The figures without the single runs, as plain JSON values."""
        return {name: value for name, value in asdict(self).items() if name != "values"}


@dataclass(frozen=True)
class Explorations(Study[Cell, Row]):
    """Every maze is explored by every model, each with every seed.

    Attributes:
        what: which steps count.
        worlds: names of the mazes.
        models: names of the agents.
        growths: of the agent `cogmap`.
        cap: moves after which a run gives up.
    """

    what: ClassVar[str]

    worlds: tuple[str, ...] = TABLE
    models: tuple[str, ...] = ("cogmap", *CSCG)
    growths: tuple[str, ...] = (PREDICTED,)
    cap: int = CAP

    def tasks(self, seeds: Sequence[int], settings: Settings) -> list[Cell]:
        """A cell for each maze, model, way to grow and seed."""
        return [
            Cell(MAZES[world], agent, seed, growth)
            for world in self.worlds
            for agent in self.models
            for growth in self.growths
            for seed in seeds
        ]

    def run(self, task: Cell, settings: Settings) -> Row:
        """One exploration."""
        return run_cell(task, settings=settings, max_steps=self.cap)

    def work(
        self,
        tasks: Sequence[Cell],
        settings: Settings,
        *,
        executor: Executor | None,
        ledger: Ledger | None,
        on_done: Callable[[], None] | None,
    ) -> list[Row]:
        """Those that the ledger has are not made again."""
        rows: dict[Any, Row] = {}
        for row in run_cells(tasks, settings=settings, max_steps=self.cap, ledger=ledger, executor=executor):
            rows[row.key] = row
            if on_done is not None:
                on_done()
        return [rows[cell.key] for cell in tasks]

    @contextmanager
    def ledger(self, folder: Path, settings: Settings) -> Generator[Ledger | None]:
        """The ledger in the folder.

        Raises:
            CogmapError: it cannot be written, is in use, or was made with other settings.
        """
        make_folder(folder)
        with Ledger(folder / LEDGER) as ledger:
            for _ in run_cells((), settings=settings, max_steps=self.cap, ledger=ledger):
                pass  # compares the settings, and runs nothing
            yield ledger

    # -- what the rows come to -----------------------------------------------------------------------------

    def steps(
        self, rows: Sequence[Row], world: str, agent: str = "cogmap", growth: str = PREDICTED, what: str = ""
    ) -> Steps:
        """What the runs of one agent in one maze come to; the oracle walks from the starts of the first agent."""
        if agent == "oracle":
            what, agent = ORACLE, self.models[0]
        runs = [row.run for row in rows if (row.world, row.agent, row.growth) == (world, agent, growth)]
        return Steps.of([getattr(run, what or self.what) for run in runs], self.cap)

    def best(self, rows: Sequence[Row], world: str) -> tuple[str, Steps] | None:
        """The CSCG with the smallest mean, runs that gave up counted at the cap; None if none took part."""
        found = [(agent, self.steps(rows, world, agent)) for agent in self.models if agent in CSCG]
        return min(found, key=lambda item: item[1].bound, default=None)

    def summary(self, rows: Sequence[Row]) -> list[dict[str, Any]]:
        """Figures by maze and model, the oracle first."""
        return [
            {"world": world, "agent": agent, **self.steps(rows, world, agent).to_dict()}
            for world in self.worlds
            for agent in ("oracle", *self.models)
        ]

    def failed(self, rows: Sequence[Row]) -> list[str]:
        """Who gave up where, with which seeds."""
        lines: list[str] = []
        for group in dict.fromkeys((row.world, row.agent, row.growth) for row in rows):
            runs = [row.run for row in rows if (row.world, row.agent, row.growth) == group]
            seeds = [str(run.seed) for run in runs if getattr(run, self.what) is None]
            if seeds:
                world, agent, growth = group
                name = TITLES[agent] + ("" if growth == PREDICTED else f" ({growth})")
                which = f"seed{'s' if len(seeds) > 1 else ''} {', '.join(seeds)}"
                lines.append(f"{world}, {name}: {len(seeds)} of {len(runs)} gave up after {self.cap} moves ({which})")
        return lines

    def json(self, rows: Sequence[Row], summary: Sequence[dict[str, Any]]) -> dict[str, Any]:
        """Protocol, every run, and figures."""
        protocol = {
            "worlds": self.worlds,
            "agents": self.models,
            "growths": self.growths,
            "max_steps": self.cap,
            "cscg_settings": CscgSettings().to_dict() if {*self.models} & {*CSCG} else None,
        }
        return {"protocol": protocol, "rows": [row.to_dict() for row in rows], "summary": summary}

    def tables(
        self, rows: Sequence[Row], summary: Sequence[dict[str, Any]], shown: Iterable[Table], by: str = "model"
    ) -> list[Table]:
        """Every run; those that the report shows; the figures for machines."""
        runs = [flat(row.to_dict()) for row in rows]
        figures = f"{self.what}: figures by maze and {by}"
        return [
            Table.of(self.name, runs, "every run", shown=False),
            *shown,
            Table.of(f"{self.name}_summary", summary, figures, shown=False),
        ]

    def figure(
        self, title: str, rows: Sequence[Row], published: Callable[[str, str], float | None], name: str
    ) -> Figure:
        """Steps by maze and model, and what was `published` beside them, under that name."""
        series = {
            agent: [self.steps(rows, world, agent) for world in self.worlds] for agent in ("oracle", *self.models)
        }
        beside = {agent: [published(world, agent) for world in self.worlds] for agent in series}
        return steps_figure(title, self.worlds, series, cap=self.cap, beside=beside, published=name)


def factor_text(ratio: Interval | None, form: str, *, censored: bool) -> str:
    """A ratio and its interval, marked as a lower bound where it is one; `form` is that of a number."""
    if ratio is None:
        return NONE
    value, low, high = (format(part, form) for part in (ratio.value, ratio.low, ratio.high))
    return f"≥ {value}{MARK} [{low}, {high}]" if censored else f"{value} [{low}, {high}]"


def steps_figure(
    title: str,
    worlds: Sequence[str],
    series: dict[str, list[Steps]],
    *,
    cap: int,
    beside: dict[str, list[float | None]] | None = None,
    published: str = "",
) -> Figure:
    """Means with 95 % intervals, on a logarithmic scale; those that are lower bounds are hollow and point upwards.

    Args:
        title: of the figure.
        worlds: the mazes.
        series: by model or way to grow, a value for every maze.
        cap: moves after which a run gave up; drawn where some run did.
        beside: means of others, by the same names.
        published: what those are called.
    """
    figure, (ax,) = panels("", 1, (11.0, 5.6))
    ax.set_title(title, pad=10)
    ax.set_yscale("log")
    ink, slot = theme_of(ax).shade(0.75), 0.84 / len(series)
    for number, (name, every) in enumerate(series.items()):
        at = [world + (number - (len(series) - 1) / 2) * slot for world in range(len(worlds))]
        _points(ax, at, every, name)
        shown = [(x + 0.4 * slot, y) for x, y in zip(at, (beside or {}).get(name, ())) if y is not None]
        xs, ys = [x for x, _ in shown], [y for _, y in shown]
        ax.plot(xs, ys, linestyle="none", marker="x", markersize=5, color=LOOKS[name][0], zorder=4)
    if published:
        ax.plot([], [], linestyle="none", color=ink, marker="x", markersize=5, label=published)
    if some := any(steps.censored for every in series.values() for steps in every):
        hollow: dict[str, Any] = {"marker": "o", "markerfacecolor": theme_of(ax).paper, "linestyle": "none"}
        ax.plot([], [], color=ink, label="some gave up (got there/runs): lower bound", **hollow)
        ax.axhline(cap, color=ink, linewidth=0.8, linestyle=":", zorder=0, label=f"cap of {cap} moves")
    _finish(ax, worlds, room=some)
    return figure


def _points(ax: Axes, at: Sequence[float], every: Sequence[Steps], name: str) -> None:
    (colour, marker), line = LOOKS[name], LOOKS[name][1] == "_"
    look: dict[str, Any] = {"color": colour, "linestyle": "none", "zorder": 3, "elinewidth": 1.4, "capsize": 2.5}
    look |= {"marker": marker, "markersize": 12 if line else 6.5, "markeredgewidth": 2.0 if line else 1.4}
    for number, (x, steps) in enumerate(zip(at, every, strict=True)):
        least = replace(steps, **{end: max(getattr(steps, end), LEAST) for end in ("bound", "low", "high")})
        face = theme_of(ax).paper if steps.censored else colour
        label = "_" if number else TITLES.get(name, name)
        ax.errorbar([x], [least.bound], None if line else errors([least]), markerfacecolor=face, label=label, **look)
        if steps.censored:  # an arrow upwards, and how many got there of how many
            arrow = {"arrowstyle": "<-", "color": colour, "linewidth": 1.4, "shrinkA": 2, "shrinkB": 0}
            up: dict[str, Any] = {"textcoords": "offset points", "ha": "center", "va": "bottom"}
            ax.annotate("", (x, least.high), (0, 20), textcoords="offset points", arrowprops=arrow)
            ax.annotate(f"{steps.got_there}/{steps.runs}", (x, least.high), (0, 23), fontsize=7, rotation=90, **up)


def _finish(ax: Axes, worlds: Sequence[str], *, room: bool) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    ax.set_ylabel("steps")
    ax.set_xticks(range(len(worlds)), worlds)
    ax.set_xlim(-0.5, len(worlds) - 0.5)
    low, high = ax.get_ylim()
    ax.set_ylim(low * 0.9, high * (1.5 if room else 1.1))
    ticks = (1.0, 2.0, 5.0) if high / low > 10.0 else (1.0, 1.5, 2.0, 3.0, 5.0, 7.0)
    ax.yaxis.set_major_locator(LogLocator(subs=ticks))
    ax.yaxis.set_major_formatter(FuncFormatter(plain_tick))
    ax.yaxis.set_minor_formatter(NullFormatter())
    theme = theme_of(ax)
    ax.grid(axis="y", color=theme.shade(0.07), linewidth=0.8)
    for edge in range(1, len(worlds)):
        ax.axvline(edge - 0.5, color=theme.shade(0.13), linewidth=0.8, zorder=0)
    ax.set_axisbelow(True)
    entries = list(zip(*ax.get_legend_handles_labels(), strict=True))
    entries.sort(key=lambda entry: isinstance(entry[0], Line2D))  # models first
    place: dict[str, Any] = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.08), "ncols": 6}
    ax.legend(*zip(*entries, strict=True), fontsize=8, frameon=False, **place)


def plain_tick(value: float, _: int) -> str:
    """A tick as a plain number."""
    return f"{value:g}"
