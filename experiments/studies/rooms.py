"""The study `rooms`: the paper's figure of the steps until every room has been entered once."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from .. import CSCG, Row
from .grid import COUNTED, LEGEND, LOOKS, NONE, VISIT, Explorations, Grid, Steps, factor_text, steps_figure
from .intervals import Interval, bootstrap
from .study import Findings
from .tables import Table, Value

_SQUARES = {"3x3": 10.2, "3x3_alias": 9.8, "4x4": 18.8, "4x4_alias": 20.2}
_OTHERS = {"t_maze": 11.1, "t_maze_alias": 12.4, "donut": 13.1}
AUTHORS = {(world, "cogmap"): steps for world, steps in (_SQUARES | _OTHERS).items()}
"""Steps until every room was visited, of the authors' own agent as measured; 20 of 20 runs."""
FASTER = 0.30
"""The paper's claim for its figure of room discovery: "at least 30 % faster than CSCG". It gives no numbers."""
FIGURE = "Steps until every room was entered once (mean, 95 % bootstrap interval)"


@dataclass(frozen=True)
class Rooms(Explorations):
    """Steps until every room was entered

    How many moves does each model make until it has been in every room once? The paper's figure of room
    discovery, with nearest-frontier search and a random walk beside it. The paper claims: our agent
    discovers all rooms at least 30 % faster than CSCG. Run i has the seed S + i, which draws start and agent;
    every model sets out from the same starts.
    """

    name = "rooms"
    notes = (
        COUNTED,
        "The paper gives a figure without numbers; the only published numbers beside ours are of the authors' code.",
        "For cogmap a room counts once its map has it as visited.",
        "The random walk draws among the open doors. CSCG senses no doors: its random moves are drawn among "
        "all four, those into walls among them.",
    )
    what = VISIT

    models: tuple[str, ...] = ("cogmap", "frontier", "random", *CSCG)

    def summarise(self, rows: Sequence[Row]) -> Findings:
        grid = self.grid(rows)
        claims = [_claim(grid, world, agent) for world in self.worlds if (agent := self.best(grid, world))]
        lines = [f"steps until every room was entered once, mean ± standard deviation; {LEGEND}"]
        table: list[dict[str, Value]] = []
        for world in self.worlds:
            cells = {LOOKS[agent][0]: _cell(agent, grid[world, agent]) for agent in ("oracle", *self.models)}
            lines += [world, *(f"  {name:<17}{cell}" for name, cell in cells.items())]
            table.append({"maze": world, **cells, "authors' code: theirs": AUTHORS.get((world, "cogmap"))})
        heads = ("maze", "cogmap", "best CSCG", "its steps", "steps saved [95 %]", f"{FASTER:.0%} or more")
        claimed: list[list[Value]] = []
        for claim in claims:
            world, best, saved = claim["world"], claim["best"], factor_text(claim["saved"], ".0%", claim["censored"])
            own, its = (grid[world, agent].mean_text() for agent in ("cogmap", best))
            lines.append(f"{world}: {saved} fewer steps than the best CSCG ({LOOKS[best][0]})")
            claimed.append([world, own, LOOKS[best][0], its, saved, claim["claim_holds"]])
        caption = f"Steps until every room was entered once; mean ± standard deviation. {LEGEND}."
        holds = (
            f"The paper's claim: all rooms discovered at least {FASTER:.0%} faster than CSCG, taken as that share "
            f"of the steps of the best CSCG saved, at the lower end of the interval. {LEGEND}."
        )
        tables = Table.of("rooms_table", table, caption), Table("rooms_claim", heads, claimed, holds)
        found = self.found(rows, grid, *tables)
        found["json"]["claim"] = {"at_least": FASTER, "by_maze": claims}
        return Findings(
            lines=[*lines, f"the paper: at least {FASTER:.0%} faster than CSCG in every maze"],
            figures={"rooms_steps": partial(steps_figure, FIGURE, grid, self.cap, AUTHORS, "the authors' agent, mean")},
            **found,
        )


def _cell(agent: str, steps: Steps) -> str:
    return steps.text() if agent != "oracle" else steps.mean_text() or NONE


def _claim(grid: Grid, world: str, best: str) -> dict[str, Any]:
    """What share of the steps of the best CSCG `cogmap` saves; the claim must hold at the lower end of the interval.

    It is a lower bound where its steps are censored, None where ours are.
    """
    ours, its = grid[world, "cogmap"], grid[world, best]
    part = None if ours.censored else bootstrap(ours.values, its.values)
    saved = part and Interval(1.0 - part.value, 1.0 - part.high, 1.0 - part.low, part.count)
    holds = saved is not None and saved.low >= FASTER
    return {"world": world, "best": best, "saved": saved, "claim_holds": holds, "censored": its.censored}
