"""The study `distances`: steps to a preferred sight from rooms at every distance, beside CSCG with learned maps."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, partial
from typing import Any

import numpy as np

from ...agent import Settings
from ...views import BLUE, GREEN, GREY, ORANGE, VERMILION
from ...worlds import MAZES, Label, Maze, Position
from .. import WEIGHT, Moment, Parts, Session, set_out, shortest
from .figures import Figure, legend_below, panels, plot_line
from .goals import ALIASED
from .grid import NONE
from .intervals import Interval, bootstrap
from .study import Findings, Study
from .tables import Table

PAPERS = tuple(name for name in MAZES if name != "tolman")  # the mazes of the paper's figure

MODELS = {
    "cogmap": ("cogmap", "cogmap with its map", BLUE, "o"),
    "cogmap_unknown": ("cogmap", "cogmap without a map", GREEN, "s"),
    "cscg": ("cscg", "CSCG with its map", VERMILION, "^"),
    "cscg_pose": ("cscg_pose", "CSCG with positions and its map", ORANGE, "v"),
}
"""Agent, name, colour and mark of each."""

CAP = 600  # moves after which exploring is given up
MOST = 100  # moves after which a way to the goal is given up, and counted so


@dataclass(frozen=True, slots=True)
class WayTo:
    """One way to the goal."""

    shortest: int  # steps of the shortest path from where it sets out
    steps: int | None  # until it chose to stay there; None if it did not within `MOST`
    goal: Label


@dataclass(frozen=True, slots=True)
class DistanceRow:
    """An agent in one maze, set out once from each distance, each time to a goal that is drawn."""

    world: str
    aliased: bool  # whether several rooms of the maze look alike
    model: str  # one of `MODELS`
    seed: int
    learned: bool  # whether it knew the maze before, if it was to
    ways: tuple[WayTo, ...]  # none where it did not learn the maze


class Distances(Study[tuple[str, str, int], DistanceRow]):
    """Steps to the goal by distance

    How many moves does it take to a preferred sight from rooms at every distance, for an agent with a map and without,
    and for clone-structured graphs, with sights alone and with positions, each with the map that it learned? Each run
    sets out once from every distance that the maze has, so that there is one run a distance and maze for each agent.
    """

    name = "distances"
    notes = (
        "The paper's figure on steps to the goal: 20 runs a distance and maze, apart for mazes in which sights repeat.",
        "A goal is reached when the agent chooses to stay on it. With a map it is moved there without a word, and "
        "nothing is reset; a CSCG keeps the map that it learned, and learns no more.",
        f"Who has not learned a maze after {CAP} moves does not set out; ways given up after {MOST} moves count as "
        f"{MOST}, so that such a mean is a lower bound.",
    )

    def tasks(self, seeds: Sequence[int], settings: Settings) -> list[tuple[str, str, int]]:
        """Each maze with each model and every seed, which draws goals, starts and agent."""
        return [(world, model, seed) for world in PAPERS for model in MODELS for seed in seeds]

    def run(self, task: tuple[str, str, int], settings: Settings) -> DistanceRow:
        world, model, seed = task
        maze, known = MAZES[world], model != "cogmap_unknown"
        parts = Parts(MODELS[model][0], settings)
        session = set_out(self.name, maze, seed, agent=parts, max_steps=CAP)
        if known:
            session.explore()
            session.agent.learning = False  # of a CSCG; cogmap has no such switch and goes on
        ways: list[WayTo] = []
        for distance, goals in by_distance(maze).items() if session.steps is not None or not known else ():
            if not known:
                session = set_out(self.name, maze, seed, agent=parts, max_steps=CAP)
            goal = list(goals)[int(np.random.default_rng([seed, distance]).integers(len(goals)))]
            session.displace(elsewhere=False, but=set(maze.rooms) - goals[goal])
            ways.append(WayTo(distance, _steps_to(session, goal), goal))
        aliased = len(set(maze.sights.values())) < len(maze.rooms)
        return DistanceRow(world, aliased, model, seed, session.steps is not None, tuple(ways))

    def summarise(self, rows: Sequence[DistanceRow]) -> Findings:
        cells = summarised(rows)
        heads = {model: name for model, (_, name, _, _) in MODELS.items()}
        table = [
            {"mazes": ALIASED[kind], "shortest": distance, **{heads[m]: _text(means.get(m)) for m in heads}}
            for (kind, distance), means in sorted(cells.items())
        ]
        lines = ["steps until it stays on the goal, mean [95 %], by the length of the shortest path"]
        for row in table:
            of = "; ".join(f"{name} {row[name]}" for name in heads.values())
            lines.append(f"{row['mazes']}, {row['shortest']}: {of}")
        failed = [_failure(row) for row in rows if _failure(row)]
        caption = "Steps until the agent stays on the goal, mean with 95 % interval, by the length of the shortest path"
        tables = [Table.of("distances", table, caption), Table.of("distances_ways", _flat(rows), shown=False)]
        figures = {"distances": partial(_figure, cells)}
        return Findings({"weight": WEIGHT, "most": MOST, "rows": rows}, lines, figures, tables, failed)


@cache
def by_distance(maze: Maze) -> dict[int, dict[Label, set[Position]]]:
    """By steps of the shortest path, from 1 on: the sights, and the rooms that lie so far from each."""
    found: dict[int, dict[Label, set[Position]]] = {}
    for goal in dict.fromkeys(maze.sights[room] for room in maze.rooms):
        for room in maze.rooms:
            found.setdefault(shortest(maze, room, goal), {}).setdefault(goal, set()).add(room)
    return {distance: found[distance] for distance in sorted(found) if distance}


def summarised(rows: Sequence[DistanceRow]) -> dict[tuple[bool, int], dict[str, Interval]]:
    """By kind of maze and distance, of each model that set out, the mean; ways given up count as `MOST`."""
    steps: dict[tuple[bool, int], dict[str, list[int]]] = {}
    for row in rows:
        for way in row.ways:
            of = steps.setdefault((row.aliased, way.shortest), {})
            of.setdefault(row.model, []).append(MOST if way.steps is None else way.steps)
    means = {key: {model: bootstrap(values) for model, values in of.items()} for key, of in steps.items()}
    return {key: {model: mean for model, mean in of.items() if mean is not None} for key, of in means.items()}


def _steps_to(session: Session, goal: Label) -> int | None:
    """Moves before it chooses to stay in a room with the sight."""
    reached: list[int] = []
    stay = session.world.motions.names.index("stay")

    def look(moment: Moment) -> bool:
        if moment.observation["sight"] == goal and moment.action == stay:
            reached.append(moment.step)
        return bool(reached)

    session.agent.prefer({goal: WEIGHT})
    session.run(MOST + 1, look)
    return reached[0] if reached else None


def _failure(row: DistanceRow) -> str:
    """What did not get there, in words; empty if everything did."""
    who = f"{row.world}, {MODELS[row.model][1]}, seed {row.seed}"
    if not row.ways:
        return f"{who}: not learned after {CAP} moves"
    lost = [f"{way.goal} from distance {way.shortest}" for way in row.ways if way.steps is None]
    return f"{who}: not reached: goal {', '.join(lost)}" if lost else ""


def _flat(rows: Sequence[DistanceRow]) -> list[dict[str, Any]]:
    return [
        {"world": row.world, "model": row.model, "seed": row.seed, "shortest": way.shortest, "steps": way.steps}
        for row in rows
        for way in row.ways
    ]


def _text(mean: Interval | None) -> str:
    return NONE if mean is None else f"{mean.value:.1f} [{mean.low:.1f}, {mean.high:.1f}]"


def _figure(cells: dict[tuple[bool, int], dict[str, Interval]]) -> Figure:
    title = "Steps to the goal, by the length of the shortest path (mean, 95 % bootstrap)"
    figure, axes = panels(title, (1, 2), (11.0, 5.0), sharey=True)
    for ax, aliased in zip(axes, (True, False), strict=True):
        at = sorted(distance for kind, distance in cells if kind is aliased)
        ax.plot(at, at, color=GREY, linestyle="--", label="shortest path")
        for model, (_, name, colour, mark) in MODELS.items():
            there = [
                (distance, cells[aliased, distance][model]) for distance in at if model in cells[aliased, distance]
            ]
            look: Any = {"color": colour, "marker": mark, "label": name}
            plot_line(ax, [x for x, _ in there], [mean for _, mean in there], **look)
        ax.set_title(ALIASED[aliased])
        ax.set_xlabel("steps of the shortest path")
    axes[0].set_ylabel("steps until the agent stays on the goal")
    legend_below(figure, axes[0], 3)
    return figure
