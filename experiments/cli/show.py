"""`cogmap show`: what a world is like, as figures and as a picture."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..text import count, say, say_saved, show_facts
from . import options as opt
from .progress import progress

if TYPE_CHECKING:
    from ...worlds import Chart

Out = Annotated[
    Path | None, typer.Option(metavar="PICTURE", help="Where the picture goes; WORLD.png in this folder unless given.")
]
MOST_DRAWN = 20_000  # places of the largest world that is drawn


def show_command(
    world: opt.World,
    sights: opt.Sights = None,
    format: opt.Format = "text",
    told: opt.Told = None,
    seed: opt.Seed = 0,
    json: opt.Json = None,
    out: Out = None,
) -> None:
    """Show a world: its places and ways in figures, how few steps it takes to see all of it, and a picture."""
    from ... import experiments as lab
    from ...views import world_figure
    from ...worlds import is_graph_file

    if sights is None and is_graph_file(world):
        sights = "ways"  # of those that name none
    place = opt.Where(world, seed, sights=sights, format=format, told=told).made()
    chart = lab.chart_of(place)
    picture = out or lab.unused(lab.file_named(chart.name, ".png"))
    lab.check_outputs([json, picture], inputs=[world], picture=picture)
    with progress(f"looking at {chart.name}", 1):
        facts = _facts(chart)
    show_facts(_words(facts))
    if json is not None:
        lab.write_json(json, facts)
    drawn: Path | None = None
    if len(chart.places) <= MOST_DRAWN:
        with progress("drawing", 1):
            drawn = lab.write_picture(picture, world_figure(chart), new=out is None)
    else:
        say(f"No picture: more than {MOST_DRAWN:,} places.")
    say_saved(facts=json, picture=drawn)


def _facts(chart: Chart) -> dict[str, Any]:
    """What there is to know of a world, as plain JSON values; None of what nobody knows or what is out of reach."""
    from .. import frontier_mean, oracle_steps, tour_steps

    ways = [(a, way, b) for a in chart.places for way, b in chart.exits(a).items() if b is not None and b != a]
    pairs = {(a, b) for a, _, b in ways}
    lengths = [length for a, way, _ in ways if (length := chart.length(a, way)) is not None]
    sights, start = list(chart.sights.values()), chart.places[0]
    return {
        "world": chart.name,
        "places": len(chart.places),
        "ways": len(ways),
        "one_way": sum((b, a) not in pairs for a, b in pairs),
        "most_ways": max(Counter(a for a, _, _ in ways).values(), default=0),
        "metres": round(sum(lengths), 6) if ways and len(lengths) == len(ways) else None,
        "positions": chart.positions is not None,
        "told": getattr(chart, "pose", None),
        "sights": len(set(sights)),
        "aliased": len(set(sights)) < len(sights),
        "start": list(start) if isinstance(start, tuple) else start,
        "oracle_steps": oracle_steps(chart, start),
        "tour_steps": tour_steps(chart, start),
        "frontier_steps": frontier_mean(chart, start, "steps"),
    }


def _words(facts: dict[str, Any]) -> dict[str, str]:
    ways = f"{count(facts['ways'], 'way')}, {facts['one_way']} of them one-way, at most {facts['most_ways']} at a place"
    metres = "not known" if facts["metres"] is None else f"{facts['metres']:.1f} together"
    words = {
        "world": facts["world"],
        "places": f"{count(facts['places'], 'place')}, {'' if facts['positions'] else 'no '}positions known",
        "ways": ways,
        "lengths": metres,
        "sights": f"{count(facts['sights'], 'different sight')}{', aliased' if facts['aliased'] else ''}",
    }
    if facts["told"] is not None:
        words["told of a pose"] = facts["told"]
    names = {"oracle_steps": "shortest possible", "tour_steps": "best tour found", "frontier_steps": "nearest frontier"}
    return words | {name: _steps(facts[key], facts["start"]) for key, name in names.items()}


def _steps(steps: float | None, start: Sequence[Any] | Any) -> str:
    return "-" if steps is None else f"{steps:g} steps from {tuple(start) if isinstance(start, list) else start}"
