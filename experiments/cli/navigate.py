"""`cogmap navigate`: to a preferred sight, one run for people, or a sweep."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from .options import Agent, Dask, Jobs, Json, LookAhead, MaxStepsTwice, Policies, Runs, Seed, Trace, World

if TYPE_CHECKING:
    from ..navigating import NavigateOptions

Goal = Annotated[str, typer.Option(metavar="LABEL", help="The label to go to; the agent is there when it stays.")]
Unexplored = Annotated[bool, typer.Option("--unexplored", help="Set out in an unknown maze.")]
Close = Annotated[
    list[str] | None,
    typer.Option(metavar="ROW,COLUMN", help="Close this room once the maze is explored; may be given several times."),
]
Weight = Annotated[float, typer.Option(help="W: log preference of the goal over all other sights, in nats.")]


def navigate_command(
    world: World,
    goal: Goal,
    agent: Agent = "cogmap",
    unexplored: Unexplored = False,
    runs: Runs = None,
    seed: Seed = 0,
    look_ahead: LookAhead = 6,
    max_steps: MaxStepsTwice = None,
    policies: Policies = "map_guided",
    weight: Weight = 8.0,
    close: Close = None,
    jobs: Jobs = 1,
    dask: Dask = None,
    json: Json = None,
    trace: Trace = None,
) -> None:
    """Explore a maze, be moved to a random room without a word, then go to a sight: in how many steps?

    Exit code 0, or 1 where the one run (without --runs) did not reach it.
    """
    from ...worlds import load_world
    from ..executors import workers
    from ..goals import check_goal, parse_goal
    from ..navigating import navigate, navigate_many, navigate_result
    from ..output import check_outputs, write_json
    from ..parts import Parts
    from .progress import counting
    from .tables import say, say_saved
    from .tracing import Tracing, check_trace

    check_trace(agent, trace)
    maze = load_world(world).maze
    parts = Parts.named(agent, growth="predicted", policies=policies, look_ahead=look_ahead)
    label, known, closed = parse_goal(maze, goal), not unexplored, [_room(text) for text in close or ()]
    check_goal(maze, label, weight=weight, closed=closed, known=known)
    check_outputs([json, trace], inputs=[world])
    options: NavigateOptions = {
        "goal": label,
        "known": known,
        "weight": weight,
        "closed": closed,
        "agent": parts,
        "max_steps": max_steps,
    }
    with workers(jobs=jobs, dask=dask) as executor, counting(f"navigating in {maze.name}", runs or 1) as one_more:
        done = navigate_many(maze, runs=runs or 1, seed=seed, executor=executor, on_done=one_more, **options)
    result = navigate_result(maze, done, **options)
    say(*(_one(result) if runs is None else _many(result)), title=f"{maze.name}, goal {label}")
    if json is not None:
        write_json(json, result)
    if trace is not None:
        tracing = Tracing(trace, maze, title=f"{maze.name}, goal {label}, seed {seed}", goals=[label])
        navigate(maze, seed, watch=tracing, **options)
        tracing.save()
    say_saved(runs=json, trace=trace)
    if runs is None and not done[0].reached:
        raise typer.Exit(1)


def _room(text: str) -> tuple[int, int]:
    from ...model import CogmapError

    numbers = text.split(",")
    if len(numbers) != 2 or not all(number.strip().isdecimal() for number in numbers):
        raise CogmapError(f"close: {text!r} is no room; give ROW,COLUMN, such as 0,2")
    return int(numbers[0]), int(numbers[1])


def _one(result: dict[str, Any]) -> list[str]:
    from ..statistics import count

    run, most = result["runs"][0], result["summary"]["max_steps"]
    if run["start"] is None:
        return [f"Not explored after {count(most, 'step')}; allow more with --max-steps."]
    found = (
        f"reached after {count(run['steps'], 'step')}" if run["reached"] else f"not reached after {count(most, 'step')}"
    )
    found += f"; shortest possible {run['shortest']}"
    if result["unexplored"]:
        frontier = f"nearest-frontier search: {count(run['frontier_steps'], 'step')}"
        return [f"unexplored, from {tuple(run['start'])}", found, frontier]
    explored = f"explored from {tuple(run['explored_from'])} in {count(run['steps_to_explore'], 'step')}"
    return [f"{explored}, then moved to {tuple(run['start'])} without a word", found]


def _many(result: dict[str, Any]) -> list[str]:
    from ..statistics import number
    from .tables import seeds_of

    summary = result["summary"]
    lines = [f"reached {summary['reached']}/{summary['runs']}{', unexplored' if result['unexplored'] else ''}"]
    steps = f"steps: {number(summary['mean_steps'])} (mean), shortest possible {number(summary['mean_shortest'])}"
    if result["unexplored"]:
        steps += f", nearest-frontier search {number(summary['mean_frontier_steps'])}"
    lines.append(
        f"{steps}; in all {summary['total_steps']} for {summary['total_shortest']}, "
        f"ratio {number(summary['ratio'], digits=3)}"
    )
    if lost := seeds_of(result["runs"], lambda run: not run["reached"]):
        lines.append(f"not reached with seeds {lost}")
    return lines
