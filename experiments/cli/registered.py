"""`cogmap explore` and `cogmap navigate` in environments of MiniGrid by their ids."""

from pathlib import Path
from typing import Any

import typer

from ..text import count, number, say, say_saved, seeds_of
from .progress import counting


def run_registered(
    name: str,
    *,
    errand: bool,
    view: str | None,
    runs: int | None,
    seed: int,
    look_ahead: int,
    max_steps: int | None,
    jobs: int,
    json: Path | None,
    refused: dict[str, bool],
) -> None:
    """Run episodes, and show them.

    Args:
        name, errand, view, runs, seed, look_ahead, max_steps, jobs, json: see `run_id` and the commands.
        refused: options that make no sense there, by name, and whether they were given.
    """
    from ... import experiments as lab
    from ...agent import Settings
    from ...model import CogmapError

    if given := [option for option, is_given in refused.items() if is_given]:
        raise CogmapError(f"{name}: {given[0]} is for worlds whose truth is known, such as minigrid:3x3; leave it out")
    lab.check_outputs([json])
    how: Any = {"errand": errand, "view": view}
    own: Any = {"settings": Settings(look_ahead=look_ahead), "max_steps": max_steps}
    with lab.workers(jobs=jobs) as executor, counting(name, runs or 1) as one_more:
        done = lab.run_ids(name, runs=runs or 1, seed=seed, executor=executor, on_done=one_more, **how, **own)
    result = lab.ids_result(name, done, **how)
    say(*(_one(result) if runs is None else _many(result)), title=name)
    if json is not None:
        lab.write_json(json, result)
    say_saved(runs=json)
    if runs is None and not (done[0].reached if errand else done[0].explored or done[0].reached):
        raise typer.Exit(1)


def _one(result: dict[str, Any]) -> list[str]:
    run = result["runs"][0]
    took = f"{count(run['steps'], 'step')}, {count(run['low_level_steps'], 'low-level step')}"
    rooms = count(run["rooms"], "room")
    if result["errand"]:
        told = f"mission {'fulfilled' if run['reached'] else 'not fulfilled'} after {took}, {rooms}"
    else:
        left = "nothing left to explore" if run["explored"] else "not all explored"
        told = f"{rooms} visited in {took}; {left}"
    return [told, *(f"in its way: {what}" for what in run["barred"])]


def _many(result: dict[str, Any]) -> list[str]:
    summary = result["summary"]
    steps = f"{number(summary['mean_steps'])} steps, {number(summary['mean_low_level_steps'])} low-level steps (means)"
    what = "reached" if result["errand"] else "explored"
    lines = [f"{what} {summary[what]}/{summary['runs']}; {steps}; {number(summary['mean_rooms'])} rooms"]
    if result["errand"] and (lost := seeds_of(result, lambda run: not run["reached"])):
        lines.append(f"not reached with seeds {lost}")
    return lines
