"""The study `minigrid`: from pixels to places, beside the authors' published figures."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from ...agent import Settings
from ...baselines import TileFrontier
from ...body import COLOURS, load_embodied
from ...views import BLUE, GREY
from ...worlds import Maze, hall
from ...worlds import minigrid as mg
from .. import Record, explore, kidnap, mean, navigate
from ..low_level import TENTHS
from .figures import Figure, panels, plot_bars
from .intervals import wilson
from .study import Findings, Study
from .tables import Table, Value

AUTHORS: dict[str, float] = {"3x3": 0.93, "3x4": 0.94, "4x4": 0.91, "4x5": 0.81, "white": 0.89, "white, known": 0.86}
"""Shares of runs in which the authors' agent got there (de Tinguy et al., Entropy 2024)."""

NOISE = {"pixels": 40.0, "gain": 0.1, "slips": 0.2}
SIZES = ("3x3", "3x4", "4x4", "4x5")
CASES = (*SIZES, "white", "white, known", "kidnapped", "noise", "rooms of 4 to 12")
SEEN = 0.9
Task = tuple[str, int]  # case, seed


@dataclass(frozen=True, slots=True)
class BodyRun(Record):
    """One run of a body."""

    case: str
    seed: int
    done: bool  # nine tenths seen; goal reached; recovered with its map intact; map complete
    low_level_steps: int | None = field(default=None, metadata={"optional": True})  # until every room, or the goal
    low_level_oracle: int | None = field(default=None, metadata={"optional": True})  # the fewest
    low_level_steps_to_see: int | None = field(default=None, metadata={"optional": True})  # nine tenths of the tiles
    flat_to_see: int | None = field(default=None, metadata={"optional": True})  # of the nearest frontier over tiles
    eager_to_see: int | None = field(default=None, metadata={"optional": True})  # of one that chooses at every step


@dataclass(frozen=True)
class Bodies(Study[Task, BodyRun]):
    """From pixels to places: bodies in MiniGrid

    In rooms of MiniGrid, from a view of seven by seven tiles in pixels: in how many low-level steps has a body seen
    nine tenths of the tiles, entered every room, reached a white tile; and does it find itself again after it was
    put elsewhere, turned, without a word?
    """

    name = "minigrid"
    agents = 20
    notes = (
        "Rooms of 4 by 4 tiles, passages of 5, doors in the middle, offsets at random, four floor colours at random.",
        "The authors' shares are of more than 30 runs, within 18 steps a tile; no run here came near that.",
        "Flat frontier: nearest-frontier search over tiles, which walks to the tile that it chose.",
        "Eager frontier: the same, but it chooses anew at every step.",
        "White tile: halls of 3x4; known: explored before, then put elsewhere with a random heading, without a word.",
        "Noise: pixels 40 of 255, gain 10 %, slips 20 %, in 3x3. Needs the extra minigrid.",
    )

    cases: tuple[str, ...] = CASES

    def tasks(self, seeds: Sequence[int], settings: Settings) -> list[Task]:
        return [(case, seed) for case in self.cases for seed in seeds]

    def run(self, task: Task, settings: Settings) -> BodyRun:
        case, seed = task
        if case.startswith("white"):
            world = load_embodied("3x4", view="rgb", white=True, seed=seed, turned=True)
            found = navigate(world, seed, goal="white", known=case != "white", settings=settings)
            return BodyRun(case, seed, found.reached, found.low_level_steps, found.low_level_oracle)
        if case == "kidnapped":
            moved = kidnap(load_embodied("3x4", view="rgb", seed=seed, turned=True), seed, settings=settings)
            return BodyRun(case, seed, moved.recovered and moved.map_intact is True)
        size, noisy = case if case in SIZES else "3x3", case == "noise"
        most = 12 if case == CASES[-1] else 4
        from ...body import embodied  # MiniGrid, which the other studies can do without

        world = embodied(_hall(size, seed), view="rgb", most=most, noise=NOISE if noisy else None)
        seen = explore(world, seed, settings=settings)
        complete, share = seen.steps_to_complete is not None, seen.tiles_seen or 0.0
        there = share >= SEEN if case in SIZES else complete
        flat = [_flat(size, seed, eager=eager) for eager in (False, True)] if case in SIZES else [None, None]
        low = seen.low_level_steps, seen.low_level_oracle, seen.low_level_steps_to_see
        return BodyRun(case, seed, there, *low, *flat)

    def summarise(self, rows: Sequence[BodyRun]) -> Findings:
        table = [_row(case, [row for row in rows if row.case == case]) for case in self.cases]
        lines = ["  ".join(f"{key} {'-' if value is None else value}" for key, value in row.items()) for row in table]
        failed = [f"{row.case}, seed {row.seed}: not there" for row in rows if not row.done]
        caption = "Runs that got there, and low-level steps (means)."
        tables = [Table.of("minigrid_cases", table, caption)]
        json = {"runs": rows, "summary": table}
        return Findings(json, lines, {"minigrid_shares": partial(_shares, rows)}, tables, failed)


def _hall(size: str, seed: int) -> Maze:
    rows, columns = map(int, size.split("x"))
    made = hall(rows, columns, sights=COLOURS, rng=np.random.default_rng(seed))
    return Maze(size, dict(made.sights), made.walls)


def _flat(size: str, seed: int, *, eager: bool) -> int | None:
    """Steps until nearest-frontier search over tiles has seen nine tenths; None if it never has."""
    env, agent = mg.rooms_env(_hall(size, seed)), TileFrontier(eager=eager)
    (seen, _), ended = env.reset(seed=seed), False
    while TENTHS not in env.tally.shares and not ended:
        seen, _, _, ended, _ = env.step(agent.step(seen))
    return env.tally.shares.get(TENTHS)


def _row(case: str, runs: Sequence[BodyRun]) -> dict[str, Value]:
    both = [(run.low_level_steps, run.low_level_oracle) for run in runs if run.low_level_steps and run.low_level_oracle]
    least = sum(b for _, b in both)
    return {
        "case": case,
        "runs": len(runs),
        "done": sum(run.done for run in runs),
        "authors": AUTHORS.get(case),
        "steps to see 90 %": _rounded(mean(run.low_level_steps_to_see for run in runs)),
        "flat frontier": _rounded(mean(run.flat_to_see for run in runs)),
        "eager frontier": _rounded(mean(run.eager_to_see for run in runs)),
        "steps to all rooms or goal": None if not both else round(sum(a for a, _ in both) / len(both), 1),
        "over the fewest": round(sum(a for a, _ in both) / least, 3) if least else None,
    }


def _rounded(value: float | None) -> float | None:
    return None if value is None else round(value, 1)


def _shares(rows: Sequence[BodyRun]) -> Figure:
    figure, (ax,) = panels("Runs that got there", (1, 1), (9.0, 4.2))
    for at, case in enumerate(CASES):
        runs: list[Any] = [row for row in rows if row.case == case]
        if runs:
            plot_bars(ax, [at - 0.2], [wilson(sum(run.done for run in runs), len(runs))], width=0.38, color=BLUE)
        if case in AUTHORS:
            ax.bar([at + 0.2], [AUTHORS[case]], width=0.38, color=GREY)
    ax.set_xticks(range(len(CASES)), list(CASES), rotation=20)
    ax.set_ylabel("share (95 % Wilson); grey: the authors")
    return figure
