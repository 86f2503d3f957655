"""Options that several commands have."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, is_dataclass
from functools import wraps
from inspect import Parameter, Signature, signature
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
        help="What goes wrong, how often: sight, door, miss, slip, fail or moved (odometry, heading: by how much); "
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
    typer.Option(metavar="NAME", help="What a graph tells of a pose: motions, displacement, lengths, bearing or none."),
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

MINIGRID = "minigrid:"  # what the names of room mazes in MiniGrid begin with


@dataclass(frozen=True, slots=True)
class Where:
    """Where to walk: options of every command that makes an agent; see `spread`."""

    world: World
    seed: Seed = 0
    look_ahead: LookAhead = 6
    noise: Noise = None
    sights: Sights = None
    format: Format = "text"
    pose: Pose = None
    told: Told = None
    view: View = None
    tiles: Tiles = None

    def made(self, *, turned: bool = False, goal: str | None = None) -> Any:
        """The world."""
        from ...model import CogmapError
        from ...worlds import NoisyWorld, load_world

        rates, name, sights = _rates(self.noise or ()), self.world, self.sights
        given: Any = int(sights) if sights is not None and sights.isascii() and sights.isdecimal() else sights
        how: dict[str, Any] = {"format": self.format, "sights": given, "seed": self.seed}
        if name.startswith(MINIGRID):
            from ...body import BODILY, load_embodied

            of_body = {kind: rates.pop(kind) for kind in BODILY if kind in rates}
            how |= {
                "view": self.view,
                "tiles": self.tiles,
                "turned": turned,
                "noise": of_body,
                "white": goal == "white",
            }
            world = load_embodied(name.removeprefix(MINIGRID), **how)
        elif self.view is not None or self.tiles is not None or turned:
            only = f"--view, --tiles and --turned are for worlds of MiniGrid, such as {MINIGRID}3x3"
            raise CogmapError(f"{only}, not {name}")
        else:
            how["pose"] = self.told  # refused by name where it is not known
            world = load_world(name, **how)
        return NoisyWorld(world, **rates) if rates else world


@dataclass(frozen=True, slots=True)
class Sweep:
    """How often, with which agent and where it is worked out: options of the commands that make runs."""

    runs: Runs = None
    policies: Policies = None
    preset: Preset = "cogmap"
    jobs: Jobs = 1
    dask: Dask = None


def spread(command: Callable[..., None]) -> Callable[..., None]:
    """The command with options in the place of each parameter that is a dataclass: its fields."""
    own = {part.name: part for part in signature(command, eval_str=True).parameters.values()}
    groups: dict[str, Any] = {name: part.annotation for name, part in own.items() if is_dataclass(part.annotation)}

    @wraps(command)
    def run(**given: Any) -> None:
        made = {
            name: group(**{part.name: given.pop(part.name) for part in fields(group)}) for name, group in groups.items()
        }
        command(**made, **given)

    listed = [(signature(groups[name]).parameters.values() if name in groups else [part]) for name, part in own.items()]
    options = [option.replace(kind=Parameter.KEYWORD_ONLY) for group in listed for option in group]
    run.__annotations__ = {option.name: option.annotation for option in options}
    run.__signature__ = Signature(options)  # type: ignore[attr-defined]
    return run


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
