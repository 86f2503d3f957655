"""`cogmap explore`: one walk for people, or a sweep."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.markup import escape

from ..text import number, say, say_saved, seeds_of, show_table, spread
from . import options as opt
from .progress import counting, progress

if TYPE_CHECKING:
    from ...worlds import Chart
    from .. import Moment, Parts
    from ..exploring import Walk

MaxSteps = Annotated[int | None, typer.Option(min=1, help="Give up after so many; 50 a room + 50 unless given.")]
Steps = Annotated[int | None, typer.Option(min=1, help="Walk on for so many, whatever is complete by then.")]
Growth = Annotated[
    str, typer.Option(metavar="NAME", help="predicted, observed, static; several with commas, or all (cogmap only).")
]
Engine = Annotated[str, typer.Option(metavar="NAME", help="Of the window: numpy or gtsam (cogmap only).")]
Json = Annotated[
    Path | None, typer.Option(metavar="FILE", help="Write the runs as JSON; a list if there are several growths.")
]
Save = Annotated[
    Path | None, typer.Option(metavar="FILE.npz", help="Save the agent (of a sweep, that of its first run).")
]
Out = Annotated[
    Path | None,
    typer.Option(metavar="PICTURE", help="Where the picture goes; without --runs it is WORLD.png unless given."),
]
NOT_COMPLETE = 1
PARTLY_DRAWN, MOST_DRAWN = 2_000, 20_000
"""Rooms of a world of which the part walked is drawn alone, and of that part: a thousand take some seconds."""


@opt.spread
def explore_command(
    at: opt.Where,
    sweep: opt.Sweep,
    agent: opt.Agent = "cogmap",
    max_steps: MaxSteps = None,
    steps: Steps = None,
    cost: opt.Cost = "steps",
    growth: Growth = "predicted",
    engine: Engine = "numpy",
    json: Json = None,
    save: Save = None,
    trace: opt.Trace = None,
    out: Out = None,
) -> None:
    """Explore a maze, until every room was visited and every transition is believed at 0.6 or more.

    Exit code 0, or 1 where the one walk (without --runs) did not complete.
    """
    from ... import experiments as lab
    from ...model import GROWTHS, CogmapError
    from .registered import run_registered
    from .walk_text import show_walk

    if lab.is_registered(at.world):
        refused = {"--agent": agent != "cogmap", "--steps": steps, "--growth": growth != "predicted", "--save": save}
        refused |= {"--trace": trace, "--out": out, "--cost": cost != "steps"}
        run_registered(at, sweep, max_steps, json, errand=False, refused=refused)
        return
    place = at.made()
    names = list(GROWTHS) if growth == "all" else list(dict.fromkeys(name.strip() for name in growth.split(",")))
    options: Any = {"policies": sweep.policies, "look_ahead": at.look_ahead, "engine": engine, "pose": at.pose}
    every = [lab.Parts.named(agent, preset=sweep.preset, growth=name, cost=cost, **options) for name in names]
    several, chart = sweep.runs is not None or len(every) > 1, lab.chart_of(place)
    _check(agent, len(every), save, trace, out, dask=sweep.dask is not None and not several)
    if steps is not None and max_steps is not None:
        raise CogmapError("--steps walks on whatever is complete, and --max-steps gives up; give one of them")
    walked: Any = {"max_steps": max_steps, "steps": steps}
    picture = out if several or out is not None else lab.unused(lab.file_named(chart.name, ".png"))
    lab.check_outputs([json, save, trace, picture], inputs=[at.world], picture=picture)
    results: list[dict[str, Any]] = []
    if several:
        results = _sweeps(place, chart, at.seed, sweep, every, walked)
        _show_sweeps(results)
    seen: list[Any] = []
    one = not several or save or trace or picture
    done = _walk(place, chart, at.seed, every[0], walked, trace, seen) if one else None
    if done is not None and not several:
        show_walk(chart, done, agent=agent)
        results = [lab.exploration(place, [done.run], agent=every[0], **walked)]
    if json is not None:
        lab.write_json(json, results[0] if len(results) == 1 else results)
    if done is not None and save is not None:
        done.walker.save(save)
    if done is not None and picture is not None:
        title = f"{agent}, seed {at.seed}"
        picture = _picture(picture, chart, done, seen[0].unwrapped, title, mapped=agent == "cogmap", new=out is None)
    say_saved(runs=json, agent=save, trace=trace, picture=picture)
    if done is not None and not several and not done.finished and steps is None:
        say(f"Not complete after {len(done.path) - 1} steps; allow more with --max-steps.", style="bold red")
        raise typer.Exit(NOT_COMPLETE)


def _sweeps(
    place: Any, chart: Chart, seed: int, sweep: opt.Sweep, every: Sequence[Parts], walked: Any
) -> list[dict[str, Any]]:
    """The result of each of several agents."""
    from ... import experiments as lab

    runs = sweep.runs or 1
    with (
        lab.workers(jobs=sweep.jobs, dask=sweep.dask) as executor,
        counting(f"exploring {chart.name}", runs * len(every)) as one_more,
    ):
        where: Any = {"runs": runs, "seed": seed, "executor": executor, "on_done": one_more}
        made = [(parts, lab.explore_many(place, agent=parts, **walked, **where)) for parts in every]
    return [lab.exploration(place, done, agent=parts, **walked) for parts, done in made]


def _check(agent: str, growths: int, save: Path | None, trace: Path | None, out: Path | None, *, dask: bool) -> None:
    from ...model import CogmapError
    from .tracing import check_trace

    if save is not None and agent != "cogmap":
        raise CogmapError(f"agent {agent} has no map to save; leave --save out, or use --agent cogmap")
    if growths > 1 and agent != "cogmap":
        raise CogmapError(f"agent {agent} does not grow a map; leave --growth out, or use --agent cogmap")
    if growths > 1 and (save or trace or out):
        raise CogmapError("--save, --trace and --out keep one walk; give one --growth, or leave them out")
    check_trace(agent, trace)
    if dask:
        raise CogmapError("--dask is for sweeps; give --runs as well, or leave --dask out")


def _walk(place: Any, chart: Chart, seed: int, parts: Parts, walked: Any, trace: Path | None, seen: list[Any]) -> Walk:
    """Walk once, and record it; the world walked in is put into `seen`."""
    from ...worlds import place_of
    from .. import walk
    from .tracing import Tracing

    tracing, entered = Tracing(trace, chart, title=f"{chart.name}, seed {seed}"), set[Any]()
    with progress(f"exploring {chart.name}, rooms", len(chart.places)) as report:

        def watch(moment: Moment) -> None:
            seen[:] = [moment.world]
            entered.add(place_of(moment.info))
            report(len(entered))
            tracing(moment)

        done = walk(place, seed, agent=parts, watch=watch, **walked)
    tracing.save()
    return done


def _picture(path: Path, chart: Chart, done: Walk, world: Any, title: str, *, mapped: bool, new: bool) -> Path | None:
    """Draw the world, or the part walked of a large one; None, and a word about it, where that is too large as well."""
    from ...views import Scene, explore_figure
    from ...worlds import ChartPart
    from .. import write_picture

    shown, name = chart, chart.name
    if len(chart.places) > PARTLY_DRAWN:
        shown, name = ChartPart.around(chart, done.path), f"{chart.name} (the part walked)"
    if len(shown.places) > MOST_DRAWN:
        say(f"No picture: more than {MOST_DRAWN} rooms were walked through, or stand beside.")
        return None
    known: dict[str, Any] = {"map_": done.walker.map, "trace": done.walker.trace} if mapped else {}
    if hasattr(world, "scene"):
        known["scene"] = Scene(*world.scene())
    with progress("drawing", 1):
        return write_picture(path, explore_figure(shown, done.path, title=f"{name}, {title}", **known), new=new)


def _show_sweeps(results: list[dict[str, Any]]) -> None:
    """A line for each sweep: how many completed, and after how many steps (mean ± standard deviation)."""
    first, what = results[0], ("steps_to_visit_all", "steps_to_learn", "steps_to_complete")
    world, grown = f"[bold]{escape(first['world'])}[/bold]", "growth" in first["settings"]
    cells: list[list[str]] = []
    for result in results:
        summary, name = result["summary"], result["settings"].get("growth", result["agent"])
        steps = (*(spread(summary, each) for each in what), number(summary["mean_oracle_steps"]))
        done, ratio = f"{summary['completed']}/{summary['runs']}", number(summary["ratio"], digits=3)
        cells.append([name, done, *steps, ratio])
    headings = ("growth" if grown else "agent", ">done", ">visit all", ">learn", ">complete", ">oracle", ">ratio")
    say(f"{world}, agent {first['agent']}: steps, mean ± standard deviation", markup=True)
    show_table(headings, cells)
    for (name, *_), result in zip(cells, results, strict=True):
        if lost := seeds_of(result, lambda run: run["steps_to_complete"] is None):
            say(f"{name}: not complete with seeds {lost}", style="red")
