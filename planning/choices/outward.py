"""The least G, and while exploring outward first."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...model import CogmapError
from ..local import LocalModel
from .base import TIE, Choice, Floats, Ints, Verdict, best_of, near_best


@dataclass(frozen=True, slots=True)
class Outward(Choice):
    """Takes a policy of the least G. While it only explores, it prefers among near-ties the one that leads furthest
    out.

    While it only explores it takes, of the policies within `slack` of the least G, those whose first place never
    entered lies furthest out, and the best of them: exploring leaves fewer pockets behind.

    Raises:
        CogmapError: `slack` is negative, or not finite.
    """

    name: ClassVar[str] = "outward"
    how: ClassVar[str] = "the least G, or nearly so and furthest out"
    slack: float = 0.25  # nats that an agent which only explores gives up, at most, to go further out first

    def __post_init__(self) -> None:
        if not 0.0 <= self.slack < np.inf:
            raise CogmapError(f"outward: slack is {self.slack}; give a finite number of nats, 0 or more")

    def contenders(self, model: LocalModel, actions: Ints, G: Floats) -> Ints:
        distance = frontier(model)
        if not model.indifferent or distance.max() < 0.0:
            return best_of(model, actions, G)
        good = near_best(G, np.arange(len(G)), self.slack)
        outward = _outward(model, distance, actions[good])
        return near_best(G, good[outward == outward.max()], TIE)

    def passed_over(self, model: LocalModel, actions: Ints, G: Floats, chosen: int, policy: int) -> Verdict | None:
        verdict = Choice.passed_over(self, model, actions, G, chosen, policy)
        if verdict is not None and verdict.name == "lot":
            return verdict
        if model.indifferent and G[policy] <= G.min() + self.slack:
            words = "about as good, but while it only explores what leads further out comes first"
            return Verdict("outward", words) if frontier(model).max() >= 0.0 else None
        return verdict


def frontier(model: LocalModel) -> Floats:
    """`[R]` how far out a place lies that was never entered: squared distance from the start; -1 for all others."""
    distance = np.square(model.position).sum(axis=1)
    return np.where(model.entered | np.isnan(distance), -1.0, distance)


def _outward(model: LocalModel, distance: Floats, actions: Ints) -> Floats:
    """`[P]` distance of the first place never entered on the most probable way of each policy; -1 if there is none."""
    place = np.full(len(actions), model.belief.argmax())
    outward = np.full(len(actions), -1.0)
    for action in actions.T:
        after = model.successor[place, action]
        place = np.where(after >= 0, after, place)
        outward = np.where(outward >= 0.0, outward, distance[place])
    return outward
