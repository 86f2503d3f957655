"""What a way to choose is, and what they share."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...model import Floats, Ints
from ..local import LocalModel

TIE = 1e-3
"""Nats; policies closer than this are equally good: at a precision of 16 their odds are 1.016 to 1."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """Why a policy that is as good as the chosen one was not taken."""

    name: str  # in data
    words: str  # for people


class Choice(ABC):
    """Which of the evaluated policies is followed; its options are fields.

    Attributes:
        name: on the command line and in files.
        how: in words, after "it chose".
        by_lot: whether the lot is drawn among equals; else all policies are drawn from.
    """

    name: ClassVar[str]
    how: ClassVar[str]
    by_lot: ClassVar[bool] = True

    @abstractmethod
    def contenders(self, model: LocalModel, actions: Ints, G: Floats) -> Ints:
        """Indices of the policies `[P, L]` that are equally good, by their G `[P]` in nats."""

    def choose(self, model: LocalModel, actions: Ints, G: Floats, probability: Floats, rng: np.random.Generator) -> int:
        """The index of the policy to follow; `probability` is P(policy)."""
        best = self.contenders(model, actions, G)
        return int(best[rng.integers(len(best))])

    def passed_over(self, model: LocalModel, actions: Ints, G: Floats, chosen: int, policy: int) -> Verdict | None:
        """Why a policy was not taken that is no worse than the chosen one; None where it is worse."""
        if policy in self.contenders(model, actions, G):
            return Verdict("lot", "as good; the lot fell on another")
        if G[policy] - G.min() <= TIE:
            return Verdict(
                "moves",
                "as good, but it moves more, and where something is preferred those that move least come first",
            )
        return None


def best_of(model: LocalModel, actions: Ints, G: Floats) -> Ints:
    """The policies as good as the best; where something is preferred, those of them that move least."""
    good = near_best(G, np.arange(len(G)), TIE)
    if not model.indifferent:
        moves = (actions[good] != model.motions.stay).sum(axis=1)
        good = near_best(G, good[moves == moves.min()], TIE)
    return good


def near_best(G: Floats, policies: Ints, nats: float) -> Ints:
    """Those of the policies that are so near to the best of them."""
    return policies[G[policies] <= G[policies].min() + nats]
