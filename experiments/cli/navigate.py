"""`cogmap navigate`: to a preferred sight, one run for people, or a sweep."""

from typing import Annotated, Any

import typer

from ..text import count, number, place_text, say, say_saved, seeds_of
from . import options as opt
from .progress import counting

Goal = Annotated[
    str | None,
    typer.Option(
        metavar="LABEL",
        help="The label to go to; the agent is there when it stays. An environment of MiniGrid has a goal of its own.",
        show_default=False,
    ),
]
Unexplored = Annotated[bool, typer.Option("--unexplored", help="Set out in an unknown maze.")]
Close = Annotated[
    list[str] | None,
    typer.Option(metavar="ROW,COLUMN", help="Close this room once the maze is explored; may be given several times."),
]
Weight = Annotated[float, typer.Option(help="W: log preference of the goal over all other sights, in nats.")]


@opt.spread
def navigate_command(
    at: opt.Where,
    sweep: opt.Sweep,
    goal: Goal = None,
    agent: opt.Agent = "cogmap",
    unexplored: Unexplored = False,
    max_steps: opt.MaxStepsTwice = None,
    weight: Weight = 8.0,
    close: Close = None,
    turned: opt.Turned = False,
    json: opt.Json = None,
    trace: opt.Trace = None,
) -> None:
    """Explore a maze, be moved to a random room without a word, then go to a sight: in how many steps?

    Exit code 0, or 1 where the one run (without --runs) did not reach it.
    """
    from ... import experiments as lab
    from ...model import CogmapError
    from .registered import run_registered
    from .tracing import Tracing, check_trace

    check_trace(agent, trace)
    if lab.is_registered(at.world):
        known = "setting out in a world that it knows (without --unexplored)"
        refused = {"--goal": goal, known: not unexplored, "--agent": agent != "cogmap", "--turned": turned}
        refused |= {"--close": close, "--trace": trace}
        run_registered(at, sweep, max_steps, json, errand=True, refused=refused)
        return
    if goal is None:
        raise CogmapError(f"navigate: {at.world} has no goal of its own; give --goal LABEL")
    place = at.made(turned=turned, goal=goal)
    label, name, many = lab.parse_goal(place, goal), lab.chart_of(place).name, sweep.runs or 1
    task: Any = {"weight": weight, "closed": [_room(text) for text in close or ()], "known": not unexplored}
    lab.check_goal(place, label, **task)
    lab.check_outputs([json, trace], inputs=[at.world])
    how: Any = {"policies": sweep.policies, "look_ahead": at.look_ahead, "pose": at.pose}
    parts = lab.Parts.named(agent, preset=sweep.preset, **how)
    options: Any = {"goal": label, "agent": parts, "max_steps": max_steps, **task}
    with (
        lab.workers(jobs=sweep.jobs, dask=sweep.dask) as executor,
        counting(f"navigating in {name}", many) as one_more,
    ):
        done = lab.navigate_many(place, runs=many, seed=at.seed, executor=executor, on_done=one_more, **options)
    result = lab.navigate_result(place, done, **options)
    say(*(_one(result) if sweep.runs is None else _many(result)), title=f"{name}, goal {label}")
    if json is not None:
        lab.write_json(json, result)
    if trace is not None:
        tracing = Tracing(trace, lab.chart_of(place), title=f"{name}, goal {label}, seed {at.seed}", goals=(label,))
        lab.navigate(place, at.seed, watch=tracing, **options)
        tracing.save()
    say_saved(runs=json, trace=trace)
    if sweep.runs is None and not done[0].reached:
        raise typer.Exit(1)


def _room(text: str) -> tuple[int, ...]:
    from ...model import CogmapError

    numbers = text.split(",")
    if len(numbers) != 2 or not all(number.strip().isdecimal() for number in numbers):
        raise CogmapError(f"close: {text!r} is no room; give ROW,COLUMN, such as 0,2")
    return tuple(map(int, numbers))


def _one(result: dict[str, Any]) -> list[str]:
    run, most = result["runs"][0], count(result["summary"]["max_steps"], "step")
    if run["start"] is None:
        return [f"Not explored after {most}; allow more with --max-steps."]
    reached = f"reached after {count(run['steps'], 'step')}" if run["reached"] else f"not reached after {most}"
    found, start = f"{reached}; shortest possible {run['shortest']}", place_text(run["start"])
    if result["unexplored"]:
        frontier = count(run["frontier_steps"], "step")
        return [f"unexplored, from {start}", found, f"nearest-frontier search: {frontier}"]
    explored = f"explored from {place_text(run['explored_from'])} in {count(run['steps_to_explore'], 'step')}"
    return [f"{explored}, then moved to {start} without a word", found]


def _many(result: dict[str, Any]) -> list[str]:
    summary, unexplored = result["summary"], result["unexplored"]
    steps = f"steps: {number(summary['mean_steps'])} (mean), shortest possible {number(summary['mean_shortest'])}"
    if unexplored:
        steps += f", nearest-frontier search {number(summary['mean_frontier_steps'])}"
    total = f"in all {summary['total_steps']} for {summary['total_shortest']}"
    lines = [
        f"reached {summary['reached']}/{summary['runs']}{', unexplored' if unexplored else ''}",
        f"{steps}; {total}, ratio {number(summary['ratio'], digits=3)}",
    ]
    if lost := seeds_of(result, lambda run: not run["reached"]):
        lines.append(f"not reached with seeds {lost}")
    return lines
