"""What `cogmap explore` does once its input is known to be good."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import typer

from ..agent import Agent, Settings
from ..worlds import Maze, MazeEnv
from .cli_progress import counting, progress
from .cli_show import show_walk
from .cli_table import console, show_sweeps
from .exploring import Walk, walk
from .output import write_json, write_picture
from .sweep import exploration, explore_many
from .tracing import recorder_of, recording
from .walkers import Walker

NOT_COMPLETE = 1


@dataclass(frozen=True, slots=True)
class Request:
    """What was asked for, besides the settings of the agent."""

    maze: Maze
    agent: str
    seed: int
    max_steps: int | None
    json: Path | None
    save: Path | None
    trace: Path | None
    picture: Path | None


def run_single(request: Request, settings: Settings) -> None:
    """Walk once and show it.

    Raises:
        typer.Exit: with code 1, where the walk did not complete.
    """
    done = _walk(request, settings)
    show_walk(request.maze, done, agent=request.agent)
    result = exploration(request.maze, [done.run], agent=request.agent, settings=settings, max_steps=request.max_steps)
    _keep(request, [result], done)
    if not done.finished:
        message = f"Not complete after {len(done.path) - 1} steps; allow more with --max-steps."
        console().print(message, style="bold red", highlight=False)
        raise typer.Exit(NOT_COMPLETE)


def run_sweep(request: Request, settings: Sequence[Settings], runs: int, executor: Executor | None) -> None:
    """Walk `runs` times with each of the settings, and compare them in a table."""
    results: list[dict[str, Any]] = []
    with counting(f"exploring {request.maze.name}", runs * len(settings)) as one_more:
        for setting in settings:
            part = explore_many(
                request.maze,
                runs=runs,
                agent=request.agent,
                settings=setting,
                seed=request.seed,
                max_steps=request.max_steps,
                executor=executor,
                on_done=one_more,
            )
            results.append(
                exploration(request.maze, part, agent=request.agent, settings=setting, max_steps=request.max_steps)
            )
    show_sweeps(results)
    again = any(file is not None for file in (request.save, request.trace, request.picture))
    _keep(request, results, _walk(request, settings[0]) if again else None)


def _walk(request: Request, settings: Settings) -> Walk:
    recorder = recorder_of(request.maze, title=f"{request.maze.name}, seed {request.seed}")
    record = recording(recorder) if request.trace is not None else None
    with progress(f"exploring {request.maze.name}, rooms", len(request.maze.rooms)) as report:

        def watch(walker: Walker, world: MazeEnv, entered: int) -> None:
            report(entered)
            if record is not None:
                record(walker, world, entered)

        done = walk(
            request.maze,
            agent=request.agent,
            settings=settings,
            seed=request.seed,
            max_steps=request.max_steps,
            watch=watch,
        )
    if request.trace is not None:
        recorder.save(request.trace)
    return done


def _keep(request: Request, results: list[dict[str, Any]], done: Walk | None) -> None:
    """Write what was asked for, and say where it is."""
    written: list[tuple[str, Path]] = []
    if request.json is not None:
        write_json(request.json, results[0] if len(results) == 1 else results)
        written.append(("runs", request.json))
    if done is not None and request.save is not None and isinstance(done.walker, Agent):
        done.walker.save(request.save)
        written.append(("agent", request.save))
    if done is not None and request.trace is not None:
        written.append(("trace", request.trace))
    if done is not None and request.picture is not None:
        with progress("drawing", 1):
            write_picture(request.picture, _figure(request, done))
        written.append(("picture", request.picture))
    for what, path in written:
        console().print(f"{what} saved: {path}", markup=False, highlight=False, soft_wrap=True)


def _figure(request: Request, done: Walk) -> Any:
    from ..views import explore_figure

    agent = done.walker if isinstance(done.walker, Agent) else None
    return explore_figure(
        request.maze.sights,
        done.path,
        map_=None if agent is None else agent.map,
        trace=() if agent is None else agent.trace,
        title=f"{request.maze.name}, {request.agent}, seed {request.seed}",
    )
