"""Value: the expected free energy of what an agent with a map would do next, as it begins with each way."""

from typing import Any

import numpy as np

from ...model import CogmapError
from ..choices import Choices
from .base import Floats, Parameter, Term
from .parameters import FORGETTING

EXACT = 5_000_000  # steps of policies that are kept in double precision; more take single precision, for memory


class Value(Term):
    """log of the mean of exp(-γ G) over the policies that begin with a way, G with discount and forgetting.

    The prior over policies is that of their first action, shared evenly among those that begin with it, so that with
    γ = 0 all ways are alike. -G is the sum over the steps t of discount^(t-1) (gain + extra (1 - (1 - φ)^age)); see
    `Prospects`. With φ = 0 it is the agent's own G.

    Args:
        look_ahead: steps that count; all that the prospects have unless given.
    """

    needs_agent = True
    parameters = (
        Parameter(
            name="precision",
            meaning="γ of P(policy) = softmax(log E - γ G), per nat",
            low=0.0,
            high=50.0,
            start=0.1,
            spread=0.05,
            typical=(0.02, 0.5),
            doubt=10.0,
        ),
        Parameter(
            name="discount",
            meaning="weight of each step of a policy relative to the one before",
            low=0.0,
            high=1.0,
            start=0.6,
            spread=0.1,
            typical=(0.3, 0.9),
            doubt=1.0,
        ),
        FORGETTING,
    )

    def __init__(self, look_ahead: int | None = None) -> None:
        self.look_ahead = look_ahead

    def prepare(self, choices: Choices) -> Any:
        if choices.prospects is None:
            raise CogmapError("value: no agent has followed this walk; give choices_of the prospects of follow_route")
        seen, steps, width = choices.prospects, slice(self.look_ahead), choices.target.shape[1]
        row = seen.choice.astype(np.int64) * width + seen.way
        begin = np.flatnonzero(np.diff(row, prepend=-1))
        place = row[begin]  # which way each group of policies begins with
        kind = np.float64 if seen.gain.size <= EXACT else np.float32
        parts = (seen.gain, seen.extra, seen.age)
        columns = (np.ascontiguousarray(part[:, steps].T, dtype=kind) for part in parts)
        return choices.target.shape, place, begin, np.diff(np.append(begin, len(row))), *columns

    def weigh(self, prepared: Any, values: Floats) -> tuple[Floats, Floats]:
        shape, place, begin, size, gain, extra, age = prepared
        precision, discount, forgetting = values
        keep = 1.0 - forgetting
        left = np.power(keep, age, dtype=age.dtype)
        step = np.arange(len(gain))
        weight = discount**step
        slope = step * discount ** np.maximum(step - 1, 0)
        worth = gain + extra * (1.0 - left)
        total = weight @ worth
        by_discount, by_forgetting = slope @ worth, weight @ (extra * age * left) / keep
        nats = precision * total
        top = np.maximum.reduceat(nats, begin)
        share = np.exp(nats - np.repeat(top, size))
        mass = np.add.reduceat(share, begin)
        share /= np.repeat(mass, size)
        found = top + np.log(mass / size)
        slopes = [
            np.add.reduceat(share * by, begin) for by in (total, precision * by_discount, precision * by_forgetting)
        ]
        whole = np.zeros((4, shape[0] * shape[1]))
        whole[:, place] = [found, *slopes]
        whole = whole.reshape(4, *shape)
        return whole[0], whole[1:]
