"""Options that several commands have."""

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

World = Annotated[str, typer.Argument(metavar="WORLD", help="A built-in name, a maze or graph file, or minigrid:MAZE.")]
Sights = Annotated[
    str | None,
    typer.Option(
        metavar="KIND", help="For places without a sight: distinct, ways (how many there are), or K at random."
    ),
]
Format = Annotated[str, typer.Option(metavar="NAME", help="Of a maze file: text, commas or ascii.")]
Noise = Annotated[
    list[str] | None,
    typer.Option(
        metavar="KIND=RATE",
        help="What goes wrong, how often: sight, door, slip, fail or moved (odometry, heading: by how much); "
        "of a body in MiniGrid pixels, gain or slips. Several.",
    ),
]
Pose = Annotated[
    str | None,
    typer.Option(metavar="NAME", help="How places lie to each other: lattice, or none (cogmap only). By the world."),
]
Cost = Annotated[
    str,
    typer.Option(metavar="NAME", help="What exploring takes little of: steps, or metres in a graph (cogmap only)."),
]
Agent = Annotated[
    str,
    typer.Option(metavar="NAME", help="cogmap, frontier, random, cscg, cscg_pose, cscg_random or cscg_pose_random."),
]
Runs = Annotated[
    int | None, typer.Option(min=1, help="Walk so often, run i with seed S + i; without it, once and in detail.")
]
Seed = Annotated[int, typer.Option(min=0, help="S: of the start room and of the agent.")]
LookAhead = Annotated[int, typer.Option(min=1, help="Steps that policies look ahead (cogmap only).")]
Policies = Annotated[
    str | None,
    typer.Option(
        metavar="NAME", help="map_guided, self_avoiding, l_shaped or exhaustive (cogmap only). By the preset."
    ),
]
Preset = Annotated[
    str, typer.Option(metavar="NAME", help="cogmap, or paper: the paper's own agent and choices (cogmap only).")
]
MaxStepsTwice = Annotated[
    int | None,
    typer.Option(min=1, help="Give up exploring after so many, and again what follows; 50 a room + 50 unless given."),
]
Jobs = Annotated[int, typer.Option(min=1, help="Processes of a sweep.")]
Dask = Annotated[
    str | None,
    typer.Option(
        metavar="ADDRESS", help="Run a sweep on the Dask cluster whose scheduler is there, like tcp://host:8786."
    ),
]
Json = Annotated[Path | None, typer.Option(metavar="FILE", help="Write the runs as JSON.")]
Trace = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="Record the walk (of a sweep, its first) for `cogmap replay`; .gz packs it."),
]


Told = Annotated[
    str | None,
    typer.Option(
        metavar="NAME", help="What a graph tells of a pose: motions, displacement, bearing or none. The most it can."
    ),
]
View = Annotated[
    str | None, typer.Option(metavar="NAME", help="Of a world of MiniGrid: symbolic (what it is unless given) or rgb.")
]
Tiles = Annotated[
    str | None,
    typer.Option(metavar="N or N-M", help="Of a world minigrid:MAZE: tiles a side of a room; 4 unless given."),
]
Turned = Annotated[
    bool, typer.Option("--turned", help="In a world of MiniGrid: a silent move turns the body, to a random heading.")
]

MINIGRID = "minigrid:"
"""What the names of room mazes in MiniGrid begin with."""


def world_of(
    name: str,
    *,
    noise: Sequence[str] | None,
    sights: str | None,
    format: str,
    seed: int,
    view: str | None = None,
    tiles: str | None = None,
    turned: bool = False,
    goal: str | None = None,
    told: str | None = None,
) -> Any:
    """The world of these options."""
    from ...model import CogmapError
    from ...worlds import NoisyWorld, load_world

    rates = _rates(noise or ())
    how: dict[str, Any]
    given: Any = int(sights) if sights is not None and sights.isascii() and sights.isdecimal() else sights
    if name.startswith(MINIGRID):
        from ...body import BODILY, load_embodied

        of_body = {kind: rates.pop(kind) for kind in BODILY if kind in rates}
        how = {"view": view, "tiles": tiles, "turned": turned, "noise": of_body, "white": goal == "white"}
        world = load_embodied(name.removeprefix(MINIGRID), format=format, sights=given, seed=seed, **how)
    elif view is not None or tiles is not None or turned:
        raise CogmapError(f"--view, --tiles and --turned are for worlds of MiniGrid, such as {MINIGRID}3x3, not {name}")
    else:
        how = {"format": format, "pose": told}  # refused by name where they are not known
        world = load_world(name, sights=given, seed=seed, **how)
    return NoisyWorld(world, **rates) if rates else world


def _rates(noise: Sequence[str]) -> dict[str, float]:
    from ...model import CogmapError

    rates: dict[str, float] = {}
    for text in noise:
        kind, _, rate = text.partition("=")
        try:
            value = float(rate)
        except ValueError:
            raise CogmapError(f"noise: {text!r} is no kind with a rate; give KIND=RATE, such as sight=0.1") from None
        if kind in rates:
            raise CogmapError(f"noise: {kind} is given twice; give one rate")
        rates[kind] = value
    return rates
