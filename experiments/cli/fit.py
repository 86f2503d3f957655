"""`cogmap fit`: models of choice, fitted to recorded walks and compared by what they predict of bouts held out."""

from contextlib import nullcontext
from dataclasses import asdict
from functools import partial
from operator import itemgetter
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Any

import typer

from ..text import number, say, say_saved, show_table
from .options import Jobs
from .progress import counting

Walks = Annotated[
    list[Path], typer.Argument(metavar="WALKS", help="Files or folders of walks: JSON, CSV, or what --trace wrote.")
]
World = Annotated[str, typer.Option(metavar="WORLD", help="A built-in name, or a maze or graph file.")]
Until = Annotated[str | None, typer.Option(metavar="NODE", help="Keep what comes before the first visit of this node.")]
Home = Annotated[str | None, typer.Option(metavar="NODE", help="The place between bouts; found unless given.")]
Models = Annotated[
    list[str] | None,
    typer.Option("--model", metavar="NAME", help="uniform, habit, habit2, novelty, cogmap or habit+cogmap; all."),
]
Level = Annotated[str, typer.Option(metavar="NAME", help="Individuals are fitted hierarchical, alone or pooled.")]
Folds = Annotated[int, typer.Option(min=2, help="Parts in which bouts are held out.")]
Starts = Annotated[int, typer.Option(min=1, help="Points from which each fit sets out.")]
LookAhead = Annotated[int, typer.Option(min=1, help="Steps that the agent looks ahead.")]
Seed = Annotated[int, typer.Option(min=0, help="Of the points that are drawn.")]
Out = Annotated[Path | None, typer.Option(metavar="DIR", help="Keep what is finished there; go on from what it has.")]
Json = Annotated[Path | None, typer.Option(metavar="FILE", help="Write the fits as JSON.")]
LEDGER = "fits.jsonl"


def fit_command(
    walks: Walks,
    world: World,
    until: Until = None,
    home: Home = None,
    model: Models = None,
    level: Level = "hierarchical",
    folds: Folds = 5,
    starts: Starts = 3,
    look_ahead: LookAhead = 6,
    seed: Seed = 0,
    out: Out = None,
    jobs: Jobs = 1,
    json: Json = None,
) -> None:
    """Fit models of choice to recorded walks, and compare them by bouts held out, in nats a choice.

    With --out the same command goes on from what is finished.
    """
    from ...behaviour import LEVELS, How, Source, load_ground, load_walks, models_named, result_of, routes_of
    from ...model import CogmapError, make_folder
    from .. import check_outputs, workers, write_json

    if level not in LEVELS:
        raise CogmapError(f"--level is {level!r}; use one of {', '.join(LEVELS)}")
    models, how = models_named(model or ()), How(level=level, folds=folds, starts=starts, seed=seed)
    ground = load_ground(world, home=home)
    routes, ground = routes_of(load_walks(*walks), ground, until=until)
    check_outputs([json], inputs=[*walks, world])
    if out is not None:
        make_folder(out)
    with TemporaryDirectory() if out is None else nullcontext(str(out)) as folder, workers(jobs=jobs) as executor:
        source = Source(routes, ground, Path(folder), look_ahead)
        rows = _rows(source, models, how, executor, None if out is None else out / LEDGER)
        result = result_of(rows, source, models, how)
    _show(result)
    if json is not None:
        write_json(json, result)
    say_saved(fits=json)


def _rows(source: Any, models: Any, how: Any, executor: Any, kept: Path | None) -> list[dict[str, Any]]:
    """The rows of all tasks: those of the ledger, then what is left to do."""
    from ...behaviour import run_task, tasks_of
    from .. import Ledger, completed, kept_rows

    tasks, rows = {task: task for task in tasks_of(models, how)}, list[dict[str, Any]]()
    made, fitted = {"walks": source.digest, **asdict(how)}, partial(run_task, source=source, how=how)
    with nullcontext() if kept is None else Ledger(kept) as ledger:
        coming = kept_rows(
            fitted, tasks, dict[str, Any], ledger, executor, made, key=itemgetter("model", "fold"), write=dict[str, Any]
        )
        if any(model.needs_agent for model in models):
            with counting("following", len(source.routes)) as one_more:
                for _ in completed(source.follow, range(len(source.routes)), executor=executor):
                    one_more()
        with counting("fitting", len(tasks)) as one_more:
            for row in coming:
                rows.append(row)
                one_more()
    return rows


def _show(result: dict[str, Any]) -> None:
    choices, individuals = result["models"][0]["choices"], result["individuals"]
    home = "" if result["home"] is None else f"; home, between bouts, is {result['home']}"
    say(f"{choices} choices of {len(individuals)} in {result['world']}{home}", title="fit")
    cells = [
        (
            row["name"],
            len(row["parameters"]),
            number(row["log_likelihood"]),
            number(row["bic"]),
            number(row["held_out_nats_per_choice"], digits=4),
            sum(one["preferred"] == row["name"] for one in individuals),
        )
        for row in result["models"]
    ]
    show_table(("model", ">parameters", ">log likelihood", ">BIC", ">held out, nats a choice", ">preferred by"), cells)
    say(f"preferred: {result['preferred']}")
    if astray := [one["individual"] for one in individuals if one["map"] and one["map"]["steps_astray"]]:
        say(f"the agent went astray along {', '.join(astray)}", style="red")
