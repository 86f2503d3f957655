"""`cogmap explore`: one walk for people, or a sweep."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from ..agent import Settings


World = Annotated[str, typer.Argument(metavar="WORLD", help="A built-in name, or a maze text file.")]
Agent = Annotated[
    str,
    typer.Option(metavar="NAME", help="cogmap, frontier, random, cscg, cscg_pose, cscg_random or cscg_pose_random."),
]
Runs = Annotated[
    int | None, typer.Option(min=1, help="Walk so often, run i with seed S + i; without it, once and in detail.")
]
Seed = Annotated[int, typer.Option(min=0, help="S: of the start room and of the agent.")]
LookAhead = Annotated[int, typer.Option(min=1, help="Steps that policies look ahead (cogmap only).")]
MaxSteps = Annotated[int | None, typer.Option(min=1, help="Give up after so many; 50 a room + 50 unless given.")]
Policies = Annotated[
    str, typer.Option(metavar="NAME", help="map_guided, self_avoiding, l_shaped or exhaustive (cogmap only).")
]
Growth = Annotated[
    str, typer.Option(metavar="NAME", help="predicted, observed, static; several with commas, or all (cogmap only).")
]
Engine = Annotated[str, typer.Option(metavar="NAME", help="Of the window: numpy or gtsam (cogmap only).")]
Jobs = Annotated[int, typer.Option(min=1, help="Processes of a sweep.")]
Dask = Annotated[
    str | None,
    typer.Option(
        metavar="ADDRESS", help="Run a sweep on the Dask cluster whose scheduler is there, like tcp://host:8786."
    ),
]
Json = Annotated[
    Path | None, typer.Option(metavar="FILE", help="Write the runs as JSON; a list if there are several growths.")
]
Save = Annotated[
    Path | None, typer.Option(metavar="FILE.npz", help="Save the agent (of a sweep, that of its first run).")
]
Trace = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="Record the walk (of a sweep, its first) for `cogmap replay`; .gz packs it."),
]
Out = Annotated[
    Path | None,
    typer.Option(metavar="PICTURE", help="Where the picture goes; without --runs it is WORLD.png unless given."),
]


def explore_command(
    world: World,
    agent: Agent = "cogmap",
    runs: Runs = None,
    seed: Seed = 0,
    look_ahead: LookAhead = 6,
    max_steps: MaxSteps = None,
    policies: Policies = "map_guided",
    growth: Growth = "predicted",
    engine: Engine = "numpy",
    jobs: Jobs = 1,
    dask: Dask = None,
    json: Json = None,
    save: Save = None,
    trace: Trace = None,
    out: Out = None,
) -> None:
    """Explore a maze, until every room was visited and every transition is believed at 0.6 or more.

    Exit code 0, or 1 where the one walk (without --runs) did not complete.
    """
    from ..model.errors import CogmapError
    from ..worlds import load_world
    from .cli_run import Request, run_single, run_sweep
    from .executors import workers
    from .output import check_outputs, check_picture
    from .tracing import check_trace

    maze = load_world(world).maze
    settings = _settings(growth, look_ahead=look_ahead, policies=policies, engine=engine)
    sweep = runs is not None or len(settings) > 1
    picture = out if sweep or out is not None else Path(f"{maze.name}.png")
    _check_kept(agent, len(settings), save, out or trace)
    check_trace(agent, trace)
    if dask is not None and not sweep:
        raise CogmapError("--dask is for sweeps; give --runs as well, or leave --dask out")
    check_outputs([json, save, trace, picture])
    if picture is not None:
        check_picture(picture)
    request = Request(maze, agent, seed, max_steps, json, save, trace, picture)
    if sweep:
        with workers(jobs=jobs, dask=dask) as executor:
            run_sweep(request, settings, runs or 1, executor)
    else:
        run_single(request, settings[0])


def _settings(growth: str, *, look_ahead: int, policies: str, engine: str) -> list[Settings]:
    from ..agent import Settings
    from ..model.growth import GROWTHS

    names = list(GROWTHS) if growth == "all" else [name.strip() for name in growth.split(",")]
    return [
        Settings(growth=name, look_ahead=look_ahead, policies=policies, engine=engine) for name in dict.fromkeys(names)
    ]


def _check_kept(agent: str, growths: int, save: Path | None, out: Path | None) -> None:
    from ..model.errors import CogmapError
    from .walkers import check_agent

    check_agent(agent)
    if save is not None and agent != "cogmap":
        raise CogmapError(f"agent {agent} has no map to save; leave --save out, or use --agent cogmap")
    if growths > 1 and agent != "cogmap":
        raise CogmapError(f"agent {agent} does not grow a map; leave --growth out, or use --agent cogmap")
    if growths > 1 and (save or out):
        raise CogmapError("--save, --trace and --out keep one walk; give one --growth, or leave them out")
