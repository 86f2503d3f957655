"""The study `buildings`: real maps explored, against nearest-frontier search and the best offline tour."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ...agent import Settings
from ...model import CogmapError
from ...views import BLUE, GREY, ORANGE, plot_world
from ...worlds import Chart, GraphWorld, NoisyWorld, WorldError, geometric, is_graph_file, load_world
from .. import ExploreRun, NavigateRun, Record, explore, navigate
from .figures import Axes, Figure, panels, plot_bars
from .intervals import Interval, bootstrap
from .study import Findings, Study
from .tables import Table, Value

SIGHTS: dict[str, Any] = {"distinct": "distinct", "ways": "ways", "six": 6, "six, drift 5 %": 6}
"""What places look like, and whether odometry drifts."""

DRIFT = {"odometry": 0.05, "heading": 3.0}
GOAL = "six"
"""The sights of the worlds in which goals are sought."""

LARGEST = 400  # places of the largest map that is studied unless told otherwise


@dataclass(frozen=True, slots=True)
class BuildingRun(Record):
    """One map explored once, and with six sights a way to one of them after a silent move."""

    map: str
    sights: str  # a key of `SIGHTS`
    explored: ExploreRun
    goal: NavigateRun | None = field(default=None, metadata={"optional": True})

    @property
    def seed(self) -> int:
        """Of start and agent."""
        return self.explored.seed


Task = tuple[str, str, int]  # path or name of a map, sights, seed


@dataclass(frozen=True)
class Buildings(Study[Task, BuildingRun]):
    """Real buildings, a farm, streets

    In how many steps, and metres, has an agent entered every place of a real map, against nearest-frontier search from
    the same starts and the best offline tour; is its map right then; and how does it find a place again after it was
    moved without a word?
    """

    name = "buildings"
    agents = 10
    notes = (
        "Nearest frontier: mean of 20 draws of its ties from each start; it is told which places the ways lead to.",
        "Metres are those of the walk of fewest steps; nearest frontier by metres looks for the least metres.",
        "Of a way the agent is told the bearing, and of a move the displacement once it was made.",
        "Without a folder of maps the study takes random geometric graphs.",
    )

    folder: str | None = None  # of graph files
    largest: int = LARGEST

    def tasks(self, seeds: Sequence[int], settings: Settings) -> list[Task]:
        return [(path, sights, seed) for path in self.maps() for sights in SIGHTS for seed in seeds]

    def maps(self) -> list[str]:
        """The paths of the maps, or the names of those that are made.

        Raises:
            CogmapError: the folder has no graph of so many places at most.
        """
        if self.folder is None:
            return [f"geometric {places}" for places in (40, 80)]
        found: list[str] = []
        for path in sorted(Path(self.folder).iterdir()) if Path(self.folder).is_dir() else ():
            if is_graph_file(path) and (places := _places(path)) is not None and places <= self.largest:
                found.append(str(path))
        if not found:
            raise CogmapError(f"buildings: {self.folder} has no graph files of {self.largest} places or fewer")
        return found

    def run(self, task: Task, settings: Settings) -> BuildingRun:
        path, sights, seed = task
        world: Any = _world(path, SIGHTS[sights])
        name = world.chart.name
        if sights.endswith("%"):
            world = NoisyWorld(world, **DRIFT)
        explored = explore(world, seed, settings=settings)
        if sights != GOAL:
            return BuildingRun(name, sights, explored)
        goal = int(np.random.default_rng(seed).integers(SIGHTS[GOAL]))
        shown = min(set(world.chart.sights.values()), key=lambda label: abs(label - goal))  # small maps lack some
        return BuildingRun(name, sights, explored, navigate(world, seed, goal=shown, settings=settings))

    def summarise(self, rows: Sequence[BuildingRun]) -> Findings:
        maps = list(dict.fromkeys(row.map for row in rows))
        groups = {(name, sights): _of(rows, name, sights) for name in maps for sights in SIGHTS}
        table = [_row(name, sights, group) for (name, sights), group in groups.items() if group]
        goals = [_goals(name, _of(rows, name, GOAL)) for name in maps if _of(rows, name, GOAL)]
        lines = ["  ".join(f"{key} {_text(value)}" for key, value in row.items()) for row in (*table, *goals)]
        failed = [
            f"{row.map}, {row.sights}, seed {row.seed}: {_lacking(row)}"
            for row in rows
            if not (row.explored.map_right and row.explored.steps_to_visit_all)
        ]
        json = {"runs": rows, "summary": table, "goals": goals}
        tables = [
            Table.of("buildings_steps", table, "Steps and metres until every place was entered."),
            Table.of("buildings_goals", goals, "Goals after exploring and a silent move, six sights."),
        ]
        figures: dict[str, Any] = {"buildings_ratio": partial(_ratios, groups, maps)}
        paths = {Path(path).stem if self.folder else path: path for path in self.maps()}
        charts = {name: paths[name] for name in maps if name in paths}
        if charts:
            figures["buildings_maps"] = partial(_maps, charts)
        return Findings(json, lines, figures, tables, failed)


def _world(path: str, sights: Any) -> GraphWorld:
    if path.startswith("geometric "):
        return geometric(int(path.split()[1]), sights=sights, seed=0)
    world = load_world(path, sights=sights, strong=False)
    assert isinstance(world, GraphWorld)
    return world


def _places(path: Path) -> int | None:
    """How many places a graph file has; None of one that is no world."""
    try:
        return len(_world(str(path), "ways").chart.places)
    except WorldError:
        return None


def _of(rows: Sequence[BuildingRun], name: str, sights: str) -> list[BuildingRun]:
    return [row for row in rows if (row.map, row.sights) == (name, sights)]


def _over(group: Sequence[BuildingRun], steps: str, by: str) -> Interval | None:
    """The ratio of two figures, over the runs that have both."""
    pairs = [(getattr(row.explored, steps), getattr(row.explored, by)) for row in group]
    both = [(a, b) for a, b in pairs if a is not None and b is not None]
    return bootstrap([float(a) for a, _ in both], [float(b) for _, b in both]) if both else None


def _row(name: str, sights: str, group: Sequence[BuildingRun]) -> dict[str, Value]:
    ratio = _over(group, "steps_to_visit_all", "frontier_mean")
    metres, tour = _over(group, "metres", "frontier_metres"), _over(group, "steps_to_visit_all", "tour_steps")
    return {
        "map": name,
        "sights": sights,
        "runs": len(group),
        "entered all": sum(row.explored.steps_to_visit_all is not None for row in group),
        "map right": sum(bool(row.explored.map_right) for row in group),
        "over nearest frontier": None if ratio is None else round(ratio.value, 3),
        "metres over it": None if metres is None else round(metres.value, 3),
        "over the best tour": None if tour is None else round(tour.value, 3),
    }


def _goals(name: str, group: Sequence[BuildingRun]) -> dict[str, Value]:
    there = [row.goal for row in group if row.goal is not None and row.goal.reached]
    steps, shortest = sum(run.steps or 0 for run in there), sum(run.shortest or 0 for run in there)
    ratio = round(steps / shortest, 3) if shortest else None
    return {
        "map": name,
        "runs": len(group),
        "reached": len(there),
        "steps": steps,
        "shortest": shortest,
        "ratio": ratio,
    }


def _text(value: Value) -> str:
    return "-" if value is None else str(value)


def _ratios(groups: dict[tuple[str, str], list[BuildingRun]], maps: Sequence[str]) -> Figure:
    """Steps over nearest frontier, by map."""
    figure, (ax,) = panels("Steps until every place was entered, over nearest frontier", (1, 1), (11.0, 4.6))
    shifts = np.linspace(-0.3, 0.3, len(SIGHTS))
    for shift, sights, colour in zip(shifts, SIGHTS, (BLUE, ORANGE, GREY, (0.2, 0.6, 0.4)), strict=True):
        found = [(i, _over(groups[name, sights], "steps_to_visit_all", "frontier_mean")) for i, name in enumerate(maps)]
        known = [(i + shift, ratio) for i, ratio in found if ratio is not None]
        if known:
            plot_bars(ax, [at for at, _ in known], [r for _, r in known], width=0.18, color=colour, label=sights)
    ax.axhline(1.0, color="black", linewidth=0.8)
    ax.set_xticks(range(len(maps)), list(maps), rotation=20)
    ax.set_ylabel("ratio (mean, 95 % bootstrap)")
    ax.legend(frameon=False)
    return figure


def _maps(charts: dict[str, str]) -> Figure:
    """The maps from above."""
    columns = min(len(charts), 4)
    down = -(-len(charts) // columns)
    size = 4.0 * columns, 4.0 * down
    figure, axes = panels("The maps, seen from above", (down, columns), size)
    for ax, (name, path) in zip(axes, charts.items(), strict=False):
        _one_map(ax, name, _world(path, "ways").chart)
    for ax in axes[len(charts) :]:
        ax.set_axis_off()
    return figure


def _one_map(ax: Axes, name: str, chart: Chart) -> None:
    plot_world(chart, title=name, ax=ax)


def _lacking(row: BuildingRun) -> str:
    return "not every place was entered" if row.explored.steps_to_visit_all is None else "the map is not right"
