"""`cogmap kidnap`: moved without a word, one run for people, or a sweep."""

from typing import Any

import typer

from ..text import count, number, place_text, say, say_saved, seeds_of, spread
from . import options as opt
from .progress import counting


@opt.spread
def kidnap_command(
    at: opt.Where,
    sweep: opt.Sweep,
    max_steps: opt.MaxStepsTwice = None,
    turned: opt.Turned = False,
    json: opt.Json = None,
) -> None:
    """Explore a maze, then be moved to another room without a word: how soon does the agent know where it is?

    Exit code 0, or 1 where the one run (without --runs) did not recover.
    """
    from .. import Parts, chart_of, check_kidnap, check_outputs, kidnap_many, kidnap_result, workers, write_json

    place = at.made(turned=turned)
    parts = Parts.named(preset=sweep.preset, policies=sweep.policies, look_ahead=at.look_ahead, pose=at.pose)
    options: Any = {"agent": parts, "max_steps": max_steps}
    check_kidnap(place)
    check_outputs([json], inputs=[at.world])
    name, many = chart_of(place).name, sweep.runs or 1
    with (
        workers(jobs=sweep.jobs, dask=sweep.dask) as executor,
        counting(f"kidnapping in {name}", many) as one_more,
    ):
        done = kidnap_many(place, runs=many, seed=at.seed, executor=executor, on_done=one_more, **options)
    result = kidnap_result(place, done, **options)
    say(*(_one(result) if sweep.runs is None else _many(result)), title=name)
    if json is not None:
        write_json(json, result)
    say_saved(runs=json)
    if sweep.runs is None and not done[0].recovered:
        raise typer.Exit(1)


def _one(result: dict[str, Any]) -> list[str]:
    run, most = result["runs"][0], count(result["summary"]["max_steps"], "step")
    if run["moved_to"] is None:
        return [f"Not explored after {most}; allow more with --max-steps."]
    steps = run["steps_to_recover"]
    found = f"not recovered after {most}" if steps is None else f"recovered after {count(steps, 'step')}"
    explored = f"explored from {place_text(run['start'])} in {count(run['steps_to_explore'], 'step')}"
    return [
        f"{explored}, then moved to {place_text(run['moved_to'])} without a word",
        f"{found}; certain but wrong at {run['steps_certain_but_wrong']}",
        f"map intact: {'yes' if run['map_intact'] else 'no'}",
    ]


def _many(result: dict[str, Any]) -> list[str]:
    summary = result["summary"]
    total, most = summary["runs"], number(summary["most_steps_to_recover"], digits=0)
    parts = (f"{name.replace('_', ' ')} {summary[name]}/{total}" for name in ("explored", "recovered", "map_intact"))
    lines = [
        ", ".join(parts),
        f"steps to recover: {spread(summary, 'steps_to_recover')} (mean ± standard deviation), most {most}",
        f"steps certain but wrong: {number(summary['mean_steps_certain_but_wrong'])} (mean)",
    ]
    if lost := seeds_of(result, lambda run: not run["recovered"]):
        lines.append(f"not recovered with seeds {lost}")
    if harmed := seeds_of(result, lambda run: run["map_intact"] is False):
        lines.append(f"map not intact with seeds {harmed}")
    return lines
