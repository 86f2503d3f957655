"""What recorded animals choose under each model, and which terms the whole model needs."""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from ...agent import Settings
from ...behaviour import (
    ALL,
    MODELS,
    ChoiceModel,
    Habit,
    Home,
    How,
    Recency,
    Route,
    Source,
    Value,
    result_of,
    run_task,
    simulate,
    tasks_of,
)
from .mice_facts import PORT, Recorded, ends_of

WHOLE = MODELS["habit+cogmap"]
VARIANTS = (
    WHOLE,
    ChoiceModel("without value", (Habit(3), Home())),
    ChoiceModel("value of one step", (Habit(3), Value(1), Home())),
    ChoiceModel("without home and dead ends", (Habit(3), Value())),
    ChoiceModel("habits of two moves", (Habit(2), Value(), Home())),
    ChoiceModel("habits of one move", (Habit(1), Value(), Home())),
    ChoiceModel("without habits", (Value(), Home())),
    ChoiceModel("with recency", (Habit(3), Value(), Home(), Recency())),
)
"""The whole model, less a term or with one more."""
SIMULATED = 3  # individuals with the parameters that were found
SIMULATED_STEPS = 3000


def exploring(found: Recorded) -> list[Route]:
    """What comes before the first visit of the port."""
    port = found.ground.find(PORT, "port")
    return [route.until(port) for route in found.routes]


def models_fitted(found: Recorded, settings: Settings) -> dict[str, Any]:
    """Every model fitted; the choices that were made at each fork beside those that the whole model expects."""
    models, how = list(MODELS.values()), How()
    with TemporaryDirectory() as folder:
        source = Source(exploring(found), found.ground, Path(folder), settings.look_ahead)
        for i in range(len(source.routes)):
            source.follow(i)
        rows = [run_task(task, source, how) for task in tasks_of(models, how)]
        result = result_of(rows, source, models, how)
        whole = next(row for row in rows if (row["model"], row["fold"]) == (WHOLE.name, ALL))
        flows = _flows(source, [fit["parameters"] for fit in whole["individuals"]])
    walks = [
        simulate(
            WHOLE,
            found.ground,
            steps=SIMULATED_STEPS,
            parameters=whole["group"]["parameters"],
            seed=seed,
            look_ahead=settings.look_ahead,
        )
        for seed in range(SIMULATED)
    ]
    ends = [ends_of(walk.places.tolist(), found.ground) for walk in walks]
    return {"kind": "fit", "result": result, "flows": flows, "simulated": [one.new for one in ends]}


def terms_judged(found: Recorded, settings: Settings) -> dict[str, Any]:
    """Held-out likelihood of the whole model, less a term or with one more."""
    how, held = How(level="pooled", starts=1), dict[str, float]()
    with TemporaryDirectory() as folder:
        source = Source(exploring(found), found.ground, Path(folder), settings.look_ahead)
        for i in range(len(source.routes)):
            source.follow(i)
        for model in VARIANTS:
            rows = [run_task(task, source, how, model) for task in tasks_of([model], how)]
            held[model.name] = result_of(rows, source, [model], how)["models"][0]["held_out_nats_per_choice"]
    return {"kind": "terms", "held_out": held, "parameters": {m.name: len(m.parameters) for m in VARIANTS}}


def _flows(source: Source, parameters: list[dict[str, float]]) -> list[list[float]]:
    """For each way of each fork: from, to, how often it was taken, and how often the whole model expects that."""
    taken, expected = dict[tuple[int, int], float](), dict[tuple[int, int], float]()
    for one, given in zip(source.choices(agent=True), parameters, strict=True):
        p = WHOLE.probabilities(WHOLE.prepare(one), WHOLE.values(given))
        here = one.places[one.step]
        for row, column in np.argwhere(one.open).tolist():
            way = (int(here[row]), int(one.target[row, column]))
            expected[way] = expected.get(way, 0.0) + float(p[row, column])
            taken[way] = taken.get(way, 0.0) + float(one.taken[row] == column)
    return [[*way, taken[way], expected[way]] for way in sorted(expected)]
