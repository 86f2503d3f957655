"""The study `cost`: the paper's table of the computation time of 100 forced exploring steps."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from statistics import median
from time import perf_counter
from typing import Any

from ...agent import Settings
from ...model.errors import CogmapError
from ...worlds import MAZES
from ..parts import CSCG, Parts
from ..session import set_out
from .grid_rows import TITLES
from .published import AUTHORS_SECONDS, PAPER_SECONDS
from .report import Table

AGENTS = ("cogmap", *CSCG, "random")
WORLD = "4x4"
STEPS = 100
WARM = 6
"""Steps that each agent walks untimed first: what is imported late is not counted."""
SETTINGS = Settings(look_ahead=6)


@dataclass(frozen=True, slots=True)
class Time:
    """Seconds that one agent's steps took, by run.

    Attributes:
        agent: its name.
        seconds: in the order of the seeds.
    """

    agent: str
    seconds: tuple[float, ...]

    @property
    def median(self) -> float:
        """Half of the runs took longer."""
        return median(self.seconds)

    def to_dict(self) -> dict[str, Any]:
        """Median and range, every run, and what was published, as plain JSON values."""
        figures = {"median": self.median, "fastest": min(self.seconds), "slowest": max(self.seconds)}
        return {
            "agent": self.agent,
            **{name: round(value, 5) for name, value in figures.items()},
            "seconds": [round(value, 5) for value in self.seconds],
            "paper": PAPER_SECONDS.get(self.agent),
            "authors": AUTHORS_SECONDS.get(self.agent),
        }


@dataclass(frozen=True, slots=True)
class CostResult:
    """All agents, in the order of `AGENTS`.

    Attributes:
        times: by agent.
        steps: that were timed.
        seed: of the first run.
    """

    times: tuple[Time, ...]
    steps: int
    seed: int

    def failed(self) -> tuple[str, ...]:
        """Nothing can."""
        return ()

    def to_dict(self) -> dict[str, Any]:
        """Protocol, every run and the figures by agent, as plain JSON values."""
        return {
            "protocol": {"world": WORLD, "steps": self.steps, "warm_up_steps": WARM, "processes": 1},
            "rows": [
                {"agent": time.agent, "seed": self.seed + i, "seconds": round(value, 5)}
                for time in self.times
                for i, value in enumerate(time.seconds)
            ],
            "summary": [time.to_dict() for time in self.times],
        }


def cost_study(
    *,
    agents: int,
    seed: int = 0,
    settings: Settings | None = None,
    executor: Executor | None = None,
    on_done: Callable[[], None] | None = None,
    steps: int = STEPS,
) -> CostResult:
    """Time every agent; it goes on exploring when there is nothing left to explore.

    Runs are made in this process, one after the other, and the agents take turns, so that a machine that is slow for
    a while is slow for all.

    Args:
        agents: runs of each.
        seed: of the first run.
        settings: of `cogmap`; `SETTINGS` unless given.
        executor: left alone: runs beside each other would not be timed honestly.
        on_done: called after each of the `cost_tasks(agents)` runs.
        steps: that are timed.

    Raises:
        CogmapError: `agents` or `steps` below 1, or a negative seed.
    """
    for name, value in (("agents", agents), ("steps", steps)):
        if value < 1:
            raise CogmapError(f"cost: {name} is {value}; use 1 or more")
    for agent in AGENTS:
        forced_seconds(agent, settings or SETTINGS, seed, min(WARM, steps))
    seconds: dict[str, list[float]] = {agent: [] for agent in AGENTS}
    for number in range(seed, seed + agents):
        for agent in AGENTS:
            seconds[agent].append(forced_seconds(agent, settings or SETTINGS, number, steps))
            if on_done is not None:
                on_done()
    return CostResult(tuple(Time(agent, tuple(taken)) for agent, taken in seconds.items()), steps, seed)


def cost_tasks(agents: int) -> int:
    """How many runs are timed."""
    return agents * len(AGENTS)


def forced_seconds(agent: str, settings: Settings, seed: int, steps: int) -> float:
    """Seconds from an agent that knows nothing to its last action, the world's part included.

    Raises:
        CogmapError: a negative seed.
    """
    begin = perf_counter()
    set_out("cost", MAZES[WORLD], seed, agent=Parts(agent, settings)).run(steps)
    return perf_counter() - begin


def cost_lines(result: CostResult) -> list[str]:
    """What the terminal shows."""
    runs = len(result.times[0].seconds)
    lines = [f"seconds for {result.steps} forced exploring steps in {WORLD}, median (range) of {runs}"]
    for time in result.times:
        published = ((PAPER_SECONDS, "paper"), (AUTHORS_SECONDS, "authors' code"))
        beside = [f"{name} {figures[time.agent]:g}" for figures, name in published if time.agent in figures]
        spread = f"({min(time.seconds):.3g} to {max(time.seconds):.3g})"
        lines.append(f"  {TITLES[time.agent]:<17}{time.median:>8.3g} {spread:<20}{', '.join(beside)}".rstrip())
    return lines


def cost_tables(result: CostResult) -> list[Table]:
    """Every run, and the table."""
    rows = tuple(
        (time.agent, result.seed + i, round(value, 5)) for time in result.times for i, value in enumerate(time.seconds)
    )
    table = tuple(
        (
            TITLES[time.agent],
            *(float(f"{value:.3g}") for value in (time.median, min(time.seconds), max(time.seconds))),
            *(figures.get(time.agent) for figures in (PAPER_SECONDS, AUTHORS_SECONDS)),
        )
        for time in result.times
    )
    caption = f"Seconds for {result.steps} forced exploring steps in {WORLD}, of {len(result.times[0].seconds)} runs."
    heads = ("model", "median", "fastest", "slowest", "paper", "authors' code")
    return [
        Table("cost", ("agent", "seed", "seconds"), rows, "every run", shown=False),
        Table("cost_table", heads, table, caption),
    ]
