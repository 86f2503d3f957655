"""Models compared: each fitted to all choices and to all but one fold, task by task, and what that comes to."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from .crossing import FOLDS, LEVELS, fit_group, folds_of, held_out
from .fitting import STARTS
from .models import MODELS, ChoiceModel
from .source import Source

Row = dict[str, Any]
ALL = -1
"""Stands for the fit to all choices where a task names a fold."""
CHANCE = 1.645  # standard errors that chance exceeds one time in twenty
_SURE = 1.96  # standard errors of a 95 % interval


@dataclass(frozen=True, slots=True, kw_only=True)
class How:
    """Options of fitting and comparing models."""

    level: str = LEVELS[0]  # whether individuals are fitted around the group, alone, or as the group; one of `LEVELS`
    folds: int = FOLDS  # of the cross-validation
    starts: int = STARTS  # points from which each fit to all choices sets out
    seed: int = 0  # of those that are drawn


def tasks_of(models: Sequence[ChoiceModel], how: How) -> list[tuple[str, int]]:
    """The tasks of a comparison: each model fitted to all choices, and to all but each fold."""
    return [(model.name, fold) for model in models for fold in (ALL, *range(how.folds))]


def run_task(task: tuple[str, int], source: Source, how: How, model: ChoiceModel | None = None) -> Row:
    """Carry out one task; the result is plain JSON values.

    Args:
        task: the name of a model, and a fold or `ALL`.
        source: the walks; an agent has followed them where the model needs it.
        how: see `How`.
        model: the model, where it is none of `MODELS`.
    """
    name, fold = task
    model = MODELS[name] if model is None else model
    choices = source.choices(agent=model.needs_agent)
    prepared = [model.prepare(one) for one in choices]
    if fold == ALL:
        made, _ = fit_group(model, prepared, level=how.level, starts=how.starts, seed=how.seed)
        return {
            "model": name,
            "fold": fold,
            "group": asdict(made.group),
            "individuals": [asdict(one) for one in made.individuals],
        }
    folds = folds_of(choices, how.folds)
    nats = held_out(model, prepared, fold, folds, level=how.level, seed=how.seed)
    bouts: list[list[list[float]]] = []
    for one, found in zip(choices, nats, strict=True):
        held = ~np.isnan(found)
        numbers = one.bout[held]
        bouts.append(
            [[int(b), int((numbers == b).sum()), float(found[held][numbers == b].sum())] for b in np.unique(numbers)]
        )
    return {"model": name, "fold": fold, "bouts": bouts}


def result_of(rows: Iterable[Row], source: Source, models: Sequence[ChoiceModel], how: How) -> dict[str, Any]:
    """The results of all tasks as plain JSON values: `models`, `individuals` and `preferred`."""
    whole: dict[str, Row] = {}
    held: dict[str, list[dict[int, list[float]]]] = {}
    for row in rows:
        if row["fold"] == ALL:
            whole[row["model"]] = row
            continue
        individuals = held.setdefault(row["model"], [{} for _ in source.routes])
        for bouts, of in zip(row["bouts"], individuals, strict=True):
            for bout, count, nats in bouts:
                before = of.get(bout, [0, 0.0])  # a bout alone is dealt out over several folds
                of[bout] = [before[0] + count, before[1] + nats]
    names = [model.name for model in models]
    everyone = {name: [part for of in held[name] for part in of.values()] for name in names}
    found: list[Row] = []
    for i, route in enumerate(source.routes):
        own = {name: list(held[name][i].values()) for name in names}
        fits = [_entry(whole[name]["individuals"][i], own[name]) for name in names]
        facts = source.followed(i) if any(model.needs_agent for model in models) else None
        found.append(
            {
                "individual": route.individual,
                "steps": len(route.places) - 1,
                "choices": int(sum(part[0] for part in own[names[0]])),
                "map": facts and {"steps_astray": facts.astray, "places": facts.entered, "nodes_entered": facts.nodes},
                "models": fits,
                "preferred": preferred(own, models),
            }
        )
    return {
        "world": source.ground.name,
        "home": None if source.ground.home is None else str(source.ground.places[source.ground.home]),
        "how": asdict(how) | {"look_ahead": source.look_ahead},
        "models": [_entry(whole[name]["group"], everyone[name]) for name in names],
        "preferred": preferred(everyone, models),
        "individuals": found,
    }


def preferred(held: Mapping[str, Sequence[Sequence[float]]], models: Sequence[ChoiceModel]) -> str | None:
    """The preferred model by held-out likelihood: the simplest one that is not significantly worse than the best.

    Models that contain the right one predict as well as that one, give or take chance; so the difference has to be more
    than one time in twenty would be by chance, by its standard error over bouts, before more parameters are believed.

    Args:
        held: for each model, how many choices each bout has and what they come to in nats; bouts in the same order.
        models: these models.
    """
    totals = {model.name: sum(part[1] for part in held[model.name]) for model in models}
    if not any(part[0] for part in held[models[0].name]):
        return None
    best = max(totals, key=totals.__getitem__)
    for model in sorted(models, key=lambda model: len(model.parameters)):
        pairs = zip(held[best], held[model.name], strict=True)
        behind = [(a[0], a[1] - b[1]) for a, b in pairs]
        if model.name == best or sum(d for _, d in behind) <= CHANCE * _error_of_sum(behind):
            return model.name
    return best


def _entry(fit: Row, held: Sequence[Sequence[float]]) -> Row:
    count, nats = sum(part[0] for part in held), sum(part[1] for part in held)
    mean = -nats / count if count else None
    error = _error_of_sum([(part[0], part[1]) for part in held]) / count if count else 0.0
    sure = mean is not None and len(held) > 1
    return {
        "name": fit["model"],
        "parameters": fit["parameters"],
        "standard_errors": fit["standard_errors"],
        "log_likelihood": fit["log_likelihood"],
        "choices": fit["choices"],
        "bic": fit["bic"],
        "converged": fit["converged"],
        "held_out_nats_per_choice": mean,
        "held_out_interval": [mean - _SURE * error, mean + _SURE * error] if sure and mean is not None else None,
    }


def _error_of_sum(parts: Sequence[tuple[float, float]]) -> float:
    """Standard error of a sum over bouts, each with its number of choices and its part of the sum."""
    counts, sums = (np.array(column, dtype=np.float64) for column in zip(*parts, strict=True))
    if len(parts) < 2 or not counts.sum():
        return 0.0
    away = sums - counts * sums.sum() / counts.sum()
    return float(np.sqrt(len(parts) / (len(parts) - 1) * (away @ away)))
