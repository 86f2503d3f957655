"""`cogmap kidnap`: moved without a word, one run for people, or a sweep."""

from __future__ import annotations

from typing import Any

import typer

from .options import Dask, Jobs, Json, LookAhead, MaxStepsTwice, Policies, Runs, Seed, World


def kidnap_command(
    world: World,
    runs: Runs = None,
    seed: Seed = 0,
    look_ahead: LookAhead = 6,
    max_steps: MaxStepsTwice = None,
    policies: Policies = "map_guided",
    jobs: Jobs = 1,
    dask: Dask = None,
    json: Json = None,
) -> None:
    """Explore a maze, then be moved to another room without a word: how soon does the agent know where it is?

    Exit code 0, or 1 where the one run (without --runs) did not recover.
    """
    from ...worlds import load_world
    from ..executors import workers
    from ..kidnapping import check_kidnap, kidnap_many, kidnap_result
    from ..output import check_outputs, write_json
    from ..parts import Parts
    from .progress import counting
    from .tables import say, say_saved

    maze = load_world(world).maze
    parts = Parts.named(growth="predicted", policies=policies, look_ahead=look_ahead)
    check_kidnap(maze)
    check_outputs([json], inputs=[world])
    with workers(jobs=jobs, dask=dask) as executor, counting(f"kidnapping in {maze.name}", runs or 1) as one_more:
        done = kidnap_many(
            maze, runs=runs or 1, seed=seed, agent=parts, max_steps=max_steps, executor=executor, on_done=one_more
        )
    result = kidnap_result(maze, done, agent=parts, max_steps=max_steps)
    say(*(_one(result["runs"][0], result["summary"]) if runs is None else _many(result)), title=maze.name)
    if json is not None:
        write_json(json, result)
    say_saved(runs=json)
    if runs is None and not done[0].recovered:
        raise typer.Exit(1)


def _one(run: dict[str, Any], summary: dict[str, Any]) -> list[str]:
    from ..statistics import count

    if run["moved_to"] is None:
        return [f"Not explored after {count(summary['max_steps'], 'step')}; allow more with --max-steps."]
    steps = run["steps_to_recover"]
    found = count(summary["max_steps"] if steps is None else steps, "step")
    return [
        f"explored from {tuple(run['start'])} in {count(run['steps_to_explore'], 'step')}, then moved to "
        f"{tuple(run['moved_to'])} without a word",
        f"{'not ' if steps is None else ''}recovered after {found}; certain but wrong at "
        f"{run['steps_certain_but_wrong']}",
        f"map intact: {'yes' if run['map_intact'] else 'no'}",
    ]


def _many(result: dict[str, Any]) -> list[str]:
    from ..statistics import number, spread
    from .tables import seeds_of

    summary, runs = result["summary"], result["runs"]
    total = summary["runs"]
    lines = [
        f"explored {summary['explored']}/{total}, recovered {summary['recovered']}/{total}, "
        f"map intact {summary['map_intact']}/{total}",
        f"steps to recover: {spread(summary, 'steps_to_recover')} (mean ± standard deviation), "
        f"most {number(summary['most_steps_to_recover'], digits=0)}",
        f"steps certain but wrong: {number(summary['mean_steps_certain_but_wrong'])} (mean)",
    ]
    if lost := seeds_of(runs, lambda run: not run["recovered"]):
        lines.append(f"not recovered with seeds {lost}")
    if harmed := seeds_of(runs, lambda run: run["map_intact"] is False):
        lines.append(f"map not intact with seeds {harmed}")
    return lines
