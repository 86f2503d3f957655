"""Habit: log E(action), the action named by how it lies to the last moves."""

from itertools import product
from typing import Any

import numpy as np

from ..choices import FORWARD, RELATIONS, Choices
from .base import Floats, Parameter, Term

COUNTS = 0.1  # Dirichlet counts of each action before anything was seen
LIKENESS = 3.0
"""Nats by which rows differ from the mean of the rows with the same last move, and these means from theirs."""
_OTHERS = tuple(i for i in range(len(RELATIONS)) if i != FORWARD)
_NEVER = 8.0


class Habit(Term):
    """log E(action | the moves before), relative to forward; part of P(policy) = softmax(log E - γ G).

    The actions are forward, right, back and left, as they lie to the last move. E has one row for each way in which the
    `order` - 1 moves before went, each with Dirichlet counts of `COUNTS` an action before anything was seen.

    Args:
        order: 1, turns as such; 2, turns that depend on the last one; 3, on the last two.
        likeness: standard deviation of the prior by which a row is like the others: what was seen after one pair of
            moves tells something of the others, the more the more moves they share.
    """

    def __init__(self, order: int = 1, *, likeness: float = LIKENESS) -> None:
        self.order, self.likeness = order, likeness
        rows = list(product(RELATIONS, repeat=order - 1))
        self.parameters = tuple(
            Parameter(
                name="habit " + " after ".join([RELATIONS[way], *row]),
                meaning=f"log E({RELATIONS[way]}{' | ' * bool(row)}{', '.join(row)}) - log E(forward | the same), nats",
                low=-_NEVER,
                high=_NEVER,
                start=0.0,
                spread=0.2,
                typical=(-1.0, 1.0),
            )
            for row in rows
            for way in _OTHERS
        )

    def prepare(self, choices: Choices) -> Any:
        rows = np.zeros(len(choices), dtype=np.int64)
        for back in range(self.order - 1):
            rows = rows * len(RELATIONS) + choices.before[:, back]
        column = np.full(len(RELATIONS), -1)
        column[list(_OTHERS)] = np.arange(len(_OTHERS))
        at = rows[:, None] * len(_OTHERS) + column[choices.relation]
        at = np.where((column[choices.relation] < 0) | ~choices.open, len(self.parameters), at)
        return at, np.arange(len(self.parameters))[:, None, None] == at

    def weigh(self, prepared: Any, values: Floats) -> tuple[Floats, Floats]:
        at, is_it = prepared
        return np.append(values, 0.0)[at], is_it

    def log_prior(self, values: Floats) -> tuple[float, Floats]:
        logits = np.pad(values.reshape(-1, len(_OTHERS)), ((0, 0), (1, 0)))
        top = logits.max(axis=1, keepdims=True)
        log_E = logits - top - np.log(np.exp(logits - top).sum(axis=1, keepdims=True))
        slope = COUNTS * (1.0 - len(RELATIONS) * np.exp(log_E[:, 1:]))
        nats = COUNTS * float(log_E.sum())
        own = values.reshape(*(len(RELATIONS),) * (self.order - 1), len(_OTHERS))
        for axis in range(self.order - 2, -1, -1):  # away from the mean over the earliest move first
            mean = own.mean(axis=axis)
            away = own - np.expand_dims(mean, axis)
            nats -= 0.5 * float((away**2).sum()) / self.likeness**2
            share = len(RELATIONS) ** (self.order - 2 - axis)  # of each parameter in such a mean
            wide = away.reshape(-1, len(_OTHERS)).repeat(share, axis=0) / share
            slope = slope - wide / self.likeness**2
            own = mean
        return nats, slope.ravel()
