"""Recency: where one has just been, one does not go again."""

from typing import Any

import numpy as np

from ..choices import Choices
from .base import Floats, Parameter, Term


class Recency(Term):
    """-ρ (1 - η)^age of the last visit to the place that a way leads to; zero where it was never visited."""

    parameters = (
        Parameter(
            name="recency",
            meaning="ρ: nats against a place that was visited this moment",
            low=-10.0,
            high=20.0,
            start=0.5,
            spread=0.3,
            typical=(0.2, 2.0),
            doubt=5.0,
        ),
        Parameter(
            name="fading",
            meaning="η: share of this that fades with each step since the visit",
            low=1e-3,
            high=0.9,
            start=0.2,
            spread=0.05,
            typical=(0.05, 0.4),
            doubt=0.5,
        ),
    )

    def prepare(self, choices: Choices) -> Any:
        last = np.full((int(choices.places.max()) + 2, len(choices.places)), -1)
        last[choices.places, np.arange(len(choices.places))] = np.arange(len(choices.places))
        np.maximum.accumulate(last, axis=1, out=last)
        reached = np.minimum(choices.target, len(last) - 1)  # places beyond were never visited; -1 is the last row
        visited = last[reached, choices.step[:, None]]
        return np.where(visited < 0, -1, choices.step[:, None] - visited)

    def weigh(self, prepared: Any, values: Floats) -> tuple[Floats, Floats]:
        (weight, fading), known = values, prepared >= 0
        age = np.where(known, prepared, 0)
        left = np.where(known, (1.0 - fading) ** age, 0.0)
        return -weight * left, np.stack([-left, weight * age * left / (1.0 - fading)])
