"""What each decision about the agent is worth: steps to complete, with the decision and without it.

    python benchmarks/ablations.py
    python benchmarks/ablations.py discount rates --mazes 4x4 4x4_alias --runs 20 --json ablations.json

Run i has seed i. Steps are the mean over the runs that completed; those that did not are counted.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from cogmap.agent import Settings
from cogmap.experiments import Parts, explore_many, summarise
from cogmap.inference.message import Belief, FilterOptions
from cogmap.model import TABLE_RATES, TEXT_RATES, Priors
from cogmap.planning import CHOICES
from cogmap.worlds import MAZES, Maze, spiral
from machine import arguments, write_json


@contextmanager
def _as_it_is() -> Generator[None]:
    yield


@contextmanager
def _never_committed() -> Generator[None]:
    """Beliefs keep every hypothesis when a new place is learned."""
    committed = Belief.committed
    Belief.committed = lambda self: self
    try:
        yield
    finally:
        Belief.committed = committed


@dataclass(frozen=True, slots=True)
class Variant:
    """One line of an ablation: settings and parts, and what is changed in the code beside them."""

    name: str
    settings: Settings = field(default_factory=Settings)
    change: Callable[[], Any] = _as_it_is
    parts: dict[str, str] = field(default_factory=dict[str, str])


DEFAULTS = Settings()
ABLATIONS: dict[str, Sequence[Variant]] = {
    "policies": [Variant(name, parts={"policies": name}) for name in ("map_guided", "self_avoiding", "l_shaped")],
    "choice": [Variant(name, parts={"choice": name}) for name in CHOICES],
    "discount": [Variant(f"{value:g}", Settings(discount=value)) for value in (1.0, 0.98, 0.95, 0.9, 0.8)],
    "sight": [Variant(f"{value:g}", Settings(priors=Priors(sight=value))) for value in (1e-9, 1e-6, 1e-3, 0.1)],
    "transition": [Variant(f"{value:g}", Settings(priors=Priors(transition=value))) for value in (0.02, 0.1, 0.5, 1.0)],
    "rates": [Variant("table", Settings(rates=TABLE_RATES)), Variant("text", Settings(rates=TEXT_RATES))],
    "displacement": [
        Variant(f"{value:g}", Settings(filter=FilterOptions(displacement=value))) for value in (0.0, 1e-4, 1e-2)
    ],
    "commit": [Variant("committed"), Variant("kept apart", DEFAULTS, _never_committed)],
    "engine": [Variant(name, Settings(engine=name)) for name in ("numpy", "gtsam")],
}


def corridor(period: int) -> Maze:
    """A spiral of 38 rooms with the sights 0, 1, ..., period - 1 dealt out row by row."""
    return Maze(f"corridor{period}", {room: i % period for i, room in enumerate(spiral(8).rooms)})


def maze_named(name: str) -> Maze:
    """A built-in maze, or `corridor1`, `corridor2`, ..."""
    if name in MAZES:
        return MAZES[name]
    if name.startswith("corridor") and name[8:].isdecimal() and int(name[8:]):
        return corridor(int(name[8:]))
    raise argparse.ArgumentTypeError(f"no maze {name!r}; use one of {', '.join(MAZES)}, or corridor1, corridor2, ...")


def measured(variant: Variant, maze: Maze, runs: int, max_steps: int) -> dict[str, Any]:
    """How many runs completed, and after how many steps."""
    with variant.change():
        done = explore_many(
            maze, runs=runs, agent=Parts(settings=variant.settings, **variant.parts), max_steps=max_steps
        )
    summary = summarise(done, max_steps=max_steps)
    return {name: summary[name] for name in ("runs", "completed", "mean_steps_to_complete", "ratio")}


def _arguments(given: Sequence[str] | None) -> argparse.Namespace:
    parser = arguments(__doc__, ablations=ABLATIONS)
    parser.add_argument("--mazes", nargs="+", type=maze_named, default=[MAZES["4x4"], MAZES["4x4_alias"]])
    parser.add_argument("--runs", type=int, default=10)
    parser.add_argument("--max-steps", type=int, default=300)
    return parser.parse_args(given)


def main(given: Sequence[str] | None = None) -> None:
    """Measure and print."""
    asked = _arguments(given)
    rows: list[dict[str, Any]] = []
    for ablation in asked.ablations:
        for maze in asked.mazes:
            print(f"{ablation}, {maze.name}, {asked.runs} runs")
            for variant in ABLATIONS[ablation]:
                row = measured(variant, maze, asked.runs, asked.max_steps)
                rows.append({"ablation": ablation, "maze": maze.name, "variant": variant.name, **row})
                mean = row["mean_steps_to_complete"]
                steps = "-" if mean is None else f"{mean:.1f} steps, {row['ratio']:.2f} of the oracle"
                print(f"  {variant.name:14} {row['completed']}/{row['runs']} completed, {steps}", flush=True)
    write_json(asked.json, {"max_steps": asked.max_steps, "rows": rows})


if __name__ == "__main__":
    main()
