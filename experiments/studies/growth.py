"""The study `growth`: three ways to grow a map, after the paper's figure on internal map layouts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

from ...worlds import MAZES
from .. import Row
from .grid import COMPLETE, COUNTED, LEGEND, ORACLE, STARTS, Explorations, steps_figure
from .study import Findings
from .tables import Table

FIGURE = "Steps until every room was visited and every transition learned (mean, 95 % bootstrap interval)"


@dataclass(frozen=True)
class Growth(Explorations):
    """Agents that grow their map in each way explore the eight mazes."""

    name = "growth"
    title = "Three ways to grow a map"
    question = (
        "How many moves until every room was visited and every transition learned, by how the map grows? static "
        "knows the number of places from the start, observed adds a place once it was entered, predicted (ours) "
        f"once a door to it was seen. After the paper's figure on internal map layouts. {STARTS}"
    )
    notes = (
        COUNTED,
        "The paper's figure has no numbers.",
        "Predicted growth needs the fewest moves where a maze has loops. In the T mazes, which are trees, no "
        "place is reached by two doors and imagining brings nothing; in the donut, one ring, all walk the "
        "shortest way.",
    )
    what = COMPLETE

    worlds: tuple[str, ...] = tuple(MAZES)
    models: tuple[str, ...] = ("cogmap",)
    growths: tuple[str, ...] = ("static", "observed", "predicted")

    def summarise(self, rows: Sequence[Row]) -> Findings:
        """Means by maze and way to grow."""
        series = {way: [self.steps(rows, world, growth=way) for world in self.worlds] for way in self.growths}
        by_world = {world: [series[way][place] for way in self.growths] for place, world in enumerate(self.worlds)}
        lines = [f"steps to complete, mean ± standard deviation (complete of runs); {LEGEND}"]
        for world, every in by_world.items():
            lines += [world, *(f"  {way:<11}{one.text()}" for way, one in zip(self.growths, every, strict=True))]
        summary = [
            {"world": world, "growth": way, **one.to_dict()}
            for world, every in by_world.items()
            for way, one in zip(self.growths, every, strict=True)
        ]
        means = Table(
            "growth_table",
            ("maze", *self.growths),
            [(world, *(one.text() for one in every)) for world, every in by_world.items()],
            "Steps until every room was visited and every transition learned; mean ± standard deviation (complete of "
            f"runs) [95 % interval]. {LEGEND}.",
        )
        oracle = [self.steps(rows, world, growth=self.growths[0], what=ORACLE) for world in self.worlds]
        drawn = {"oracle": oracle, **series}
        return Findings(
            json=self.json(rows, summary),
            lines=lines,
            figures={"growth_steps": partial(steps_figure, FIGURE, self.worlds, drawn, cap=self.cap)},
            tables=self.tables(rows, summary, [means], by="growth"),
            failed=self.failed(rows),
        )


STUDY = Growth()
