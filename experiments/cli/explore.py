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


def explore_command(
    world: opt.World,
    agent: opt.Agent = "cogmap",
    runs: opt.Runs = None,
    seed: opt.Seed = 0,
    look_ahead: opt.LookAhead = 6,
    max_steps: MaxSteps = None,
    steps: Steps = None,
    noise: opt.Noise = None,
    sights: opt.Sights = None,
    format: opt.Format = "text",
    pose: opt.Pose = None,
    told: opt.Told = None,
    cost: opt.Cost = "steps",
    view: opt.View = None,
    tiles: opt.Tiles = None,
    policies: opt.Policies = None,
    preset: opt.Preset = "cogmap",
    growth: Growth = "predicted",
    engine: Engine = "numpy",
    jobs: opt.Jobs = 1,
    dask: opt.Dask = None,
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
    from ...views import Scene, explore_figure
    from .registered import run_registered
    from .walk_text import show_walk

    if lab.is_registered(world):
        refused = {"--agent": agent != "cogmap", "--noise": bool(noise), "--sights": sights is not None}
        refused |= {"--tiles": tiles is not None, "--steps": steps is not None, "--growth": growth != "predicted"}
        refused |= {"--save": save is not None, "--trace": trace is not None, "--out": out is not None}
        refused |= {"--dask": dask is not None, "--pose": pose is not None, "--cost": cost != "steps"}
        how: Any = {"view": view, "runs": runs, "seed": seed, "look_ahead": look_ahead, "max_steps": max_steps}
        run_registered(world, errand=False, **how, jobs=jobs, json=json, refused=refused)
        return
    lower: Any = {"view": view, "tiles": tiles}
    place = opt.world_of(world, noise=noise, sights=sights, format=format, seed=seed, told=told, **lower)
    names = list(GROWTHS) if growth == "all" else list(dict.fromkeys(name.strip() for name in growth.split(",")))
    options: dict[str, Any] = {"policies": policies, "look_ahead": look_ahead, "engine": engine, "pose": pose}
    options["cost"] = cost
    every = [lab.Parts.named(agent, preset=preset, growth=name, **options) for name in names]
    sweep, chart = runs is not None or len(every) > 1, lab.chart_of(place)
    _check(agent, len(every), save, trace, out, dask=dask is not None and not sweep)
    if steps is not None and max_steps is not None:
        raise CogmapError("--steps walks on whatever is complete, and --max-steps gives up; give one of them")
    walked: Any = {"max_steps": max_steps, "steps": steps}
    picture = out if sweep or out is not None else lab.unused(lab.file_named(chart.name, ".png"))
    lab.check_outputs([json, save, trace, picture], inputs=[world], picture=picture)
    results: list[dict[str, Any]] = []
    if sweep:
        total = (runs or 1) * len(every)
        with lab.workers(jobs=jobs, dask=dask) as executor, counting(f"exploring {chart.name}", total) as one_more:
            where: Any = {"runs": runs or 1, "seed": seed, "executor": executor, "on_done": one_more}
            for parts in every:
                made = lab.explore_many(place, agent=parts, **walked, **where)
                results.append(lab.exploration(place, made, agent=parts, **walked))
        _show_sweeps(results)
    seen: list[Any] = []
    one = not sweep or save or trace or picture
    done = _walk(place, chart, seed, every[0], walked, trace, seen) if one else None
    if done is not None and not sweep:
        show_walk(chart, done, agent=agent)
        results = [lab.exploration(place, [done.run], agent=every[0], **walked)]
    if json is not None:
        lab.write_json(json, results[0] if len(results) == 1 else results)
    if done is not None and save is not None:
        done.walker.save(save)
    shown = None if done is None or picture is None else _drawn(chart, done.path)
    if done is not None and picture is not None and shown is None:
        say(f"No picture: more than {MOST_DRAWN} rooms were walked through, or stand beside.")
        picture = None
    if done is not None and picture is not None and shown is not None:
        known: dict[str, Any] = {"map_": done.walker.map, "trace": done.walker.trace} if agent == "cogmap" else {}
        if hasattr(world_seen := seen[0].unwrapped, "scene"):
            known["scene"] = Scene(*world_seen.scene())
        with progress("drawing", 1):
            title = f"{chart.name}{'' if shown is chart else ' (the part walked)'}, {agent}, seed {seed}"
            picture = lab.write_picture(
                picture, explore_figure(shown, done.path, title=title, **known), new=out is None
            )
    say_saved(runs=json, agent=save, trace=trace, picture=picture)
    if done is not None and not sweep and not done.finished and steps is None:
        say(f"Not complete after {len(done.path) - 1} steps; allow more with --max-steps.", style="bold red")
        raise typer.Exit(NOT_COMPLETE)


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


def _drawn(chart: Chart, path: Sequence[Any]) -> Chart | None:
    """What to draw of a world: all of it, or the part walked of a large one; None where that is too large as well."""
    from ...worlds import ChartPart

    if len(chart.places) <= PARTLY_DRAWN:
        return chart
    part = ChartPart.around(chart, path)
    return part if len(part.places) <= MOST_DRAWN else None


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
