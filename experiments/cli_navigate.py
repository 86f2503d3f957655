"""`cogmap navigate`: to a preferred sight, one run for people, or a sweep."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from .cli_explore import Agent, Dask, Jobs, LookAhead, Policies, Runs, Seed, Trace, World
from .cli_kidnap import Json, MaxSteps

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
    max_steps: MaxSteps = None,
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
    from ..agent import Settings
    from ..worlds import load_world
    from .cli_progress import counting
    from .cli_table import show_lines
    from .closing import check_closed, parse_rooms
    from .executors import workers
    from .navigating import Options, check_goal, navigate, navigate_many, parse_goal
    from .navigation import navigate_result
    from .output import check_outputs, write_json
    from .tracing import check_trace, recorder_of, recording
    from .walkers import check_agent

    check_agent(agent)
    check_trace(agent, trace)
    maze = load_world(world).maze
    label, closed = parse_goal(maze, goal), parse_rooms(maze, close or [])
    check_closed(maze, label, closed, known=not unexplored)
    check_goal(maze, label, weight)
    check_outputs([json, trace])
    options: Options = {
        "goal": label,
        "known": not unexplored,
        "weight": weight,
        "agent": agent,
        "settings": Settings(look_ahead=look_ahead, policies=policies),
        "max_steps": max_steps,
        "closed": closed,
    }
    with (
        workers(jobs=jobs, dask=dask) as executor,
        counting(f"navigating in {maze.name}", runs or 1) as one_more,
    ):
        done = navigate_many(maze, runs=runs or 1, seed=seed, executor=executor, on_done=one_more, **options)
    result = navigate_result(maze, done, **options)
    show_lines(f"{maze.name}, goal {label}", _one(result) if runs is None else _many(result))
    if json is not None:
        write_json(json, result)
        show_lines(None, [f"runs saved: {json}"])
    if trace is not None:
        recorder = recorder_of(maze, title=f"{maze.name}, goal {label}, seed {seed}", goals=[label])
        navigate(maze, seed=seed, watch=recording(recorder), **options)
        recorder.save(trace)
        show_lines(None, [f"trace saved: {trace}"])
    if runs is None and not done[0].reached:
        raise typer.Exit(1)


def _one(result: dict[str, Any]) -> list[str]:
    from .cli_table import count

    run, most = result["runs"][0], result["summary"]["max_steps"]
    if run["start"] is None:
        return [f"Not explored after {count(most, 'step')}; allow more with --max-steps."]
    where = f"unexplored, from {tuple(run['start'])}"
    if not result["unexplored"]:
        where = (
            f"explored from {tuple(run['explored_from'])} in {count(run['steps_to_explore'], 'step')}, then moved to "
            f"{tuple(run['start'])} without a word"
        )
    found = (
        f"reached after {count(run['steps'], 'step')}" if run["reached"] else f"not reached after {count(most, 'step')}"
    )
    lines = [where, f"{found}; shortest possible {run['shortest']}"]
    if result["unexplored"]:
        lines.append(f"nearest-frontier search: {count(run['frontier_steps'], 'step')}")
    return lines


def _many(result: dict[str, Any]) -> list[str]:
    from .cli_table import number, seeds_of

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
