"""Hypotheses about the map, walked side by side: what would they expect to sense on the same way?"""

from __future__ import annotations

import math
from collections.abc import Hashable, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from ...model import CogmapError

MOST = 8  # hypotheses that are walked side by side, at most: the heaviest

Places = tuple[Hashable | None, ...]
Classes = tuple[int, ...]
State = tuple[Places, Classes]
"""Where the agent would be under each hypothesis, and which could not yet be told apart: those of one number."""


class MapHypotheses(Protocol):
    """The interface through which a planner asks hypotheses about the map. Each numbers places in its own way."""

    @property
    def weights(self) -> Sequence[float]:
        """`[H]` how probable each is, up to a common factor."""
        ...

    @property
    def here(self) -> Sequence[Hashable]:
        """`[H]` where the agent is under each."""
        ...

    @property
    def moves(self) -> Sequence[int]:
        """The actions that lead anywhere under any of them."""
        ...

    def ahead(self, h: int, place: Hashable, action: int, /) -> Hashable | None:
        """The place that an action most probably leads to, the same where it is blocked, None for one never seen."""
        ...

    def expected(self, h: int, place: Hashable, /) -> Hashable:
        """What would be sensed in a place: hypotheses that expect equal things cannot be told apart there."""
        ...


@dataclass(frozen=True)
class Structure:
    """Two or more hypotheses about the map, rolled out side by side."""

    hypotheses: MapHypotheses  # all of them
    kept: tuple[int, ...]  # numbers of those that are walked
    weights: tuple[float, ...]  # of these, sum to one
    start: State  # before the first step, when none of them can be told apart
    _steps: dict[tuple[State, int], State] = field(default_factory=dict[tuple[State, int], State], repr=False)
    _told: dict[Classes, float] = field(default_factory=dict[Classes, float], repr=False)
    # of each hypothesis: by place and action, where that leads, and the number of what would be sensed there
    _ahead: tuple[dict[tuple[Hashable, int], tuple[Hashable, int]], ...] = field(init=False, repr=False)
    _expected: dict[Hashable, int] = field(default_factory=dict[Hashable, int], repr=False)  # numbers of what is sensed
    asked: dict[str, Any] = field(default_factory=dict[str, Any], repr=False)  # what others worked out of it alone

    def __post_init__(self) -> None:
        object.__setattr__(self, "_ahead", tuple({} for _ in self.kept))

    @classmethod
    def of(cls, hypotheses: MapHypotheses | None) -> Structure | None:
        """The heaviest of some hypotheses; None where there is no more than one.

        Raises:
            CogmapError: weights that are none, or not one for each hypothesis.
        """
        if hypotheses is None:
            return None
        weights, here = list(hypotheses.weights), list(hypotheses.here)
        if (
            len(weights) != len(here)
            or not weights
            or not all(0.0 <= w < math.inf for w in weights)
            or not any(weights)
        ):
            raise CogmapError(
                f"plan: weights of hypotheses are {weights}, of {len(here)}; give each a finite number of 0 or more, "
                "not all 0"
            )
        kept = sorted(range(len(weights)), key=lambda h: -weights[h])[:MOST]
        kept = [h for h in kept if weights[h] > 0.0]
        if len(kept) < 2:
            return None
        total = sum(weights[h] for h in kept)
        start = tuple(here[h] for h in kept), (0,) * len(kept)
        return cls(hypotheses, tuple(kept), tuple(weights[h] / total for h in kept), start)

    @property
    def entropy(self) -> float:
        """Nats that there are to be told."""
        return self.told(tuple(range(len(self.kept))))

    def told(self, classes: Classes) -> float:
        """Nats that are known of the hypotheses where they fall into these classes: the entropy of the classes."""
        if classes not in self._told:
            mass = [0.0] * len(classes)
            for number, weight in zip(classes, self.weights, strict=True):
                mass[number] += weight
            self._told[classes] = -sum(p * math.log(p) for p in mass if p > 0.0)
        return self._told[classes]

    def walk(self, state: State, action: int) -> State:
        """After one more step. Where none of them moves nothing new is sensed, and nothing told."""
        if (state, action) not in self._steps:
            self._steps[state, action] = self._walked(state, action)
        return self._steps[state, action]

    def _walked(self, state: State, action: int) -> State:
        places, classes = state
        ahead = [
            known.get((place, action)) or self._ask(at, place, action)
            for at, (known, place) in enumerate(zip(self._ahead, places, strict=True))
        ]
        after = tuple([to for to, _ in ahead])
        if after == places:
            return state
        numbers: dict[tuple[int, int], int] = {}
        apart = [numbers.setdefault((k, sensed), len(numbers)) for k, (_, sensed) in zip(classes, ahead, strict=True)]
        return after, tuple(apart)

    def _ask(self, at: int, place: Hashable | None, action: int) -> tuple[Hashable, int]:
        """Where an action leads under one of those that are walked, and what would be sensed there, as a number."""
        h, to = self.kept[at], None
        sensed = -1  # nobody knows, in a place never seen
        if place is not None and (to := self.hypotheses.ahead(h, place, action)) is not None:
            sensed = self._expected.setdefault(self.hypotheses.expected(h, to), len(self._expected))
        found = self._ahead[at][place, action] = to, sensed
        return found
