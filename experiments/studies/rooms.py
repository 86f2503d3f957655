"""The study `rooms`: the paper's figure of the steps until every room has been entered once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

from .. import CSCG, Row
from .grid import COUNTED, LEGEND, NONE, STARTS, TITLES, VISIT, Explorations, Steps, factor_text
from .intervals import Interval
from .study import Findings
from .tables import Table

AUTHORS: dict[str, float] = {
    "3x3": 10.2,
    "3x3_alias": 9.8,
    "4x4": 18.8,
    "4x4_alias": 20.2,
    "t_maze": 11.1,
    "t_maze_alias": 12.4,
    "donut": 13.1,
}
"""Steps until every room was visited, of the authors' own agent as measured; 20 of 20 runs."""
FASTER = 0.30
"""The paper's claim for its figure of room discovery: "at least 30 % faster than CSCG". It gives no numbers."""
FIGURE = "Steps until every room was entered once (mean, 95 % bootstrap interval)"


@dataclass(frozen=True, slots=True)
class Faster:
    """How much sooner than the best CSCG `cogmap` has been in every room of a maze."""

    world: str
    best: str  # the CSCG with the smallest mean
    saved: Interval | None  # share of its steps; a lower bound where they are censored, None where ours are
    claim_holds: bool  # the paper's, at the lower end of the interval
    censored: bool


@dataclass(frozen=True)
class Rooms(Explorations):
    """Every model, nearest-frontier search and a random walk explore every maze of the paper's table."""

    name = "rooms"
    title = "Steps until every room was entered"
    question = (
        "How many moves does each model make until it has been in every room once? The paper's figure of room "
        "discovery, with nearest-frontier search and a random walk beside it. The paper claims: our agent "
        f"discovers all rooms at least 30 % faster than CSCG. {STARTS}"
    )
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
        """Means by maze and model, and the paper's claim."""
        summary, columns, faster = self.summary(rows), ("oracle", *self.models), self.faster(rows)
        steps = {(world, agent): self.steps(rows, world, agent) for world in self.worlds for agent in columns}
        lines = [f"steps until every room was entered once, mean ± standard deviation; {LEGEND}"]
        for (world, agent), one in steps.items():
            lines += [world] if agent == "oracle" else []
            lines.append(f"  {TITLES[agent]:<17}{_cell(agent, one)}")
        for part in faster:
            lines.append(f"{part.world}: {_share(part)} fewer steps than the best CSCG ({TITLES[part.best]})")
        shown = [
            Table(
                "rooms_table",
                ("maze", *(TITLES[agent] for agent in columns), "authors' code: theirs"),
                [
                    (world, *(_cell(agent, steps[world, agent]) for agent in columns), AUTHORS.get(world))
                    for world in self.worlds
                ],
                f"Steps until every room was entered once; mean ± standard deviation. {LEGEND}.",
            ),
            Table(
                "rooms_claim",
                ("maze", "cogmap", "best CSCG", "its steps", "steps saved [95 %]", f"{FASTER:.0%} or more"),
                [_claim_row(part, steps) for part in faster],
                f"The paper's claim: all rooms discovered at least {FASTER:.0%} faster than CSCG, taken as that share "
                f"of the steps of the best CSCG saved, at the lower end of the interval. {LEGEND}.",
            ),
        ]
        return Findings(
            json={**self.json(rows, summary), "claim": {"at_least": FASTER, "by_maze": faster}},
            lines=[*lines, f"the paper: at least {FASTER:.0%} faster than CSCG in every maze"],
            figures={"rooms_steps": partial(self.figure, FIGURE, rows, _authors, "the authors' agent, mean")},
            tables=self.tables(rows, summary, shown),
            failed=self.failed(rows),
        )

    def faster(self, rows: Sequence[Row]) -> list[Faster]:
        """By maze, if a CSCG took part."""
        found: list[Faster] = []
        for world in self.worlds:
            if best := self.best(rows, world):
                own = self.steps(rows, world)
                part = None if own.censored else own.over(best[1])
                saved = part and Interval(1.0 - part.value, 1.0 - part.high, 1.0 - part.low, part.count)
                holds = saved is not None and saved.low >= FASTER
                found.append(Faster(world, best[0], saved, holds, best[1].censored))
        return found


def _cell(agent: str, steps: Steps) -> str:
    return steps.mean_text() or NONE if agent == "oracle" else steps.text()


def _share(part: Faster) -> str:
    return factor_text(part.saved, ".0%", censored=part.censored)


def _claim_row(part: Faster, steps: dict[tuple[str, str], Steps]) -> tuple[str | bool, ...]:
    own, best = (steps[part.world, agent].mean_text() for agent in ("cogmap", part.best))
    return part.world, own, TITLES[part.best], best, _share(part), part.claim_holds


def _authors(world: str, agent: str) -> float | None:
    return AUTHORS.get(world) if agent == "cogmap" else None


STUDY = Rooms()
