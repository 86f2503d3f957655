"""`cogmap explore`: one walk for people, or a sweep."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .options import Agent, Dask, Jobs, LookAhead, Policies, Runs, Seed, Trace, World

if TYPE_CHECKING:
    from ..exploring import Walk
    from ..parts import Parts
    from ..running import Moment

MaxSteps = Annotated[int | None, typer.Option(min=1, help="Give up after so many; 50 a room + 50 unless given.")]
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
    from ...worlds import load_world
    from ..executors import workers
    from ..exploring import exploration
    from ..output import check_outputs, unused
    from .tables import say, show_sweeps
    from .walk_text import show_walk

    maze = load_world(world).maze
    every = _parts(agent, growth, policies=policies, look_ahead=look_ahead, engine=engine)
    sweep = runs is not None or len(every) > 1
    _check(agent, len(every), save, trace, out, dask=dask is not None and not sweep)
    picture = out if sweep or out is not None else unused(Path(f"{maze.name}.png"))
    check_outputs([json, save, trace, picture], inputs=[world], picture=picture)
    task = _Task(maze, seed, max_steps, save, trace, picture)
    if sweep:
        with workers(jobs=jobs, dask=dask) as executor:
            results = task.sweep(every, runs or 1, executor)
        show_sweeps(results)
        done = task.walk(every[0]) if save or trace or picture else None
    else:
        done = task.walk(every[0])
        show_walk(maze, done, agent=agent)
        results = [exploration(maze, [done.run], agent=every[0], max_steps=max_steps)]
    task.keep(json, results, agent, done)
    if done is not None and not sweep and not done.finished:
        say(f"Not complete after {len(done.path) - 1} steps; allow more with --max-steps.", style="bold red")
        raise typer.Exit(NOT_COMPLETE)


def _parts(agent: str, growth: str, **options: Any) -> list[Parts]:
    from ...model import GROWTHS
    from ..parts import Parts

    names = list(GROWTHS) if growth == "all" else [name.strip() for name in growth.split(",")]
    return [Parts.named(agent, growth=name, **options) for name in dict.fromkeys(names)]


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


@dataclass(frozen=True, slots=True)
class _Task:
    """What was asked for, besides the parts of the agent."""

    maze: Any
    seed: int
    max_steps: int | None
    save: Path | None
    trace: Path | None
    picture: Path | None

    def sweep(self, every: Sequence[Parts], runs: int, executor: Any) -> list[dict[str, Any]]:
        """Walk `runs` times with each of the parts."""
        from ..exploring import exploration, explore_many
        from .progress import counting

        results: list[dict[str, Any]] = []
        with counting(f"exploring {self.maze.name}", runs * len(every)) as one_more:
            for parts in every:
                done = explore_many(
                    self.maze,
                    runs=runs,
                    seed=self.seed,
                    agent=parts,
                    max_steps=self.max_steps,
                    executor=executor,
                    on_done=one_more,
                )
                results.append(exploration(self.maze, done, agent=parts, max_steps=self.max_steps))
        return results

    def walk(self, parts: Parts) -> Walk:
        """Walk once, and record it."""
        from ...worlds import place_of
        from ..exploring import walk
        from .progress import progress
        from .tracing import Tracing

        tracing = Tracing(self.trace, self.maze, title=f"{self.maze.name}, seed {self.seed}")
        entered: set[Any] = set()
        with progress(f"exploring {self.maze.name}, rooms", len(self.maze.rooms)) as report:

            def watch(moment: Moment) -> None:
                entered.add(place_of(moment.info))
                report(len(entered))
                tracing(moment)

            done = walk(self.maze, self.seed, agent=parts, max_steps=self.max_steps, watch=watch)
        tracing.save()
        return done

    def keep(self, json: Path | None, results: list[dict[str, Any]], agent: str, done: Walk | None) -> None:
        """Write what was asked for, and say where it is."""
        from ..output import write_json, write_picture
        from .progress import progress
        from .tables import say_saved

        if json is not None:
            write_json(json, results[0] if len(results) == 1 else results)
        if done is not None and self.save is not None:
            done.walker.save(self.save)
        if done is not None and self.picture is not None:
            with progress("drawing", 1):
                write_picture(self.picture, self._figure(done, agent))
        say_saved(runs=json, agent=self.save, trace=self.trace, picture=self.picture)

    def _figure(self, done: Walk, agent: str) -> Any:
        from ...views import explore_figure

        known = {"map_": done.walker.map, "trace": done.walker.trace} if agent == "cogmap" else {}
        title = f"{self.maze.name}, {agent}, seed {self.seed}"
        return explore_figure(self.maze, done.path, title=title, **known)
