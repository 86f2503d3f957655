"""The study `growth`: three ways to grow a map, after the paper's figure on internal map layouts."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

from ...worlds import MAZES
from .. import Row
from .grid import COMPLETE, COUNTED, LEGEND, Explorations, steps_figure
from .study import Findings
from .tables import Table, Value

FIGURE = "Steps until every room was visited and every transition learned (mean, 95 % bootstrap interval)"


@dataclass(frozen=True)
class Growth(Explorations):
    """Three ways to grow a map

    How many moves until every room was visited and every transition learned, by how the map grows? static
    knows the number of places from the start, observed adds a place once it was entered, predicted (ours)
    once a door to it was seen. After the paper's figure on internal map layouts. Run i has the seed S + i,
    which draws start and agent; every model sets out from the same starts.
    """

    name = "growth"
    notes = (
        COUNTED,
        "The paper's figure has no numbers.",
        "Predicted growth needs the fewest moves where a maze has loops. In the T mazes, which are trees, no "
        "place is reached by two doors and imagining brings nothing; in the donut, one ring, all walk the "
        "shortest way.",
    )
    what, by = COMPLETE, "growth"

    worlds: tuple[str, ...] = tuple(MAZES)
    models: tuple[str, ...] = ("cogmap",)
    growths: tuple[str, ...] = ("static", "observed", "predicted")

    def summarise(self, rows: Sequence[Row]) -> Findings:
        drawn = self.grid(rows)
        grid = {key: steps for key, steps in drawn.items() if key[1] != "oracle"}
        lines = [f"steps to complete, mean ± standard deviation (complete of runs); {LEGEND}"]
        table: list[dict[str, Value]] = []
        for world in self.worlds:
            texts = {way: grid[world, way].text() for way in self.growths}
            lines += [world, *(f"  {way:<11}{text}" for way, text in texts.items())]
            table.append({"maze": world, **texts})
        caption = (
            "Steps until every room was visited and every transition learned; mean ± standard deviation (complete of "
            f"runs) [95 % interval]. {LEGEND}."
        )
        figures = {"growth_steps": partial(steps_figure, FIGURE, drawn, self.cap)}
        return Findings(
            lines=lines, figures=figures, **self.found(rows, grid, Table.of("growth_table", table, caption))
        )
