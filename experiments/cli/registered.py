"""`cogmap explore` and `cogmap navigate` in environments of MiniGrid by their ids."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import typer

from ..text import count, number, say, say_saved, seeds_of
from .options import Sweep, Where
from .progress import counting


def run_registered(
    at: Where, sweep: Sweep, max_steps: int | None, json: Path | None, *, errand: bool, refused: Mapping[str, object]
) -> None:
    """Run episodes in the environment that is called `at.world`, and show them.

    Raises:
        CogmapError: an option is given that makes no sense there; `refused` has those of the command alone.
    """
    from ... import experiments as lab
    from ...agent import Settings
    from ...model import CogmapError

    common = {"--noise": at.noise, "--sights": at.sights, "--tiles": at.tiles, "--pose": at.pose, "--dask": sweep.dask}
    if given := [option for option, value in {**refused, **common}.items() if value not in (None, False, [])]:
        known = "is for worlds whose truth is known, such as minigrid:3x3; leave it out"
        raise CogmapError(f"{at.world}: {given[0]} {known}")
    lab.check_outputs([json])
    how: Any = {"errand": errand, "view": at.view}
    own: Any = {"settings": Settings(look_ahead=at.look_ahead), "max_steps": max_steps}
    with lab.workers(jobs=sweep.jobs) as executor, counting(at.world, sweep.runs or 1) as one_more:
        own |= {"executor": executor, "on_done": one_more}
        done = lab.run_ids(at.world, runs=sweep.runs or 1, seed=at.seed, **how, **own)
    result = lab.ids_result(at.world, done, **how)
    say(*(_one(result) if sweep.runs is None else _many(result)), title=at.world)
    if json is not None:
        lab.write_json(json, result)
    say_saved(runs=json)
    if sweep.runs is None and not (done[0].reached if errand else done[0].explored or done[0].reached):
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
