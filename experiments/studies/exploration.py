"""The study `exploration`: the paper's table of the steps that each model needs to learn each maze.

Paper: D. de Tinguy, T. Verbelen, B. Dhoedt, "Learning dynamic cognitive map with autonomous navigation", 2024; its
table of "the average number of steps required to fully learn the environments". 20 runs a maze and model; its means
leave out the runs that never learned, and do not say how many those were.

Authors' code: the code published with the paper, run by us from random starts, nothing dropped (20 runs of its own
agent; 4 or 5 of CSCG, given up after 400 steps, 3x3 and T mazes only). One thread of a machine with two cores.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from .. import CSCG, Row
from .grid import COMPLETE, COUNTED, LEARN, LEGEND, MARK, NONE, STARTS, TITLES, Explorations, Steps, factor_text
from .intervals import Interval
from .study import Findings
from .tables import Table


@dataclass(frozen=True, slots=True)
class Figure:
    """A published mean."""

    mean: float  # over the runs that got there
    std: float | None = None  # of the same; None where it was not given, or of one run
    got: int | None = None  # how many those were; None where it was not said
    of: int | None = None  # how many there were; None where it was not said

    def __str__(self) -> str:
        spread = "" if self.std is None else f" ± {self.std:g}"
        return f"{self.mean:g}{spread}" + ("" if self.got is None else f" ({self.got}/{self.of})")


_MODELS = ("oracle", "cogmap", *CSCG)
_PAPER: dict[str, tuple[tuple[float, float | None], ...]] = {
    "3x3": ((11, None), (14.4, 2), (231.9, 59), (221.3, 35), (214.6, 44), (205.7, 22)),
    "3x3_alias": ((11, None), (18.1, 2), (376.3, 35), (201.5, 20), (338.8, 30), (210.4, 22)),
    "4x4": ((15, None), (34.0, 4), (375.7, 36), (405.5, 78), (419.6, 98), (380.5, 53)),
    "4x4_alias": ((15, None), (48.9, 9), (509.5, 107), (387.5, 67), (554.1, 70), (391.3, 66)),
    "t_maze": ((9, None), (12.5, 1), (284.5, 69), (297.7, 108), (261.7, 96), (232.5, 73)),
    "t_maze_alias": ((9.5, None), (14.3, 4), (592.5, 28), (282.7, 124), (602.0, 69), (341.0, 75)),
    "donut": ((13, None), (15.6, 2), (519.6, 127), (450.0, 87), (416.3, 105), (493.1, 132)),
}
PAPER: dict[tuple[str, str], Figure] = {
    (world, model): Figure(*figure) for world, row in _PAPER.items() for model, figure in zip(_MODELS, row, strict=True)
}
"""Steps to learn by maze and model, from the paper's table; `cogmap` stands for the paper's own agent."""

_CSCG_AUTHORS: dict[str, tuple[Figure, ...]] = {
    "3x3": (Figure(204, 24, 5, 5), Figure(225, 25, 5, 5), Figure(220, 34, 5, 5), Figure(225, 25, 5, 5)),
    "3x3_alias": (Figure(360, None, 1, 5), Figure(213, 12, 5, 5), Figure(360, None, 1, 5), Figure(213, 12, 5, 5)),
    "t_maze": (Figure(230, 57, 4, 4), Figure(280, 65, 3, 4), Figure(230, 57, 4, 4), Figure(293, 46, 3, 4)),
}
_OWN_AUTHORS: dict[str, tuple[float, float]] = {
    "3x3": (14.2, 1.7),
    "3x3_alias": (19.1, 5.1),
    "4x4": (33.9, 5.7),
    "4x4_alias": (42.9, 10.1),
    "t_maze": (12.5, 1.3),
    "t_maze_alias": (14.6, 5.7),
    "donut": (14.9, 1.4),
}
AUTHORS: dict[tuple[str, str], Figure] = {
    **{(world, "cogmap"): Figure(*own, 20, 20) for world, own in _OWN_AUTHORS.items()},
    **{(world, name): one for world, row in _CSCG_AUTHORS.items() for name, one in zip(CSCG, row, strict=True)},
}
"""Steps to learn by maze and model, of the authors' code as measured."""


@dataclass(frozen=True, slots=True)
class Factor:
    """How many times the steps of ours the best CSCG needs to learn a maze."""

    world: str
    best: str  # the CSCG with the smallest mean
    ratio: Interval | None  # a lower bound where the best is censored, None where ours is
    censored: bool
    steps_to_learn: Steps  # ours
    steps_to_complete: Steps  # ours, until it had visited every room as well
    best_steps_to_learn: Steps
    paper_ratio: float | None  # the same in the paper's table; None where it has no such maze

    def to_dict(self) -> dict[str, Any]:
        """The fields as JSON values."""
        every = {name: getattr(self, name) for name in self.__slots__}
        return {name: value.to_dict() if isinstance(value, Steps) else value for name, value in every.items()}


@dataclass(frozen=True)
class Exploration(Explorations):
    """Every model explores every maze of the paper's table."""

    name = "exploration"
    title = "Steps to learn a maze"
    question = (
        "How many moves does each model make until it believes every true transition of the maze (walls lead "
        "back, stay stays) at 0.6 or more? The paper's table: our agent beside four clone-structured graphs "
        "(CSCG), which see the sights of rooms alone or with the true position (pose), and navigate by Viterbi or"
        f" at random. {STARTS}"
    )
    notes = (
        COUNTED,
        "The paper's means leave out the runs of CSCG that never learned, and do not say how many.",
        "Oracle: the exact shortest walk through all rooms from the same starts. The paper's 11 for the 3x3 "
        "mazes is a formula; the true minimum is 8 or 9 by the start.",
        "cogmap senses the doors of its room and takes each open one as evidence of a transition, whether the place "
        "beyond is new or not; the authors' code does so for new places only, and must walk ways that ours need not.",
        "cogmap takes the best policy with seeded tie-breaks; the authors' code samples among near-equal ones.",
        "CSCG that navigates by Viterbi explores as its setting exploring says. With random, as in the authors' "
        "code, where nothing is preferred while it explores, it makes the same moves from the same seed as the "
        "random one, and both columns are alike; the paper's are, too.",
        "Where all rooms differ, sights alone tell a CSCG as much as sights and positions, and the walks are the same.",
        "CSCG senses no doors: it must try every move in every room, into walls as well, and random walks that do "
        "so take about as long as the paper reports if they never stay. Its random moves leave staying out, then, "
        "and what staying does is not asked of it; of cogmap it is.",
        "CSCG learns only when it is trained, every few moves: its steps come in multiples of that. A later "
        "training may spoil what an earlier one had right; what counts is the first that has everything right.",
    )
    what = LEARN

    def summarise(self, rows: Sequence[Row]) -> Findings:
        """The paper's table; ours beside the published; how many times our steps the best CSCG needs."""
        summary, columns = self.summary(rows), ("oracle", *self.models)
        steps = {(world, agent): self.steps(rows, world, agent) for world in self.worlds for agent in columns}
        factors = self.factors(rows)
        shown = [
            Table(
                "exploration_table",
                ("maze", *(TITLES[agent] for agent in columns)),
                [(world, *(_own(agent, steps[world, agent]) for agent in columns)) for world in self.worlds],
                f"Steps to learn, as in the paper's table; mean ± standard deviation (learned of runs). {LEGEND}.",
            ),
            Table(
                "exploration_compared",
                ("maze", "model", "mean ± sd", "95 % interval", "learned", "paper", "authors' code"),
                [_compared(*key, one) for key, one in steps.items()],
                f"Steps to learn beside the published; interval of the mean by bootstrap. {LEGEND}.",
            ),
            Table(
                "exploration_ratio",
                ("maze", "cogmap learned", "cogmap complete", "best CSCG", "its steps", "ratio", "ratio in the paper"),
                [_factor_row(factor) for factor in factors],
                f"How many times the steps of cogmap the best CSCG needs, with 95 % interval. {LEGEND}.",
            ),
        ]
        published = [{**row, **_published(row["world"], row["agent"])} for row in summary]
        return Findings(
            json={**self.json(rows, published), "ratios": [factor.to_dict() for factor in factors]},
            lines=_lines(steps, factors),
            figures={"exploration_steps": partial(self.figure, FIGURE, rows, _paper_mean, "the paper's mean")},
            tables=self.tables(rows, summary, shown),
            failed=self.failed(rows),
        )

    def factors(self, rows: Sequence[Row]) -> list[Factor]:
        """By maze, if a CSCG took part."""
        found: list[Factor] = []
        for world in self.worlds:
            if best := self.best(rows, world):
                own, both = self.steps(rows, world), self.steps(rows, world, what=COMPLETE)
                ratio = None if own.censored else best[1].over(own)
                found.append(Factor(world, best[0], ratio, best[1].censored, own, both, best[1], _paper_factor(world)))
        return found


FIGURE = "Steps to learn every transition (mean, 95 % bootstrap interval)"


def _own(agent: str, steps: Steps) -> str:
    return steps.mean_text() if agent == "oracle" else steps.counted_text()


def _compared(world: str, agent: str, steps: Steps) -> tuple[str, ...]:
    beside = (str(figures.get((world, agent), NONE)) for figures in (PAPER, AUTHORS))
    count = NONE if agent == "oracle" else f"{steps.got_there}/{steps.runs}"
    interval = f"{steps.low:.1f} to {steps.high:.1f}" + (MARK if steps.censored else "")
    return (world, TITLES[agent], steps.mean_text(), interval, count, *beside)


def _factor_row(factor: Factor) -> tuple[str | float | None, ...]:
    own = (steps.counted_text() for steps in (factor.steps_to_learn, factor.steps_to_complete))
    ratio, best = factor_text(factor.ratio, ".1f", censored=factor.censored), factor.best_steps_to_learn.counted_text()
    return (factor.world, *own, TITLES[factor.best], best, ratio, factor.paper_ratio)


def _lines(steps: dict[tuple[str, str], Steps], factors: Sequence[Factor]) -> list[str]:
    lines = [f"steps to learn, mean ± standard deviation (learned of runs); {LEGEND}"]
    for (world, agent), one in steps.items():
        lines += [world] if agent == "oracle" else []
        beside = f"  paper {PAPER[world, agent]}" if (world, agent) in PAPER else ""
        lines.append(f"  {TITLES[agent]:<17}{_own(agent, one):<46}{beside}".rstrip())
    for factor in factors:
        text = factor_text(factor.ratio, ".1f", censored=factor.censored)
        lines.append(f"{factor.world}: best CSCG ({TITLES[factor.best]}) over cogmap {text}")
    return lines


def _published(world: str, agent: str) -> dict[str, float | None]:
    paper, authors = PAPER.get((world, agent)), AUTHORS.get((world, agent))
    return {
        "paper_mean": paper and paper.mean,
        "paper_std": paper and paper.std,
        "authors_mean": authors and authors.mean,
        "authors_std": authors and authors.std,
        "authors_learned": authors and authors.got,
        "authors_runs": authors and authors.of,
    }


def _paper_mean(world: str, agent: str) -> float | None:
    return PAPER[world, agent].mean if (world, agent) in PAPER else None


def _paper_factor(world: str) -> float | None:
    if world not in _PAPER:
        return None
    return round(min(PAPER[world, model].mean for model in CSCG) / PAPER[world, "cogmap"].mean, 1)


STUDY = Exploration()
