"""Simulated individuals of the study `mice`: are parameters and models found again?"""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from ...agent import Settings
from ...behaviour import MODELS, ChoiceModel, How, Source, result_of, run_task, simulate, tasks_of
from .mice_facts import ground

TRUE = {
    "precision": 0.4,
    "discount": 0.6,
    "novelty": 1.5,
    "homeward": 0.3,
    "homeward from afar": -0.3,
    "dead end": 0.3,
    "lapse": 0.08,
}
FORGETTING = {"novelty": 0.03, "cogmap": 0.05, "habit+cogmap": 0.05}
SPREAD = 1.0  # standard deviation of the habits that are drawn; that of going back has its mean at minus one


def truth(model: ChoiceModel, seed: int) -> dict[str, float]:
    """The parameters of one simulated individual."""
    rng, found = np.random.default_rng(100 + seed), dict[str, float]()
    for parameter in model.parameters:
        name = parameter.name
        if name.startswith("habit"):
            found[name] = float(rng.normal(-1.0 if name.startswith("habit back") else 0.0, SPREAD))
        else:
            found[name] = FORGETTING[model.name] if name == "forgetting" else TRUE[name]
    return found


def recover(name: str, seed: int, settings: Settings, *, steps: int) -> dict[str, Any]:
    """One simulated individual that makes so many moves, fitted by every model."""
    true, look, how = truth(MODELS[name], seed), settings.look_ahead, How(starts=2, level="alone")
    route = simulate(MODELS[name], ground(), steps=steps, parameters=true, seed=seed, look_ahead=look)
    models = list(MODELS.values())
    with TemporaryDirectory() as folder:
        source = Source([route], ground(), Path(folder), look)
        source.follow(0)
        rows = [run_task(task, source, how) for task in tasks_of(models, how)]
        result = result_of(rows, source, models, how)
    entries = {entry["name"]: entry for entry in result["models"]}
    own = entries[name]
    sure = {key: error for key, error in own["standard_errors"].items() if error}
    return {
        "kind": "recover",
        "model": name,
        "seed": seed,
        "choices": own["choices"],
        "true": true,
        "found": own["parameters"],
        "standard_errors": own["standard_errors"],
        "within": {key: key in sure and abs(own["parameters"][key] - true[key]) <= 2.0 * sure[key] for key in true},
        "held_out": {key: entry["held_out_nats_per_choice"] for key, entry in entries.items()},
        "preferred": result["preferred"],
    }
