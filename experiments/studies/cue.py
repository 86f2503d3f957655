"""The study `cue`: the T maze of active inference, whose cue tells where the reward is."""

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from ...agent import Agent, Settings
from ...baselines import CueOptimum
from ...model import NoPose
from ...views import BLUE, GREY
from ...worlds import NOTHING, REWARD, CueMaze
from .. import Record, mean
from .figures import Figure, panels, plot_bars
from .intervals import bootstrap
from .study import Findings, Study
from .tables import Table, Value

WANTED: dict[Hashable, float] = {REWARD: 3.0, NOTHING: -3.0}  # log preferences, in nats
Case = tuple[float, int]  # how often the cue is right, moves of a trial


@dataclass(frozen=True, slots=True)
class CueRun(Record):
    """One trial, and the same trial of the optimum."""

    right: float
    moves: int
    seed: int
    reward: float
    optimum: float
    asked: bool  # whether it went to the cue first


@dataclass(frozen=True)
class Cue(Study[tuple[Case, int], CueRun]):
    """A cue that tells where the reward is

    In one of two arms is a reward; a cue tells in which. The agent is given the maze as a map in two contexts, which it
    cannot see, and prefers reward to nothing. How much of the Bayes-optimal agent's rewards does it get?
    """

    name = "cue"
    agents = 200
    settings = Settings(look_ahead=3, hypotheses=None)
    notes = (
        "Each agent lives through one trial; both agents have the same trials.",
        "The map is known, so there are no hypotheses about it; what is open is the context.",
        "The optimum maximises rewards exactly, and knows how many moves a trial has; the agent does not.",
    )

    cases: tuple[Case, ...] = ((1.0, 2), (0.8, 2), (1.0, 3), (0.8, 3))

    def tasks(self, seeds: Sequence[int], settings: Settings) -> list[tuple[Case, int]]:
        return [(case, seed) for case in self.cases for seed in seeds]

    def run(self, task: tuple[Case, int], settings: Settings) -> CueRun:
        (right, moves), seed = task
        world = CueMaze(right=right, moves=moves)
        agent = Agent(world.motions, pose=NoPose(), map=world.map(), settings=settings, seed=seed)
        agent.prefer(WANTED)
        reward, first = _trial(world, agent, seed)
        optimum, _ = _trial(world, CueOptimum(world), seed)
        return CueRun(right, moves, seed, reward, optimum, first == "cue")

    def summarise(self, rows: Sequence[CueRun]) -> Findings:
        table = [_row(case, [row for row in rows if (row.right, row.moves) == case]) for case in self.cases]
        lines = ["  ".join(f"{key} {value}" for key, value in row.items()) for row in table]
        tables = [Table.of("cue_rewards", table, "Rewards a trial (means), beside the Bayes-optimal agent's.")]
        failed = [line for row, line in zip(table, lines, strict=True) if float(str(row["of the optimum"])) < 0.98]
        return Findings({"runs": rows, "summary": table}, lines, {"cue_rewards": partial(_bars, rows)}, tables, failed)


def _trial(world: CueMaze, agent: Any, seed: int) -> tuple[float, str]:
    """Rewards of a trial, and where the agent went first."""
    seen, _ = world.reset(seed=seed)
    rewards, first, ended = 0.0, "", False
    while not ended:
        action = agent.step(seen)
        first = first or world.motions.names[action]
        seen, reward, ended, _, _ = world.step(action)
        rewards += reward
    return rewards, first


def _row(case: Case, runs: Sequence[CueRun]) -> dict[str, Value]:
    got, best = (sum(values) for values in ([run.reward for run in runs], [run.optimum for run in runs]))
    return {
        "cue right": case[0],
        "moves": case[1],
        "trials": len(runs),
        "rewards": mean(run.reward for run in runs),
        "optimum": mean(run.optimum for run in runs),
        "of the optimum": round(got / best, 4) if best else 1.0,
        "asked first": sum(run.asked for run in runs),
    }


def _bars(rows: Sequence[CueRun]) -> Figure:
    figure, (ax,) = panels("Rewards a trial", (1, 1), (7.0, 4.0))
    cases = sorted({(row.right, row.moves) for row in rows}, key=lambda case: (case[1], -case[0]))
    for at, case in enumerate(cases):
        runs = [row for row in rows if (row.right, row.moves) == case]
        plot_bars(ax, [at - 0.2], [bootstrap([run.reward for run in runs])], width=0.38, color=BLUE)
        ax.bar([at + 0.2], [sum(run.optimum for run in runs) / len(runs)], width=0.38, color=GREY)
    ax.set_xticks(range(len(cases)), [f"right {right:.0%}, {moves} moves" for right, moves in cases])
    ax.set_ylabel("rewards (95 % bootstrap); grey: the optimum")
    return figure
