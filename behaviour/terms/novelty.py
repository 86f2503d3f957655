"""Novelty: places that were visited less draw more, and visits are forgotten."""

from typing import Any

import numpy as np
from scipy.signal import lfilter

from ..choices import Choices
from .base import Floats, Parameter, Term
from .parameters import FORGETTING


class Novelty(Term):
    """-ν log(1 + n), n the visits to the place that a way leads to, each of them faded by (1 - φ) a step since."""

    parameters = (
        Parameter(
            name="novelty",
            meaning="ν: nats for each unit of log(1 + visits)",
            low=-5.0,
            high=20.0,
            start=0.5,
            spread=0.3,
            typical=(0.1, 2.0),
            doubt=5.0,
        ),
        FORGETTING,
    )

    def prepare(self, choices: Choices) -> Any:
        targets, column = np.unique(np.where(choices.open, choices.target, -1), return_inverse=True)
        visits = (choices.places[:, None] == targets).astype(np.float64)
        return visits, choices.step, column.reshape(choices.target.shape)

    def weigh(self, prepared: Any, values: Floats) -> tuple[Floats, Floats]:
        (weight, forgetting), (visits, step, column) = values, prepared
        keep = 1.0 - forgetting
        faded: Any = lfilter([1.0], [1.0, -keep], visits, axis=0)
        slope: Any = lfilter([0.0, 1.0], [1.0, -keep], faded, axis=0)  # by what is kept
        n, by_keep = faded[step[:, None], column], slope[step[:, None], column]
        novel = -np.log1p(n)
        return weight * novel, np.stack([novel, weight * by_keep / (1.0 + n)])
