"""The study `exploration`: the paper's table of the steps that each model needs to learn each maze.

Paper: D. de Tinguy, T. Verbelen, B. Dhoedt, "Learning dynamic cognitive map with autonomous navigation", 2024; its
table of "the average number of steps required to fully learn the environments". 20 runs a maze and model; its means
leave out the runs that never learned, and do not say how many those were.

Authors' code: the code published with the paper, run by us from random starts, nothing dropped (20 runs of its own
agent; 4 or 5 of CSCG, given up after 400 steps, 3x3 and T mazes only). One thread of a machine with two cores.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from .. import CSCG, Row
from .grid import COMPLETE, COUNTED, LEARN, LEGEND, LOOKS, NONE, Explorations, Grid, Steps, factor_text, steps_figure
from .intervals import bootstrap
from .study import Findings
from .tables import Table, Value

Figure = tuple[float, float | None] | tuple[float, float | None, int, int]
"""A published mean, its standard deviation (None where it was not given, or of one run), and how many got there of how
many, where it was said."""


def _by_model(rows: Mapping[str, Sequence[Figure]], models: Sequence[str]) -> dict[tuple[str, str], Figure]:
    return {(world, model): one for world, row in rows.items() for model, one in zip(models, row, strict=False)}


PAPER = _by_model(
    {
        "3x3": ((11, None), (14.4, 2), (231.9, 59), (221.3, 35), (214.6, 44), (205.7, 22)),
        "3x3_alias": ((11, None), (18.1, 2), (376.3, 35), (201.5, 20), (338.8, 30), (210.4, 22)),
        "4x4": ((15, None), (34.0, 4), (375.7, 36), (405.5, 78), (419.6, 98), (380.5, 53)),
        "4x4_alias": ((15, None), (48.9, 9), (509.5, 107), (387.5, 67), (554.1, 70), (391.3, 66)),
        "t_maze": ((9, None), (12.5, 1), (284.5, 69), (297.7, 108), (261.7, 96), (232.5, 73)),
        "t_maze_alias": ((9.5, None), (14.3, 4), (592.5, 28), (282.7, 124), (602.0, 69), (341.0, 75)),
        "donut": ((13, None), (15.6, 2), (519.6, 127), (450.0, 87), (416.3, 105), (493.1, 132)),
    },
    ("oracle", "cogmap", *CSCG),
)
"""Steps to learn by maze and model, from the paper's table; `cogmap` stands for the paper's own agent."""
AUTHORS = _by_model(
    {
        "3x3": ((14.2, 1.7, 20, 20), (204, 24, 5, 5), (225, 25, 5, 5), (220, 34, 5, 5), (225, 25, 5, 5)),
        "3x3_alias": ((19.1, 5.1, 20, 20), (360, None, 1, 5), (213, 12, 5, 5), (360, None, 1, 5), (213, 12, 5, 5)),
        "4x4": ((33.9, 5.7, 20, 20),),
        "4x4_alias": ((42.9, 10.1, 20, 20),),
        "t_maze": ((12.5, 1.3, 20, 20), (230, 57, 4, 4), (280, 65, 3, 4), (230, 57, 4, 4), (293, 46, 3, 4)),
        "t_maze_alias": ((14.6, 5.7, 20, 20),),
        "donut": ((14.9, 1.4, 20, 20),),
    },
    ("cogmap", *CSCG),
)
"""Steps to learn by maze and model, of the authors' code as measured."""
FIGURE = "Steps to learn every transition (mean, 95 % bootstrap interval)"


@dataclass(frozen=True)
class Exploration(Explorations):
    """Steps to learn a maze

    How many moves does each model make until it believes every true transition of the maze (walls lead back,
    stay stays) at 0.6 or more? The paper's table: our agent beside four clone-structured graphs (CSCG), which
    see the sights of rooms alone or with the true position (pose), and navigate by Viterbi or at random. Run i
    has the seed S + i, which draws start and agent; every model sets out from the same starts.
    """

    name = "exploration"
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
        grid, both = self.grid(rows), self.grid(rows, COMPLETE)
        factors = [_factor(grid, both, world, best) for world in self.worlds if (best := self.best(grid, world))]
        means = {key: figure[0] for key, figure in PAPER.items()}
        found = self.found(rows, grid, *_tables(grid, factors))
        summary = [{**line, **_published(line["world"], line["agent"])} for line in found["json"]["summary"]]
        found["json"] |= {"summary": summary, "ratios": factors}
        figures = {"exploration_steps": partial(steps_figure, FIGURE, grid, self.cap, means, "the paper's mean")}
        return Findings(lines=_lines(grid, factors), figures=figures, **found)


def _factor(grid: Grid, both: Grid, world: str, best: str) -> dict[str, Any]:
    """How many times our steps the best CSCG needs: a lower bound where it is censored, None where ours are."""
    ours, its = grid[world, "cogmap"], grid[world, best]
    theirs = [PAPER[world, model][0] for model in CSCG if (world, model) in PAPER]
    return {
        "world": world,
        "best": best,
        "ratio": None if ours.censored else bootstrap(its.values, ours.values),
        "censored": its.censored,
        "steps_to_learn": ours,
        "steps_to_complete": both[world, "cogmap"],
        "best_steps_to_learn": its,
        "paper_ratio": round(min(theirs) / PAPER[world, "cogmap"][0], 1) if theirs else None,
    }


def _tables(grid: Grid, factors: Sequence[dict[str, Any]]) -> list[Table]:
    by_maze: dict[str, dict[str, Value]] = {}
    compared: list[list[Value]] = []
    ratios: list[list[Value]] = []
    for (world, agent), steps in grid.items():
        by_maze.setdefault(world, {"maze": world})[LOOKS[agent][0]] = _own(agent, steps)
        counted = NONE if agent == "oracle" else f"{steps.got_there}/{steps.runs}"
        published = (_text(figures.get((world, agent))) for figures in (PAPER, AUTHORS))
        compared.append([world, LOOKS[agent][0], steps.mean_text(), steps.interval_text(), counted, *published])
    for one in factors:
        own = (one[name].counted_text() for name in ("steps_to_learn", "steps_to_complete"))
        best, ratio = one["best_steps_to_learn"].counted_text(), factor_text(one["ratio"], ".1f", one["censored"])
        ratios.append([one["world"], *own, LOOKS[one["best"]][0], best, ratio, one["paper_ratio"]])
    learned = f"Steps to learn, as in the paper's table; mean ± standard deviation (learned of runs). {LEGEND}."
    beside = f"Steps to learn beside the published; interval of the mean by bootstrap. {LEGEND}."
    times = f"How many times the steps of cogmap the best CSCG needs, with 95 % interval. {LEGEND}."
    heads = ("maze", "model", "mean ± sd", "95 % interval", "learned", "paper", "authors' code")
    names = ("maze", "cogmap learned", "cogmap complete", "best CSCG", "its steps", "ratio", "ratio in the paper")
    return [
        Table.of("exploration_table", list(by_maze.values()), learned),
        Table("exploration_compared", heads, compared, beside),
        Table("exploration_ratio", names, ratios, times),
    ]


def _own(agent: str, steps: Steps) -> str:
    return steps.mean_text() if agent == "oracle" else steps.counted_text()


def _text(figure: Figure | None) -> str:
    if figure is None:
        return NONE
    spread = "" if figure[1] is None else f" ± {figure[1]:g}"
    return f"{figure[0]:g}{spread}" + (f" ({figure[2]}/{figure[3]})" if len(figure) == 4 else "")


def _lines(grid: Grid, factors: Sequence[dict[str, Any]]) -> list[str]:
    lines = [f"steps to learn, mean ± standard deviation (learned of runs); {LEGEND}"]
    for (world, agent), steps in grid.items():
        lines += [world] if agent == "oracle" else []
        beside = f"  paper {_text(PAPER[world, agent])}" if (world, agent) in PAPER else ""
        lines.append(f"  {LOOKS[agent][0]:<17}{_own(agent, steps):<46}{beside}".rstrip())
    for one in factors:
        text = factor_text(one["ratio"], ".1f", one["censored"])
        lines.append(f"{one['world']}: best CSCG ({LOOKS[one['best']][0]}) over cogmap {text}")
    return lines


def _published(world: str, agent: str) -> dict[str, float | None]:
    paper, authors = ((*figures.get((world, agent), ()), *[None] * 4) for figures in (PAPER, AUTHORS))
    names = ("authors_mean", "authors_std", "authors_learned", "authors_runs")
    return {"paper_mean": paper[0], "paper_std": paper[1], **dict(zip(names, authors, strict=False))}
