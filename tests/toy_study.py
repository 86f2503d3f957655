"""A study that takes no time, of a file outside the package."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from cogmap.agent import Settings
from cogmap.experiments.studies import Findings, Study, Table, failed_seeds
from matplotlib.figure import Figure

NASTY = "a|b *c* _d_ <e> `f` [g](h) & ![i](j) \\ k_l"


@dataclass(frozen=True)
class Row:
    seed: int
    look_ahead: int
    at: tuple[int, int]
    choice: Any
    steps: tuple[dict[str, Any], ...]


@dataclass(frozen=True)
class Toy(Study[int, Row]):
    """A toy: a|b *c* _d_ <e> `f` [g](h) & ![i](j) \\ k_l

    Does it do
    anything?
    """

    name = "toy"
    notes = (NASTY,)
    agents = 3
    settings = Settings(look_ahead=9, goal_weight=2.0)

    loud: bool = False
    times: int = 2

    def run(self, task: int, settings: Settings) -> Row:
        if self.loud:
            raise RuntimeError("out of\nluck")
        steps = tuple({"x": number, "ways": [{"p": 0.5}] * number} for number in range(self.times))
        return Row(task, settings.look_ahead, (task, 2), {"route": 3} if task % 2 else None, steps)

    def summarise(self, rows: Sequence[Row]) -> Findings:
        summary = {"agents": len(rows), "part": {"half": 0.5, "yes": True, NASTY: NASTY}}
        figures = {"toy_one": lambda: Figure(), "toy_two": lambda: Figure()}
        failed = failed_seeds(NASTY, rows, lambda row: row.choice is None)
        return Findings({"rows": rows, "summary": summary}, [f"{len(rows)} rows"], figures, failed=failed)


@dataclass(frozen=True)
class Tabled(Toy):
    """Another toy

    Has it tables of its own?
    """

    name = "tabled"

    def summarise(self, rows: Sequence[Row]) -> Findings:
        values = (None, True, False, 3, 0.5, 12345.6, 1 / 3, "x, y", '"', "two\nlines")
        tables = [
            Table("tabled", [f"c{number}" for number in range(len(values))], [values], "every kind"),
            Table("tabled_hidden", ["c"], [(1,)], "hidden", shown=False),
        ]
        return Findings({"rows": rows}, ["not in the report"], {}, tables)
